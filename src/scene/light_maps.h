// SPDX-License-Identifier: MIT
// Maps of light that the materials of a file name for viewers.
#ifndef ALPI_SCENE_LIGHT_MAPS_H
#define ALPI_SCENE_LIGHT_MAPS_H

#include "scene/scene.h"

/// The meaning of a map's values.
typedef enum alpi_light_map_units {
    ALPI_LIGHT_MAP_IRRADIANCE,    // E [W·m⁻²]; also where the file states none
    ALPI_LIGHT_MAP_IRRADIANCE_PI, // E/π
    ALPI_LIGHT_MAP_RADIANCE       // ρE/π + Lₑ [W·sr⁻¹·m⁻²]
} alpi_light_map_units;

/// A map of light that a material shows.
typedef struct alpi_light_map {
    alpi_texture texture; // image: index into the list of images, ALPI_NONE = no map
    float scale;          // what texels are multiplied by
    alpi_light_map_units units;
} alpi_light_map;
typedef struct alpi_light_maps {
    alpi_light_map *maps; // [materials of the scene]
    uint32_t image_count;
    alp_image **images; // [image_count], linear
} alpi_light_maps;

/// Those that alp_scene_read_light_maps keeps with a scene, or NULL.
static inline const alpi_light_maps *alpi_scene_light_maps(const alp_scene *scene)
{
    return scene->attachments[ALPI_ATTACHMENT_LIGHT_MAPS].data;
}

#endif
