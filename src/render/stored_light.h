// SPDX-License-Identifier: MIT
// Light of the maps that a file holds, as a viewer shows it.
#ifndef ALPI_RENDER_STORED_LIGHT_H
#define ALPI_RENDER_STORED_LIGHT_H

#include "scene/scene.h"
#include "transport/surface_light.h"

/// Light of the maps that are kept with the scene (alp_scene_read_light_maps). Surfaces whose
/// material names none reflect nothing.
alpi_surface_light alpi_stored_light(const alp_scene *scene);

#endif
