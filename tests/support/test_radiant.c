// SPDX-License-Identifier: MIT
#include "test_radiant.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

test_radiant_options test_radiant_default(void)
{
    return (test_radiant_options){.size = 64,
                                  .max_angle = 0.01f,
                                  .bounces = UINT32_MAX,
                                  .side = 4,
                                  .tolerance = 1e-5,
                                  .rays = 64,
                                  .direct_samples = 256,
                                  .kept_limit = 1ull << 30,
                                  .seed = 1};
}

static void make_atlas(const test_radiant_options *o, test_radiant *r)
{
    alp_atlas_options a = alp_atlas_options_default();
    a.mode = ALP_ATLAS_AUTO;
    a.size = o->size;
    a.texels_per_metre = o->texels_per_metre;
    a.max_angle = o->max_angle;
    ASSERT_OK(r->context, alp_atlas_create(r->lit.scene, &a, &r->atlas));
    ASSERT_OK(r->context, alpi_texels_create(r->atlas, &r->texels));
    ASSERT_OK(r->context, alpi_lattice_create(r->atlas, &r->texels, &r->lattice));
}

static void make_gatherer(const test_radiant_options *o, test_radiant *r)
{
    if (o->hemicube == 0) {
        r->rays = (alpi_cosine_rays){
            .context = r->context, .samples = o->rays, .replicates = 1, .seed = o->seed};
        r->gatherer = alpi_cosine_rays_gatherer(&r->rays);
        return;
    }
    ASSERT_OK(r->context, alpi_hemicube_create(r->context, o->hemicube, &r->cube));
    r->cubes = (alpi_hemicube_options){
        .context = r->context, .cube = r->cube, .turned = true, .scattered = true, .seed = o->seed};
    r->gatherer = alpi_hemicube_gatherer(&r->cubes);
}

void test_radiant_open(alp_scene *scene, const test_radiant_options *options, test_radiant *r)
{
    *r = (test_radiant){.context = scene->context};
    r->lit = test_lit_open(scene, options->lighting);
    make_atlas(options, r);
    make_gatherer(options, r);
    if (options->soft_sky) {
        ASSERT_OK(r->context, alpi_lighting_split_sky(r->lit.lighting, options->lighting, &r->soft,
                                                      &r->direct));
    }
    uint8_t *proximity = ALPI_NEW(r->context, uint8_t, r->texels.count);
    assert_non_null(proximity);
    memset(proximity,
           options->side == 1   ? ALPI_TOUCHING
           : options->side == 2 ? ALPI_NEAR
                                : ALPI_FAR,
           r->texels.count);
    const alpi_radiosity_options o = {.context = r->context,
                                      .scene = scene,
                                      .tracer = r->lit.tracer,
                                      .lighting = options->soft_sky ? r->soft : r->lit.lighting,
                                      .direct = options->soft_sky ? r->direct : r->lit.lighting,
                                      .gatherer = &r->gatherer,
                                      .bounces = options->bounces,
                                      .tolerance = options->tolerance,
                                      .proximity = proximity,
                                      .direct_samples = options->direct_samples,
                                      .kept_limit = options->kept_limit,
                                      .seed = options->seed};
    ASSERT_OK(r->context, alpi_radiosity_solve(&o, &r->lattice, r->atlas, r->lattice.order,
                                               r->texels.count, NULL, &r->solution));
    alpi_release(r->context, proximity);
}

void test_radiant_close(test_radiant *r)
{
    alpi_radiosity_destroy(&r->solution);
    alpi_release(r->context, r->values);
    alpi_hemicube_destroy(r->cube);
    alpi_lighting_destroy(r->context, r->soft);
    alpi_lighting_destroy(r->context, r->direct);
    alpi_lattice_destroy(&r->lattice);
    alpi_texels_destroy(r->context, &r->texels);
    alp_atlas_destroy(r->atlas);
    test_lit_close(&r->lit);
}

void test_radiant_gather(test_radiant *r, uint32_t samples)
{
    const alpi_cosine_rays rays = {
        .context = r->context, .samples = samples, .replicates = 4, .seed = 77};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
    const alpi_gather_scene from = alpi_radiosity_scene(&r->solution);
    const alpi_receivers receivers = alpi_texels_receivers(&r->texels);
    if (r->values == NULL) {
        r->values = ALPI_NEW(r->context, alpi_reference_value, r->texels.count);
        assert_non_null(r->values);
    }
    const alpi_gather_job job = {.context = r->context,
                                 .from = &from,
                                 .gatherer = &gatherer,
                                 .receivers = &receivers,
                                 .count = r->texels.count,
                                 .values = r->values};
    ASSERT_OK(r->context, alpi_gather_irradiance(&job, NULL));
    for (uint32_t t = 0; t < r->texels.count; t++) {
        for (int k = 0; k < 3; k++) {
            r->values[t].mean[k] += r->solution.direct[t].mean[k];
            r->values[t].variance[k] += r->solution.direct[t].variance[k];
        }
    }
}

uint32_t test_radiant_surface(const test_radiant *r, uint32_t texel)
{
    return r->lit.scene->triangle_surface[r->texels.triangles[texel]];
}

vec3 test_radiant_position(const test_radiant *r, uint32_t texel)
{
    vec3 c[3];
    alpi_triangle_corners(r->lit.scene, r->texels.triangles[texel], c);
    const float *b = r->texels.barycentrics[texel];
    return vec3_mad(vec3_mad(c[0], b[0], vec3_sub(c[1], c[0])), b[1], vec3_sub(c[2], c[0]));
}

double test_radiant_mean(const test_radiant *r, uint32_t surface, int channel, double *error)
{
    double sum = 0.0, area = 0.0, variance = 0.0;
    for (uint32_t t = 0; t < r->texels.count; t++) {
        if (surface == ALPI_NONE || test_radiant_surface(r, t) == surface) {
            const double a = (double)r->texels.areas[t];
            sum += a * (double)r->values[t].mean[channel];
            variance += a * a * (double)r->values[t].variance[channel];
            area += a;
        }
    }
    if (error != NULL) {
        *error = sqrt(variance) / area;
    }
    return sum / area;
}

double test_radiant_solved_mean(const test_radiant *r, uint32_t surface, int channel)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t t = 0; t < r->texels.count; t++) {
        if (surface == ALPI_NONE || test_radiant_surface(r, t) == surface) {
            const double a = (double)r->texels.areas[t];
            const uint32_t patch = r->solution.patches.patch_of[t];
            sum += a * ((double)r->solution.direct[t].mean[channel] +
                        (double)r->solution.bounced[patch].mean[channel]);
            area += a;
        }
    }
    return sum / area;
}

uint32_t test_grey(alpi_builder *b, const char *name, double albedo, double radiance)
{
    const float a = (float)albedo, e = (float)radiance;
    return alpi_builder_material(b, name, (vec3){a, a, a}, (vec3){e, e, e});
}
