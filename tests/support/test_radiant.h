// SPDX-License-Identifier: MIT
// A scene with an atlas, radiosity solved on it, and the light of every texel.
#ifndef TEST_RADIANT_H
#define TEST_RADIANT_H

#include "test_lit.h"

#include "maps/radiosity/radiosity.h"
#include "scene/builtin/mesh_builder.h"
#include "transport/gather/cosine_rays.h"
#include "transport/gather/hemicube.h"

typedef struct test_radiant_options {
    const alp_lighting_options *lighting; // NULL: the scene's own light alone
    uint32_t size;                        // of a page; the densest atlas that fits one, unless
    double texels_per_metre;              // this is not 0
    float max_angle;                      // of a chart
    uint32_t bounces;
    uint32_t side;     // of patches in texels: 1, 2 or 4
    double tolerance;  // of what passes leave
    uint32_t rays;     // of a block
    uint32_t hemicube; // pixels along an edge, in place of rays; 0: rays
    uint32_t direct_samples;
    uint64_t kept_limit, seed;
    bool soft_sky; // a sky is what the rays of blocks find, not direct light
} test_radiant_options;

/// A page of 64, a chart to each plane; all bounces, to 1e-5; patches of 4 × 4 with 64 rays, all
/// kept; 256 samples of each light; seed 1.
test_radiant_options test_radiant_default(void);

/// Stays where it was opened: parts of it point at others.
typedef struct test_radiant {
    alp_context *context;
    test_lit lit;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_cosine_rays rays;
    alpi_hemicube *cube;
    alpi_hemicube_options cubes;
    alpi_gatherer gatherer;
    alpi_lighting *soft, *direct; // of a soft sky, else NULL
    alpi_radiosity solution;
    alpi_reference_value *values; // [texels] E, or NULL: see test_radiant_gather
} test_radiant;

/// Takes the scene over, and works with its context.
void test_radiant_open(alp_scene *scene, const test_radiant_options *options, test_radiant *r);
void test_radiant_close(test_radiant *r);

/// The last bounce from every texel by its own cosine rays, and direct light added, as in a bake.
void test_radiant_gather(test_radiant *r, uint32_t samples);

/// The area mean of the gathered E over a surface (ALPI_NONE: over all), one channel.
/// @param error NULL, or out: standard error by those of the texels
double test_radiant_mean(const test_radiant *r, uint32_t surface, int channel, double *error);
/// The same over what the solver has, without another gathering: E of blocks and direct light.
double test_radiant_solved_mean(const test_radiant *r, uint32_t surface, int channel);

uint32_t test_radiant_surface(const test_radiant *r, uint32_t texel);
/// Representative point.
vec3 test_radiant_position(const test_radiant *r, uint32_t texel);

/// A material of one grey.
uint32_t test_grey(alpi_builder *b, const char *name, double albedo, double radiance);

#endif
