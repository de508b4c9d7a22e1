// SPDX-License-Identifier: MIT
// Choices that follow from the options of a bake. All of them are made here.
#ifndef ALPI_BAKE_SETTINGS_H
#define ALPI_BAKE_SETTINGS_H

#include "scene/scene.h"

#include <alpenglow/bake.h>

enum { ALPI_MAPS_BY_DIRECTION = ALP_MAP_SH | ALP_MAP_DIRECTION };

/// Whether any map is baked that needs the rays of occlusion.
bool alpi_bake_wants_occlusion(const alp_bake_options *options);
/// Whether any map of light is baked.
bool alpi_bake_wants_light(const alp_bake_options *options);
/// Whether direct and bounced light get maps of their own.
bool alpi_bake_lights_apart(const alp_bake_options *options);

/// Whether the output is a viewer's own file in place of an asset (files/viewer_file.c).
bool alpi_bake_is_viewer_file(const alp_bake_options *options);
/// The ending of that file's name: ".json", ".babylon".
const char *alpi_bake_viewer_ending(const alp_bake_options *options);
/// Whether the output is a .glb or .gltf.
bool alpi_bake_is_gltf(const alp_bake_options *options);
/// Whether the asset is made anew from the scene in world space, not from the file of the scene.
bool alpi_bake_exports(const alp_bake_options *options, const alp_scene *scene);
/// Units of the light in an asset; never AUTO.
alp_light_units alpi_bake_light_units(const alp_bake_options *options);

#endif
