// SPDX-License-Identifier: MIT
#include "render/stored_light.h"

#include "scene/light_maps.h"
#include "scene/lights/lighting.h"

#include <math.h>

/// ρE/π by the units of a map. `value` is a texel times its scale.
static vec3 reflected_by(const alp_scene *scene, const alpi_surface_point *p,
                         alpi_light_map_units units, vec3 value)
{
    if (units == ALPI_LIGHT_MAP_RADIANCE) { // emission is in it, and is added by who gathers
        vec3 c[3];
        alpi_triangle_corners(scene, p->triangle, c);
        const vec3 front = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        const vec3 emission = alpi_surface_emission(scene, p->triangle, p->b1, p->b2, front);
        return (vec3){fmaxf(value.x - emission.x, 0.0f), fmaxf(value.y - emission.y, 0.0f),
                      fmaxf(value.z - emission.z, 0.0f)};
    }
    const vec3 albedo = alpi_surface_albedo(scene, p->triangle, p->b1, p->b2);
    const float share = alpi_surface_pane(scene, p->triangle, p->b1, p->b2).kept *
                        (units == ALPI_LIGHT_MAP_IRRADIANCE ? (float)(1.0 / ALPI_PI) : 1.0f);
    return (vec3){share * albedo.x * value.x, share * albedo.y * value.y,
                  share * albedo.z * value.z};
}

static void reflect(const void *user, const alpi_surface_point *points, uint32_t count,
                    vec3 *radiance)
{
    const alp_scene *scene = user;
    const alpi_light_maps *maps = alpi_scene_light_maps(scene);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *p = &points[i];
        const uint32_t material = scene->surfaces[scene->triangle_surface[p->triangle]].material;
        const alpi_light_map *map = material == ALPI_NONE ? NULL : &maps->maps[material];
        radiance[i] = (vec3){0.0f, 0.0f, 0.0f};
        if (map != NULL && map->texture.image != ALPI_NONE) {
            float rgba[4];
            alpi_surface_look_up(scene, &map->texture, maps->images[map->texture.image],
                                 (alpi_surface_place){p->triangle, p->b1, p->b2}, false, rgba);
            const vec3 value = vec3_scale((vec3){rgba[0], rgba[1], rgba[2]}, map->scale);
            radiance[i] = reflected_by(scene, p, map->units, value);
        }
    }
}

alpi_surface_light alpi_stored_light(const alp_scene *scene)
{
    return (alpi_surface_light){.reflected = reflect, .user = scene};
}
