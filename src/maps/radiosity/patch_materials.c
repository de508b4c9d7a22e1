// SPDX-License-Identifier: MIT
// Reflectance and emission of each texel: means over its area.
#include "maps/radiosity/patch_create.h"

#include "base/tasks.h"
#include "scene/lights/lighting.h"

#include <string.h>

enum { ALBEDO_STRATA = 4, TEXELS_PER_RANGE = 1024 };

static uint32_t material_of(const alp_scene *scene, uint32_t triangle)
{
    return scene->surfaces[scene->triangle_surface[triangle]].material;
}

/// Whether all points of a texel have one material, without textures or vertex colours.
static bool is_even(const alpi_patches *p, uint32_t texel)
{
    const alp_scene *scene = p->scene;
    const alpi_texels *t = p->texels;
    const uint32_t material = material_of(scene, t->triangles[texel]);
    const alpi_material *m = material != ALPI_NONE ? &scene->materials[material] : NULL;
    const bool textured =
        m != NULL &&
        (m->base_color_texture.image != ALPI_NONE ||
         (scene->metals_black && m->metallic_texture.image != ALPI_NONE) ||
         m->emission_texture.image != ALPI_NONE || m->transmission_texture.image != ALPI_NONE);
    bool even = scene->colors == NULL && !textured;
    for (uint32_t k = t->piece_first[texel]; k < t->piece_first[texel + 1] && even; k++) {
        even = material_of(scene, alpi_atlas_triangle(t->atlas, t->piece_triangles[k])) == material;
    }
    return even;
}

static vec3 outward(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

static bool is_masked_out(const alp_scene *scene, const alpi_texel_spot *s)
{
    const uint32_t material = material_of(scene, s->triangle);
    return material != ALPI_NONE && scene->materials[material].alpha_mode == ALPI_ALPHA_MASK &&
           alpi_surface_is_cut(scene, s->triangle, s->b1, s->b2);
}

/// Mean albedo and emission over the strata of a texel that a mask does not cut out.
static void measure_texel(const alpi_patches *p, uint32_t texel, bool even)
{
    const uint32_t strata = even ? 1 : ALBEDO_STRATA;
    double albedo[3] = {0.0}, emission[3] = {0.0};
    uint32_t met = 0;
    for (uint32_t i = 0; i < strata * strata; i++) {
        const uint32_t column = i % strata, row = i / strata;
        const float at[2] = {((float)column + 0.5f) / (float)strata,
                             ((float)row + 0.5f) / (float)strata};
        alpi_texel_spot s;
        alpi_texels_spot(p->texels, texel, at, &s);
        if (is_masked_out(p->scene, &s)) {
            continue;
        }
        met++;
        const alpi_pane pane = alpi_surface_pane(p->scene, s.triangle, s.b1, s.b2);
        const vec3 a = alpi_surface_albedo(p->scene, s.triangle, s.b1, s.b2);
        const vec3 e =
            alpi_surface_emission(p->scene, s.triangle, s.b1, s.b2, outward(p->scene, s.triangle));
        const float ab[3] = {a.x, a.y, a.z}, eb[3] = {e.x, e.y, e.z};
        for (int k = 0; k < 3; k++) {
            albedo[k] += (double)(pane.kept * ab[k]);
            emission[k] += (double)eb[k];
        }
    }
    for (int k = 0; k < 3 && met > 0; k++) {
        p->reflectances[texel][k] = (float)(albedo[k] / met);
    }
    p->emissions[texel] =
        met > 0 ? (float)((emission[0] + emission[1] + emission[2]) / (3.0 * met)) : 0.0f;
}

/// Sets the distance of near hits to the side of a texel; alpi_patches_set_reach refines it.
static void set_sides(const alpi_patches *p, uint32_t texel)
{
    for (int of = ALPI_FRONT; of <= (p->two_sided ? ALPI_BACK : ALPI_FRONT); of++) {
        const uint32_t cell = alpi_patches_cell(p, texel, (alpi_side)of);
        p->cells[cell][ALPI_CELL_SIDE] = alpi_texels_side(p->texels, texel);
    }
}

static alp_result measure_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    uint32_t last = ALPI_NONE; // even texel: the next one often has the same material
    for (uint32_t t = begin; t < end; t++) {
        set_sides(p, t);
        const bool even = is_even(p, t);
        if (even && last != ALPI_NONE &&
            material_of(p->scene, p->texels->triangles[last]) ==
                material_of(p->scene, p->texels->triangles[t])) {
            memcpy(p->reflectances[t], p->reflectances[last], sizeof *p->reflectances);
            p->emissions[t] = p->emissions[last];
            continue;
        }
        measure_texel(p, t, even);
        last = even ? t : last;
    }
    return ALP_OK;
}

alp_result alpi_patches_measure_materials(alpi_patches *patches)
{
    const alpi_task_progress progress = {.stage = "light"};
    return alpi_parallel_for(patches->context, patches->texels->count, TEXELS_PER_RANGE,
                             measure_range, patches, &progress);
}
