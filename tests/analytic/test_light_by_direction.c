// SPDX-License-Identifier: MIT
// Light by direction as it is baked, texel by texel: a convex solid under a sky and under a lamp,
// the furnace, and the irradiance that two bands give back.
//
// About the texel's own normal n the first band holds the irradiance itself,
//
//     E = ∫ L n·ω dω = (4π/3) Σ c_1m Y_1m(n),
//
// and both bands give ¼ ∫ L dω + ½ E.
#include "test_lit.h"
#include "test_scenes.h"

#include "maps/lightmap.h"
#include "scene/builtin/mesh_builder.h"
#include "sh/basis.h"

#include <math.h>
#include <stdio.h>

enum { MAPS = ALP_MAP_LIGHT | ALP_MAP_SH | ALP_MAP_DIRECTION, CHANNEL = 1 };
TEST_CONTEXT(2);

// --- bakes ---------------------------------------------------------------------------------------

/// A chart to each facet, so that no texel has two normals.
static alp_bake_options light_options(uint32_t samples)
{
    alp_bake_options o = alp_bake_options_default();
    o.maps = MAPS;
    o.light.samples = samples;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.atlas.size = 64;
    o.atlas.max_angle = 0.01f;
    o.stitch = false; // each map is stitched by itself
    return o;
}

/// A texel of a bake, in one channel.
typedef struct texel {
    vec3 position, normal, direction;
    double irradiance, error, sh[ALPI_SH1_COUNT], coverage;
} texel;

static texel texel_of(const alp_lightmap *l, uint32_t i)
{
    const alpi_texels *t = &l->texels;
    const uint32_t page = t->pages[i];
    const size_t at = 4 * ((size_t)t->pixels[i][1] * l->width + t->pixels[i][0]);
    const float *direction = alp_lightmap_map_page(l, ALP_MAP_DIRECTION, page, NULL, NULL) + at;
    const float *b = t->barycentrics[i];
    vec3 c[3];
    alpi_triangle_corners(l->scene, t->triangles[i], c);
    texel made = {
        .position =
            vec3_mad(vec3_mad(c[0], b[0], vec3_sub(c[1], c[0])), b[1], vec3_sub(c[2], c[0])),
        .normal = {t->normals[i][0], t->normals[i][1], t->normals[i][2]},
        .direction = {direction[0], direction[1], direction[2]},
        .irradiance =
            (double)alp_lightmap_map_page(l, ALP_MAP_LIGHT, page, NULL, NULL)[at + CHANNEL],
        .error = (double)l->irradiance_error_pages[page][at + CHANNEL],
        .coverage = (double)t->coverages[i],
    };
    for (uint32_t k = 0; k < ALPI_SH1_COUNT; k++) {
        made.sh[k] = (double)alp_lightmap_sh_page(l, k, page, NULL, NULL)[at + CHANNEL];
    }
    return made;
}

/// Σ c_1m Y_1m about a direction.
static double first_band(const texel *t, vec3 about)
{
    double y[ALPI_SH1_COUNT];
    alpi_sh1_basis(about, y);
    return t->sh[1] * y[1] + t->sh[2] * y[2] + t->sh[3] * y[3];
}

static double two_bands(const texel *t, vec3 about)
{
    return ALPI_PI * t->sh[0] * 0.28209479177387814 + 2.0 * ALPI_PI / 3.0 * first_band(t, about);
}

/// A ball of 10 × 6 flat facets, 1 m in radius.
static alp_scene *make_solid(void)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0.3, 0.1, -0.2}, 1.0, 10, 6, 1.0, 1);
    return test_mesh_scene(context, mesh, 0);
}

// --- the same light from everywhere --------------------------------------------------------------

/// Holds each texel, and their mean, to c_00 = 2π Y_00 L and c_1 = π √(3/4π) L n.
/// @param noise standard error of one texel's coefficient, over c_00
static void hold_even(const alp_lightmap *l, double radiance, double noise, const char *name)
{
    const double c0 = 2.0 * ALPI_PI * 0.28209479177387814 * radiance;
    const double c1 = ALPI_PI * 0.4886025119029199 * radiance;
    double worst = 0.0, sums[ALPI_SH1_COUNT] = {0.0};
    const uint32_t count = l->texels.count;
    for (uint32_t i = 0; i < count; i++) {
        const texel t = texel_of(l, i);
        const double n[3] = {(double)t.normal.y, (double)t.normal.z, (double)t.normal.x};
        for (int k = 0; k < ALPI_SH1_COUNT; k++) {
            const double apart = t.sh[k] - (k == 0 ? c0 : c1 * n[k - 1]);
            ASSERT_NEAR(apart, 0.0, (5.0 * noise + 1e-5) * c0);
            worst = fmax(worst, fabs(apart) / c0);
            sums[k] += apart / c0 / count;
        }
        // The sum of ω is as far from n as its parts across are noisy.
        ASSERT_NEAR(vec3_length(t.direction), 1.0, 1e-6);
        ASSERT_NEAR(vec3_length(vec3_sub(t.direction, t.normal)), 0.0, 5.0 * noise + 1e-4);
    }
    printf("accuracy: %s by direction, %u texels: largest error %.1e of c_00, means %+.1e %+.1e "
           "%+.1e %+.1e\n",
           name, count, worst, sums[0], sums[1], sums[2], sums[3]);
    for (int k = 0; k < ALPI_SH1_COUNT; k++) { // the ratio's bias is below one over the rays
        ASSERT_NEAR(sums[k], 0.0, 4.0 * noise / sqrt((double)count) + 1e-3);
    }
}

/// 256 rays that were not stratified would have a variance of ½ + ln w + … a ray, of which c_00 =
/// 2: .36 / √256 for c_00, and .96 · √(3) / 2 / √256 for what lies across the normal.
static const double NOISE_OF_RAYS = 0.052;

TEST(a_solid_under_an_even_sky)
{
    static const struct {
        const char *name;
        uint32_t bounces;
        alp_gather gather;
        double noise;
    } cases[] = {{"an even sky, direct,", 0, ALP_GATHER_RAYS, NOISE_OF_RAYS},
                 {"an even sky, rays,", ALP_BOUNCES_CONVERGE, ALP_GATHER_RAYS, NOISE_OF_RAYS},
                 {"an even sky, hemicubes,", ALP_BOUNCES_CONVERGE, ALP_GATHER_HEMICUBE, 5e-4}};
    for (int k = 0; k < 3; k++) {
        alp_scene *scene = make_solid();
        alp_lightmap *lightmap = NULL;
        alp_bake_options o = light_options(256);
        o.light.bounces = cases[k].bounces;
        o.light.gather = cases[k].gather;
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        o.light.lighting.sky.up[CHANNEL] = 2.0f;
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
        hold_even(lightmap, 2.0, cases[k].noise, cases[k].name);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

/// Radiance 2 above and ½ below: of the hemisphere about a normal at an angle a to the vertical,
/// the lune of solid angle 2a is below. This changes over the horizon's band, whose mean is a ratio
/// of 16 rays; the mean over the solid shows what bias is left.
TEST(a_solid_under_two_half_skies)
{
    for (int k = 0; k < 2; k++) {
        alp_scene *scene = make_solid();
        alp_lightmap *lightmap = NULL;
        alp_bake_options o = light_options(256);
        double mean = 0.0, apart = 0.0, worst = 0.0;
        o.light.bounces = k == 0 ? 0 : ALP_BOUNCES_CONVERGE;
        o.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
        o.light.lighting.sky.up[CHANNEL] = 2.0f;
        o.light.lighting.sky.down[CHANNEL] = 0.5f;
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
        const uint32_t count = lightmap->texels.count;
        for (uint32_t i = 0; i < count; i++) {
            const texel t = texel_of(lightmap, i);
            const double below = 2.0 * acos(fmax(fmin((double)t.normal.y, 1.0), -1.0));
            const double all = 2.0 * (2.0 * ALPI_PI - below) + 0.5 * below;
            const double off = t.sh[0] / 0.28209479177387814 / all - 1.0;
            ASSERT_NEAR(off, 0.0, 5.0 * NOISE_OF_RAYS);
            worst = fmax(worst, fabs(off));
            mean += all / count;
            apart += off * all / count;
        }
        printf("accuracy: two half skies by direction, %s: c_00 to %.1e, mean %+.1e\n",
               k == 0 ? "direct" : "rays", worst, apart / mean);
        ASSERT_NEAR(apart / mean, 0.0, 4.0 * NOISE_OF_RAYS / sqrt((double)count) + 1e-3);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

/// Oracle 14: radiance 2 from everywhere, direct and bounced.
TEST(the_furnace)
{
    for (int adaptive = 0; adaptive < 2; adaptive++) {
        alp_scene *scene = NULL;
        alp_lightmap *lightmap = NULL;
        alp_bake_options o = light_options(256);
        o.atlas.size = 32;
        o.sampling.accuracy = adaptive ? ALP_ADAPTIVE_AUTO : ALP_ADAPTIVE_OFF;
        ASSERT_OK(context, alp_scene_load(context, "builtin:furnace", &scene));
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
        // Direct light is half of it, by 64 samples of emitters that surround a texel.
        hold_even(lightmap, 2.0, 2.0 * NOISE_OF_RAYS,
                  adaptive ? "the furnace, adaptive," : "the furnace");
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

// --- a lamp --------------------------------------------------------------------------------------

static const vec3 LAMP = {3.0f, 2.0f, 1.0f};

/// I/r² Y(ω) where it is seen. Half a texel is h = 0.06 m, the lamp 2.7 m away: its middle is right
/// to a few squares of h/r, 5e-4, of the coefficients, and to a third of h/r where the lamp is so
/// low that one side of the texel gets all of the light. Dark texels point along the normal.
TEST(a_solid_under_a_lamp)
{
    uint32_t lit = 0, dark = 0;
    double worst = 0.0;
    alp_scene *scene = make_solid();
    alp_lightmap *lightmap = NULL;
    alp_bake_options o = light_options(16);
    o.light.bounces = 0;
    const alpi_light lamp = {.kind = ALP_LIGHT_POINT,
                             .color = {1, 1, 1},
                             .intensity = 50.0f,
                             .position = LAMP,
                             .range = INFINITY};
    test_lit_set_lamps(scene, &lamp, 1);
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const texel t = texel_of(lightmap, i);
        const vec3 d = vec3_sub(LAMP, t.position);
        const double r = (double)vec3_length(d), largest = 50.0 / (2.7 * 2.7);
        const vec3 toward = vec3_scale(d, (float)(1.0 / r));
        const bool seen = vec3_dot(toward, t.normal) > 0.0f;
        double y[ALPI_SH1_COUNT];
        alpi_sh1_basis(toward, y);
        if (t.coverage < 0.999) {
            continue;
        }
        for (int k = 0; k < ALPI_SH1_COUNT; k++) {
            const double wanted = seen ? 50.0 / (r * r) * y[k] : 0.0;
            ASSERT_NEAR(t.sh[k], wanted, 5e-3 * largest);
            worst = fmax(worst, fabs(t.sh[k] - wanted) / largest);
        }
        ASSERT_NEAR(4.0 * ALPI_PI / 3.0 * first_band(&t, t.normal), t.irradiance, 2e-5 * largest);
        ASSERT_NEAR(vec3_length(vec3_sub(t.direction, seen ? toward : t.normal)), 0.0, 8e-3);
        lit += seen;
        dark += !seen;
    }
    printf("accuracy: a lamp by direction, %u texels lit, %u dark: largest error %.1e of E⊥\n", lit,
           dark, worst);
    assert_true(lit > 200 && dark > 200);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

// --- a rectangle ---------------------------------------------------------------------------------

/// Solid angle of a triangle. From: A. van Oosterom, J. Strackee. The Solid Angle of a Plane
/// Triangle. IEEE Transactions on Biomedical Engineering 1983.
static double solid_angle(vec3 a, vec3 b, vec3 c)
{
    const double x = (double)vec3_length(a), y = (double)vec3_length(b), z = (double)vec3_length(c);
    const double volume = fabs((double)vec3_dot(a, vec3_cross(b, c)));
    return 2.0 * atan2(volume, x * y * z + (double)vec3_dot(a, b) * z + (double)vec3_dot(a, c) * y +
                                   (double)vec3_dot(b, c) * x);
}

/// ∫ ω dω of a polygon whose front is seen: −½ Σ γ Γ with γ and Γ of oracle 11.
static vec3 light_vector(const vec3 corners[4])
{
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 4; i++) {
        const vec3 a = corners[i], b = corners[(i + 1) % 4];
        const vec3 across = vec3_cross(a, b);
        const double sine = (double)vec3_length(across),
                     angle = atan2(sine, (double)vec3_dot(a, b));
        sum = vec3_mad(sum, (float)(-0.5 * angle / sine), across);
    }
    return sum;
}

/// A floor of 2 m under a rectangle 1 m above it, of radiance 1. At least 64 points of it tell the
/// solid angle and what of the light vector lies across the normal, to 1 % or less, as it is
/// narrow; what lies along is the irradiance, a closed form. Twice that is the limit.
TEST(a_floor_under_a_rectangle)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    const vec3 none = {0, 0, 0}, one = {1, 1, 1};
    const vec3 floor[4] = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    const vec3 lamp[4] = {{-0.4f, 1, -0.2f}, {0.4f, 1, -0.2f}, {0.4f, 1, 0.3f}, {-0.4f, 1, 0.3f}};
    double worst[2] = {0.0, 0.0};
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", none, none));
    alpi_builder_quad(&b, floor);
    alpi_builder_surface(&b, "lamp", alpi_builder_material(&b, "lamp", none, one));
    alpi_builder_quad(&b, lamp);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_bake_options o = light_options(256);
    o.light.bounces = 0;
    o.only = "floor";
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const texel t = texel_of(lightmap, i);
        vec3 to[4];
        for (int k = 0; k < 4; k++) {
            to[k] = vec3_sub(lamp[k], t.position);
        }
        const double angle = solid_angle(to[0], to[1], to[2]) + solid_angle(to[0], to[2], to[3]);
        const vec3 v = light_vector(to);
        const double wanted[ALPI_SH1_COUNT] = {
            0.28209479177387814 * angle, 0.4886025119029199 * (double)v.y,
            0.4886025119029199 * (double)v.z, 0.4886025119029199 * (double)v.x};
        for (int k = 0; k < ALPI_SH1_COUNT; k++) {
            const double off = fabs(t.sh[k] - wanted[k]) / wanted[0];
            worst[k > 0] = fmax(worst[k > 0], off);
            ASSERT_NEAR(off, 0.0, 0.02);
        }
    }
    printf("accuracy: a rectangle by direction, %u texels: c_00 to %.1e, c_1 to %.1e of it\n",
           lightmap->texels.count, worst[0], worst[1]);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

// --- rooms ---------------------------------------------------------------------------------------

static alp_lightmap *bake_cornell(const alp_bake_options *options, alp_scene **scene)
{
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", scene));
    ASSERT_OK(context, alp_bake(*scene, options, &lightmap, NULL));
    return lightmap;
}

/// The first band gives E back: direct light, what is bounced, the sky and all rounds of rays are
/// in both maps alike, to floats. A cubic that was kept from going below zero is not, in one of
/// them.
TEST(the_first_band_is_the_irradiance)
{
    static const struct {
        const char *name;
        alp_gather gather;
        alp_direct direct;
        uint32_t bounces;
        float error;
    } cases[] = {{"by rays", ALP_GATHER_RAYS, ALP_DIRECT_ON, ALP_BOUNCES_CONVERGE, 0.0f},
                 {"without direct", ALP_GATHER_RAYS, ALP_DIRECT_OFF, ALP_BOUNCES_CONVERGE, 0.0f},
                 {"to 1.2 %", ALP_GATHER_RAYS, ALP_DIRECT_ON, 1, 0.012f},
                 {"by hemicubes", ALP_GATHER_HEMICUBE, ALP_DIRECT_ON, 1, 0.0f},
                 {"direct", ALP_GATHER_RAYS, ALP_DIRECT_ON, 0, 0.0f}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        alp_scene *scene = NULL;
        alp_bake_options o = light_options(64); // E and the band have the same noise
        double mean = 0.0, squares = 0.0, apart = 0.0, bands = 0.0, worst = 0.0;
        o.light.gather = cases[k].gather;
        o.light.direct = cases[k].direct;
        o.light.bounces = cases[k].bounces;
        o.light.error = cases[k].error;
        o.light.hemicube = 32;
        const bool cubics = o.light.direct == ALP_DIRECT_OFF; // near nothing is dark otherwise
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        o.light.lighting.sky.up[CHANNEL] = 0.5f;
        alp_lightmap *lightmap = bake_cornell(&o, &scene);
        const uint32_t count = lightmap->texels.count;
        for (uint32_t i = 0; i < count; i++) {
            const texel t = texel_of(lightmap, i);
            const double off = 4.0 * ALPI_PI / 3.0 * first_band(&t, t.normal) - t.irradiance;
            const double of_bands = two_bands(&t, t.normal) - t.irradiance;
            mean += t.irradiance / count;
            apart += off / count;
            squares += off * off / count;
            bands += of_bands * of_bands / count;
            worst = fmax(worst, fabs(of_bands));
        }
        printf("accuracy: Cornell box %s, %u texels: first band %+.1e, RMSE %.1e; both bands about "
               "the normal RMSE %.1e, largest error %.1e of the mean E\n",
               cases[k].name, count, apart / mean, sqrt(squares) / mean, sqrt(bands) / mean,
               worst / mean);
        ASSERT_NEAR(apart / mean, 0.0, cubics ? 1e-4 : 1e-6);
        ASSERT_NEAR(sqrt(squares) / mean, 0.0, cubics ? 1e-3 : 1e-6);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

/// Root mean square of the difference of c_00 over its mean.
static double difference(const alp_lightmap *a, const alp_lightmap *b, double *mean)
{
    double squares = 0.0, sum = 0.0, of_a = 0.0;
    for (uint32_t i = 0; i < a->texels.count; i++) {
        const double x = texel_of(a, i).sh[0], y = texel_of(b, i).sh[0];
        squares += (x - y) * (x - y);
        sum += y - x;
        of_a += x;
    }
    *mean = sum / of_a;
    return sqrt(squares * a->texels.count) / of_a;
}

/// Interpolated texels are as far from traced ones as two bakes with other seeds are.
TEST(interpolation_is_within_the_noise)
{
    alp_lightmap *maps[3];
    alp_scene *scenes[3] = {NULL, NULL, NULL};
    double noise, adaptive, mean;
    for (int k = 0; k < 3; k++) {
        alp_bake_options o = light_options(256);
        o.occlusion.seed = k == 0 ? 1 : 2;
        o.sampling.accuracy = k == 2 ? ALP_ADAPTIVE_AUTO : ALP_ADAPTIVE_OFF;
        maps[k] = bake_cornell(&o, &scenes[k]);
    }
    noise = difference(maps[0], maps[1], &mean);
    adaptive = difference(maps[0], maps[2], &mean);
    printf("accuracy: c_00 of two bakes %.1e apart, of an adaptive one %.1e, mean %+.1e\n", noise,
           adaptive, mean);
    assert_true(adaptive < 1.2 * noise);
    ASSERT_NEAR(mean, 0.0, 5e-3);
    for (int k = 0; k < 3; k++) {
        alp_lightmap_destroy(maps[k]);
        alp_scene_destroy(scenes[k]);
    }
}

TEST(workers_change_nothing)
{
    alp_lightmap *maps[2];
    alp_scene *scenes[2] = {NULL, NULL};
    alp_bake_options o = light_options(64);
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    alp_context *contexts[2] = {test_context(1), test_context(5)};
    for (int k = 0; k < 2; k++) {
        ASSERT_OK(contexts[k], alp_scene_load(contexts[k], "builtin:cornell", &scenes[k]));
        ASSERT_OK(contexts[k], alp_bake(scenes[k], &o, &maps[k], NULL));
    }
    const size_t size = sizeof(float) * 4 * maps[0]->width * maps[0]->height;
    for (uint32_t i = 0; i < ALPI_SH1_COUNT; i++) {
        assert_memory_equal(alp_lightmap_sh_page(maps[0], i, 0, NULL, NULL),
                            alp_lightmap_sh_page(maps[1], i, 0, NULL, NULL), size);
    }
    assert_memory_equal(maps[0]->direction_pages[0], maps[1]->direction_pages[0], size);
    assert_null(alp_lightmap_sh_page(maps[0], 4, 0, NULL, NULL));
    for (int k = 0; k < 2; k++) {
        alp_lightmap_destroy(maps[k]);
        alp_scene_destroy(scenes[k]);
        alp_context_destroy(contexts[k]);
    }
}
