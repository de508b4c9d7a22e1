// SPDX-License-Identifier: MIT
// Bounced light by hemicubes against bounced light by many rays, from the same solution at the same
// points of six scenes.
#include "test_radiant.h"

#include "base/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// What sees its light through a crack of a pixel is missed by a hemicube, or counted twice, and
// such a point alone may decide a root mean square: the worst of a hundred are left out, five.
enum { POINTS = 100, LEFT_OUT = 5, RAYS = 65536 };

TEST_CONTEXT(2);

/// A point somewhere in each of some random texels: in their middles some would lie exactly in the
/// plane of what they touch, where rays that start there may meet it or not.
typedef struct points {
    float positions[POINTS][3], geometric[POINTS][3], shading[POINTS][3], offsets[POINTS];
    alpi_point_array array;
} points;

/// Whether the first that is met straight above is a back: the point lies under something that
/// stands on it, where light comes through cracks alone.
static bool is_buried(const test_radiant *r, const alpi_receiver_point *at)
{
    const vec3 up = at->geometric_normal;
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, 0, vec3_add(at->position, vec3_scale(up, 1e-3f)), up, INFINITY);
    alpi_trace_nearest(r->lit.tracer, &rays, 1, (alpi_trace_filter){.one_sided = false}, &hits);
    if (hits.triangle[0] == ALPI_NONE) {
        return false;
    }
    vec3 c[3];
    alpi_triangle_corners(r->lit.scene, hits.triangle[0], c);
    return vec3_dot(vec3_triangle_normal(c[0], c[1], c[2], up), up) > 0.0f;
}

static void choose_points(const test_radiant *r, points *p)
{
    const alpi_receivers texels = alpi_texels_receivers(&r->texels);
    uint64_t tried = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        alpi_receiver_point at;
        do {
            const uint32_t texel = (uint32_t)(alpi_hash64(++tried) % r->texels.count);
            texels.place(texels.user, texel, 1, (const float[1][2]){{0.37f, 0.61f}}, &at);
        } while (is_buried(r, &at));
        vec3_store(p->positions[i], at.position);
        vec3_store(p->geometric[i], at.geometric_normal);
        vec3_store(p->shading[i], at.shading_normal);
        p->offsets[i] = at.offset;
    }
    p->array = (alpi_point_array){.count = POINTS,
                                  .positions = p->positions,
                                  .geometric_normals = p->geometric,
                                  .shading_normals = p->shading,
                                  .offsets = p->offsets};
}

static void gather(const test_radiant *r, const points *p, const alpi_gatherer *gatherer,
                   alpi_reference_value *values)
{
    const alpi_gather_scene from = alpi_radiosity_scene(&r->solution);
    const alpi_receivers receivers = alpi_point_array_receivers(&p->array);
    const alpi_gather_job job = {.context = context,
                                 .from = &from,
                                 .gatherer = gatherer,
                                 .receivers = &receivers,
                                 .count = POINTS,
                                 .values = values};
    ASSERT_OK(context, alpi_gather_irradiance(&job, NULL));
}

static int ascending(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/// Root mean square of what hemicubes are off at all but LEFT_OUT points, over the mean of the
/// light, less what rays are.
static double hemicube_error(const test_radiant *r, const points *p, uint32_t n,
                             const alpi_reference_value *truth, double *noise)
{
    static alpi_reference_value values[POINTS];
    alpi_hemicube *cube = NULL;
    double off[POINTS] = {0.0}, squares = 0.0, variance = 0.0, mean = 0.0;
    ASSERT_OK(context, alpi_hemicube_create(context, n, &cube));
    const alpi_hemicube_options o = {.context = context, .cube = cube, .turned = true, .seed = 4};
    const alpi_gatherer gatherer = alpi_hemicube_gatherer(&o);
    gather(r, p, &gatherer, values);
    for (uint32_t i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            const double apart = (double)values[i].mean[k] - (double)truth[i].mean[k];
            off[i] += apart * apart;
            variance += (double)truth[i].variance[k];
            mean += (double)truth[i].mean[k];
        }
    }
    qsort(off, POINTS, sizeof *off, ascending);
    for (uint32_t i = 0; i + LEFT_OUT < POINTS; i++) {
        squares += off[i];
    }
    alpi_hemicube_destroy(cube);
    mean /= 3.0 * POINTS;
    *noise = sqrt(variance / (3.0 * POINTS)) / mean;
    return sqrt(fmax(squares - variance, 0.0) / (3.0 * POINTS)) / mean;
}

/// At most 1 % at 64² and ½ % at 128²; more under an open sky, where what is bright is
/// seen through windows and arches and is not much larger than a pixel: about what was measured.
TEST(hemicubes_find_what_rays_find)
{
    static const struct {
        const char *name;
        bool sky;
        double limits[2]; // at 64² and 128²
    } scenes[] = {{"cornell", false, {0.01, 0.005}},
                  {"furnace", false, {0.01, 0.005}},
                  {"teapot-room", false, {0.01, 0.005}},
                  {"windows", true, {0.018, 0.009}},
                  {"atrium,triangles=20000", true, {0.01, 0.005}},
                  {"terrain,triangles=20000", true, {0.01, 0.005}}};
    static points p;
    static alpi_reference_value truth[POINTS];
    for (int i = 0; i < 6; i++) {
        char name[64];
        alp_scene *scene = NULL;
        alp_lighting_options sky = alp_lighting_options_default();
        test_radiant_options o = test_radiant_default();
        test_radiant r;
        double noise;
        sky.sky.kind = scenes[i].sky ? ALP_SKY_CONSTANT : ALP_SKY_NONE;
        snprintf(name, sizeof name, "builtin:%s", scenes[i].name);
        ASSERT_OK(context, alp_scene_load(context, name, &scene));
        o.lighting = &sky;
        o.size = i < 2 ? 64 : 192;
        o.max_angle = 0.8f;
        o.direct_samples = 16;
        o.bounces = 3;
        test_radiant_open(scene, &o, &r);
        choose_points(&r, &p);
        const alpi_cosine_rays rays = {
            .context = context, .samples = RAYS, .replicates = 8, .seed = 3};
        const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
        gather(&r, &p, &gatherer, truth);
        const double coarse = hemicube_error(&r, &p, 64, truth, &noise);
        const double fine = hemicube_error(&r, &p, 128, truth, &noise);
        printf("accuracy: bounced light by hemicubes against %d rays, %s: 64² %.2f %%, 128² %.2f "
               "%% (rays %.2f %%)\n",
               RAYS, scenes[i].name, 100.0 * coarse, 100.0 * fine, 100.0 * noise);
        assert_true(noise < 6e-3);
        assert_true(coarse < scenes[i].limits[0]);
        assert_true(fine < scenes[i].limits[1]);
        test_radiant_close(&r);
    }
}
