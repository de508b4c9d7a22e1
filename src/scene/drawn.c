// SPDX-License-Identifier: MIT
// A scene as a host draws it: its arrays, materials and images.
#include "scene/scene.h"

#include <alpenglow/geometry.h>

#include <math.h>
#include <string.h>

// The public values are the scene's own.
_Static_assert(ALP_UV_SETS == (int)ALPI_UV_SLOT_COUNT, "slots");
_Static_assert(ALP_NONE == ALPI_NONE, "no index");
_Static_assert((int)ALP_WRAP_CLAMP == (int)ALPI_WRAP_CLAMP &&
                   (int)ALP_WRAP_MIRROR == (int)ALPI_WRAP_MIRROR,
               "wrapping");
_Static_assert((int)ALP_ALPHA_MASK == (int)ALPI_ALPHA_MASK &&
                   (int)ALP_ALPHA_BLEND == (int)ALPI_ALPHA_BLEND,
               "alpha modes");

alp_geometry alp_scene_get_geometry(const alp_scene *scene)
{
    if (scene == NULL) {
        return (alp_geometry){0};
    }
    alp_geometry geometry = {.vertex_count = scene->vertex_count,
                             .triangle_count = scene->triangle_count,
                             .positions = (const float(*)[3])scene->positions,
                             .normals = (const float(*)[3])scene->normals,
                             .colors = (const float(*)[4])scene->colors,
                             .triangles = (const uint32_t(*)[3])scene->triangles,
                             .triangle_surfaces = scene->triangle_surface,
                             .triangle_usable = scene->triangle_usable};
    for (int slot = 0; slot < ALP_UV_SETS; slot++) {
        geometry.uvs[slot] = (const float(*)[2])scene->uvs[slot];
    }
    return geometry;
}

static alp_texture_info describe(const alpi_texture *t)
{
    const float c = cosf(t->rotation), s = sinf(t->rotation);
    alp_texture_info info = {
        .image = t->image,
        .uv_slot = t->uv_set,
        .wrap_u = (alp_wrap)t->wrap_u,
        .wrap_v = (alp_wrap)t->wrap_v,
        .transform = {{c * t->scale[0], s * t->scale[1], t->offset[0]},
                      {-s * t->scale[0], c * t->scale[1], t->offset[1]}},
        .blended = t->blended,
    };
    memcpy(info.slots, t->slots, sizeof info.slots);
    return info;
}

alp_material_info alp_scene_get_material(const alp_scene *scene, uint32_t index)
{
    alpi_material none = alpi_material_default();
    for (int k = 0; k < 3; k++) {
        none.base_color[k] = 0.5f;
    }
    const alpi_material *m =
        scene != NULL && index < scene->material_count ? &scene->materials[index] : &none;
    alp_material_info info = {
        .name = m->name != NULL ? m->name : "",
        .base_color_texture = describe(&m->base_color_texture),
        .metallic = m->metallic,
        .metallic_texture = describe(&m->metallic_texture),
        .emission_texture = describe(&m->emission_texture),
        .occlusion_texture = describe(&m->occlusion_texture),
        .occlusion_strength = m->occlusion_strength,
        .alpha_mode = (alp_alpha_mode)m->alpha_mode,
        .alpha_cutoff = m->alpha_cutoff,
        .double_sided = m->double_sided,
        .transmission = m->transmission,
        .transmission_texture = describe(&m->transmission_texture),
        .normal_texture = describe(&m->normal_texture),
        .normal_scale = m->normal_scale,
    };
    memcpy(info.base_color, m->base_color, sizeof info.base_color);
    memcpy(info.emission, m->emission, sizeof info.emission);
    return info;
}

const alp_image *alp_scene_get_image(const alp_scene *scene, uint32_t index)
{
    if (scene == NULL || index >= scene->image_count) {
        return NULL;
    }
    const bool apart = scene->images[index] == NULL && scene->normal_maps != NULL;
    return apart ? scene->normal_maps[index] : scene->images[index];
}
