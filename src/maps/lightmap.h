// SPDX-License-Identifier: MIT
// Light on surfaces: values at the texels of an atlas, kept as pages of floats.
#ifndef ALPI_MAPS_LIGHTMAP_H
#define ALPI_MAPS_LIGHTMAP_H

#include "atlas/atlas.h"
#include "base/image.h"
#include "maps/texels/lattice.h"
#include "transport/surface_light.h"

#include <alpenglow/lightmap.h>

struct alp_lightmap {
    alp_context *context;
    const alp_scene *scene;
    float *vertex_values; // [scene vertices], owned; then there is no atlas and no page. Or NULL.
    alp_atlas *atlas;     // owned
    alpi_texels texels;
    alp_blend blend; // how the sets of an atlas of overlapping charts are read
    uint32_t page_count, width, height;
    float *errors;   // [texels] standard error of occlusion, or NULL: nobody asked for it
    uint8_t *states; // [texels] alpi_texel_state: how its value was found
    float **pages;   // [page_count] → [height][width][4]: value in RGB, coverage in A. NULL where
                     // occlusion was not asked for
    // Laid out like `pages`; NULL where the bake made none.
    float **bent_pages;                                 // bent normals: unit, world space
    float **obscurance_pages;                           // coloured obscurance
    float **irradiance_pages, **irradiance_error_pages; // W·m⁻², and its standard error
    float **direct_pages, **bounced_pages;              // W·m⁻², of which irradiance is the sum
    float **sh_pages[4], **direction_pages;             // W·m⁻²; unit, world space
    uint32_t layer_count;
    char **layer_names;   // [layer_count] owned
    float ***layer_pages; // [layer_count] W·m⁻², of which irradiance is the sum as well
};

/// Takes the atlas over (also on failure) and makes its texels; there are no pages yet.
alp_result alpi_lightmap_create(alp_atlas *atlas, alp_lightmap **lightmap);

/// Values at the scene's vertices, [scene vertices]; takes them over, also on failure.
alp_result alpi_lightmap_create_vertices(const alp_scene *scene, float *values,
                                         alp_lightmap **lightmap);

/// Writes one value per texel into R = G = B, coverage 1 into A, and fills the rest of each page
/// from the nearest covered texel, so that no filter or mip level ever reads something that is no
/// surface. Texels of unknown value (OPEN in lightmap->states) are filled like those of no surface.
/// Pages are allocated here.
alp_result alpi_lightmap_store(alp_lightmap *lightmap, const float *values);

/// The same for three values per texel, into pages of their own.
alp_result alpi_lightmap_store_vectors(alp_lightmap *lightmap, const float (*values)[3],
                                       float ***pages);

/// Standard errors of a page: float RGBA, A = 1 where the texel has a value.
alp_result alpi_lightmap_error_image(const alp_lightmap *lightmap, uint32_t page,
                                     alp_image **image);
/// How the values of a page were found, 8-bit RGB: red traced, green interpolated, blue unknown.
alp_result alpi_lightmap_sampling_image(const alp_lightmap *lightmap, uint32_t page,
                                        alp_image **image);

/// Whether the surface of a triangle has values: not those that a bake left out.
bool alpi_lightmap_holds(const alp_lightmap *lightmap, uint32_t triangle);

/// How much of a look-up comes from each coordinate set; they sum to 1, and to all of the first
/// where there is but one.
void alpi_lightmap_shares(const alp_lightmap *lightmap, uint32_t triangle, float b1, float b2,
                          float weights[3]);

/// Bilinear look-up at a point of a triangle that the lightmap holds, blended where its charts
/// overlap, or linear between the values
/// at its vertices; 1 without any.
void alpi_lightmap_sample(const alp_lightmap *lightmap, uint32_t triangle, float b1, float b2,
                          float rgb[3]);

/// What surfaces reflect by the irradiance pages, which must be there: ρ/π · E, both sides alike,
/// as viewers show a lightmap. Black where the lightmap holds nothing.
alpi_surface_light alpi_lightmap_light(const alp_lightmap *lightmap);

/// What a value, in [0, 1], is multiplied by at a cell of texel (x, y) of the layout it goes to.
typedef struct alpi_lightmap_weight {
    float (*at)(void *user, const alpi_uv_cell *cell, uint32_t x, uint32_t y); // NULL: 1
    void *user;
} alpi_lightmap_weight;
/// The map in another layout of the same triangles: page [height][width][4] of the layout's size
/// gets the weighted mean over the surface inside each texel in R = G = B and 1 in A; texels
/// without surface get the nearest value and 0 in A. The mean is taken over up to 8 × 8 points of a
/// texel, each read from the map bilinearly: a map that is more than 8 times as fine is read with
/// gaps, and one that is coarser is only interpolated.
alp_result alpi_lightmap_resample(const alp_lightmap *lightmap, const alp_atlas *layout,
                                  const alpi_lightmap_weight *weight, float *page);

/// A page as image: float RGBA as it is, or 8-bit grey (R rounded), dilated texels included.
alp_result alpi_lightmap_page_image(const alp_lightmap *lightmap, uint32_t page,
                                    alp_component component, alp_image **image);

/// RGB of a page as 8-bit RGB: scale · value + offset, rounded, outside [0, 1] cut off.
alp_result alpi_lightmap_rgb_image(const alp_lightmap *lightmap, const float *page, float scale,
                                   float offset, alp_image **image);

/// Fills pixels with A = 0 of an RGBA page from the nearest (4-connected steps) with A > 0; A stays
/// 0. A page without any covered pixel is left alone.
alp_result alpi_dilate(alp_context *context, float *page, uint32_t width, uint32_t height);

#endif
