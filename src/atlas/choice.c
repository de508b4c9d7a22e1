// SPDX-License-Identifier: MIT
// Which surfaces of a scene get charts. The stages need not know: to them all other triangles are
// unusable.
#include "atlas/choice.h"

#include "base/memory.h"

#include <string.h>

static bool is_chosen(const alpi_atlas_choice *choice, uint32_t surface)
{
    return choice->surfaces == NULL || choice->surfaces[surface];
}

static bool is_instance(const alpi_atlas_choice *choice, uint32_t surface)
{
    return choice->originals != NULL && choice->originals[surface] != surface;
}

alp_result alpi_choice_view(const alp_scene *scene, const alpi_atlas_choice *choice,
                            alp_scene *view)
{
    *view = *scene;
    view->usable_count = 0;
    view->area = 0.0;
    ALPI_TRY_NEW(scene->context, view->triangle_usable, scene->triangle_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t surface = scene->triangle_surface[t];
        if (scene->triangle_usable[t] && is_chosen(choice, surface) &&
            !is_instance(choice, surface)) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            view->triangle_usable[t] = true;
            view->usable_count++;
            view->area += vec3_triangle_area(c[0], c[1], c[2]);
        }
    }
    return ALP_OK;
}

void alpi_choice_end(alp_scene *view)
{
    alpi_release(view->context, view->triangle_usable);
    view->triangle_usable = NULL;
}

/// The corner of a triangle that comes from vertex `source` of the mesh.
static int corner_of(const alp_scene *scene, uint32_t triangle, uint32_t source)
{
    for (int k = 0; k < 2; k++) {
        if (scene->vertex_source[scene->triangles[triangle][k]] == source) {
            return k;
        }
    }
    return 2;
}

/// Copies the triangles of an original. Where one of the two is mirrored, corners have other
/// places.
static void share_surface(alp_atlas *atlas, uint32_t instance, uint32_t original)
{
    const alp_scene *scene = atlas->scene;
    const alpi_surface *to = &scene->surfaces[instance], *from = &scene->surfaces[original];
    for (uint32_t i = 0; i < to->triangle_count; i++) {
        const uint32_t t = to->first_triangle + i, source = from->first_triangle + i;
        for (int k = 0; k < 3; k++) {
            const int corner =
                corner_of(scene, source, scene->vertex_source[scene->triangles[t][k]]);
            memcpy(atlas->corner_uvs[t][k], atlas->corner_uvs[source][corner],
                   sizeof atlas->corner_uvs[t][k]);
            for (int set = 0; set < 3 && atlas->set_uvs != NULL; set++) {
                memcpy(atlas->set_uvs[t][set][k], atlas->set_uvs[source][set][corner],
                       sizeof atlas->set_uvs[t][set][k]);
            }
        }
        if (atlas->set_members != NULL) {
            atlas->set_members[t] = atlas->set_members[source];
        }
        atlas->triangle_pages[t] = atlas->triangle_pages[source];
    }
}

void alpi_choice_share(alp_atlas *atlas, const alpi_atlas_choice *choice)
{
    const alp_scene *scene = atlas->scene;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (is_chosen(choice, s) && is_instance(choice, s)) {
            share_surface(atlas, s, choice->originals[s]);
        }
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!is_chosen(choice, scene->triangle_surface[t])) {
            atlas->triangle_pages[t] = ALPI_NONE;
            memset(atlas->corner_uvs[t], 0, sizeof atlas->corner_uvs[t]);
        }
    }
}
