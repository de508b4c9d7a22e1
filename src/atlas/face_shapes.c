// SPDX-License-Identifier: MIT
#include "atlas/face_shapes.h"

#include "base/memory.h"
#include "base/tasks.h"

static alp_result make_shapes(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_texels *texels = user;
    const alp_atlas *atlas = texels->atlas;
    for (uint32_t f = begin; f < end; f++) {
        alpi_page_triangle page;
        if (atlas->triangle_charts[f] != ALPI_NONE && alpi_page_triangle_load(atlas, f, &page)) {
            texels->shapes[f].map = alpi_page_triangle_map(&page);
            alpi_facet_load(atlas->scene, alpi_atlas_triangle(atlas, f), true,
                            &texels->shapes[f].facet);
        }
    }
    return ALP_OK;
}

alp_result alpi_face_shapes_make(alpi_texels *texels)
{
    enum { FACES_PER_RANGE = 256 };
    alp_context *context = texels->atlas->context;
    const uint32_t faces = alpi_atlas_face_count(texels->atlas);
    if (faces > texels->count / ALPI_TEXELS_PER_FACE_SHAPE) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(context, texels->shapes, faces);
    return alpi_parallel_for(context, faces, FACES_PER_RANGE, make_shapes, texels, NULL);
}
