// SPDX-License-Identifier: MIT
// Scenes with baked light as the files of viewers: three.js, Babylon.js.
#ifndef ALPI_FORMATS_VIEWERS_H
#define ALPI_FORMATS_VIEWERS_H

#include "scene/probe_volume.h"
#include "scene/scene.h"

/// Baked light over the pages of an atlas, for formats that hold a scene together with its map.
typedef struct alpi_light_pages {
    uint32_t page_count, width, height;
    const float (*corner_uvs)[3][2]; // [triangle_count] of each corner; v = 0 at row 0
    const uint32_t *triangle_pages;  // [triangle_count] NULL = all on page 0; ALPI_NONE = no map
    const float *const *pages;       // [page_count] → [height][width][4]; A is not read
    float irradiance_per_unit;       // irradiance E = this × value: 1 for E, π for E/π
} alpi_light_pages;

/// The whole scene as three.js Object JSON, in one file: MeshLambertMaterial with a lightMap of
/// half floats, T · lightMapIntensity = E, which three.js since r155 shows as albedo · E/π; no
/// lights. Colours of materials have the 8 bits of sRGB that the format gives them. Surfaces
/// without a map show their emission alone. Textures of metalness are left out, with a warning
/// (lightmap-metal). *bytes is released by the caller.
/// @return ALP_OK; LIMIT; OUT_OF_MEMORY
alp_result alpi_three_encode(const alp_scene *scene, const alpi_light_pages *light, uint8_t **bytes,
                             size_t *size);
/// The same as a .babylon file, whose maps are the Radiance pictures `page_names` beside it:
/// PBRMaterial with useLightmapAsShadowmap, T = E/π.
/// @return also UNSUPPORTED (pages of less than 8 × 8 texels)
alp_result alpi_babylon_encode(const alp_scene *scene, const alpi_light_pages *light,
                               const char *const *page_names, uint8_t **bytes, size_t *size);
/// One of those pictures.
alp_result alpi_babylon_encode_page(const alp_scene *scene, const alpi_light_pages *light,
                                    uint32_t page, uint8_t **bytes, size_t *size);

/// A lattice of spherical harmonics for LightProbeGrid (r184, r185) and LightProbeGridWebGL (r186
/// and later) of three.js: a module at `path` (.mjs, .js), which places the box for the release
/// that runs, and the texture beside it (.ktx2). Probes in solids take the light of their
/// neighbours.
/// @param scale > 0: coefficients are multiplied by it
/// @return ALP_OK; INVALID_ARGUMENT; UNSUPPORTED (a list, ambient cubes); LIMIT (a coefficient
///         beyond half floats); IO; OUT_OF_MEMORY
alp_result alpi_probes_export_three(const alpi_probe_volume *volume, const char *path, double scale,
                                    bool overwrite);

#endif
