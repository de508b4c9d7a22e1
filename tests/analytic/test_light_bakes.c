// SPDX-License-Identifier: MIT
// Baked irradiance against closed forms, texel by texel: a convex solid under a sun, a sky and a
// lamp, where each facet sees all that is above it; the furnace; the mean over a closed room.
#include "test_lit.h"
#include "test_scenes.h"

#include "maps/lightmap.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

TEST_CONTEXT(2);

/// 16 replicates measure the spread (Student's t of 15 degrees of freedom), of hundreds of texels:
/// the largest of 500 is beyond this once in 10,000 bakes.
static const double STANDARD_ERRORS = 9.0;

// --- bakes ---------------------------------------------------------------------------------------

/// A chart to each facet, so that no texel has two normals.
static alp_bake_options light_options(uint32_t samples)
{
    alp_bake_options o = alp_bake_options_default();
    o.maps = ALP_MAP_LIGHT;
    o.light.samples = samples;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.atlas.size = 64;
    o.atlas.max_angle = 0.01f;
    return o;
}

/// A texel of a bake: where it is, its value and its standard error in one channel.
typedef struct texel {
    vec3 position, normal;
    double value, error, coverage, area;
} texel;

static texel texel_of(const alp_lightmap *lightmap, uint32_t i, int channel)
{
    const alpi_texels *t = &lightmap->texels;
    vec3 c[3];
    alpi_triangle_corners(lightmap->scene, t->triangles[i], c);
    const float *b = t->barycentrics[i];
    uint32_t width = 0;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, t->pages[i], &width, NULL);
    const size_t place = 4 * ((size_t)t->pixels[i][1] * width + t->pixels[i][0]) + (size_t)channel;
    return (texel){
        .position =
            vec3_mad(vec3_mad(c[0], b[0], vec3_sub(c[1], c[0])), b[1], vec3_sub(c[2], c[0])),
        .normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 1, 0}),
        .value = (double)page[place],
        .error = (double)lightmap->irradiance_error_pages[t->pages[i]][place],
        .coverage = (double)t->coverages[i],
        .area = (double)t->areas[i],
    };
}

static float ao_of(const alp_lightmap *lightmap, uint32_t i)
{
    const alpi_texels *t = &lightmap->texels;
    uint32_t width = 0;
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_AO, t->pages[i], &width, NULL);
    return page[(size_t)t->pixels[i][1] * width + t->pixels[i][0]];
}

/// A ball of 10 × 6 flat facets of different size, 1 m in radius.
static alp_scene *make_solid(void)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0.3, 0.1, -0.2}, 1.0, 10, 6, 1.0, 1);
    return test_mesh_scene(context, mesh, 0);
}

/// What is expected of a bake.
typedef struct expected {
    const char *name;
    /// What the light gives at a point; < 0: no closed form there (the horizon cuts a disk).
    double (*exact)(vec3 position, vec3 normal);
    double largest;     // of E
    double texel, mean; // parts of it that may be missing of each, and of their mean
} expected;

/// Bakes the solid and holds every texel to what is expected.
static void hold_one(const expected *e, const alp_scene *scene, const alp_bake_options *o)
{
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    uint32_t lit = 0, dark = 0;
    double worst = 0.0, apart = 0.0, variance = 0.0, area = 0.0;
    ASSERT_OK(context, alp_bake(scene, o, &lightmap, &report));
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const texel t = texel_of(lightmap, i, 1);
        const double wanted = e->exact(t.position, t.normal);
        if (wanted < 0.0 || t.coverage < 0.999) {
            continue;
        }
        ASSERT_NEAR(t.value, wanted, STANDARD_ERRORS * t.error + e->texel * e->largest);
        worst = fmax(worst, fabs(t.value - wanted) / e->largest);
        apart += t.area * (t.value - wanted);
        variance += t.area * t.area * t.error * t.error;
        area += t.area;
        lit += wanted > 0.0;
        dark += wanted == 0.0 && t.value == 0.0;
    }
    printf(
        "accuracy: a solid under %s baked by %s, %u texels lit, %u dark: largest error %.1e, mean "
        "%+.1e of the largest E\n",
        e->name, o->light.gather == ALP_GATHER_PATHS ? "paths" : "rays", lit, dark, worst,
        apart / area / e->largest);
    assert_true(lit > 200);
    ASSERT_NEAR(apart / area, 0.0, 4.0 * sqrt(variance) / area + e->mean * e->largest);
    // The rays of a texel are as many as its error wants; paths as many as they were asked for.
    assert_true(report.light_samples == o->light.samples || o->light.gather != ALP_GATHER_PATHS);
    alp_lightmap_destroy(lightmap);
}

/// By radiosity and by the reference: nothing is bounced here, both are direct light.
static void hold(const expected *e, alp_scene *scene, const alp_bake_options *o)
{
    alp_bake_options own = *o;
    own.light.gather = ALP_GATHER_RAYS;
    hold_one(e, scene, &own);
    own.light.gather = ALP_GATHER_PATHS;
    hold_one(e, scene, &own);
    alp_scene_destroy(scene);
}

// --- a convex solid ------------------------------------------------------------------------------

static const double AZIMUTH = 2.1, ELEVATION = 0.6, SIZE = 0.2;

static double sun_cosine(vec3 normal)
{
    return cos(ELEVATION) * (sin(AZIMUTH) * (double)normal.x + cos(AZIMUTH) * (double)normal.z) +
           sin(ELEVATION) * (double)normal.y;
}

/// E⊥ cosθ⁺ of 500 lux.
static double exact_sun(vec3 position, vec3 normal)
{
    (void)position;
    return 500.0 * fmax(sun_cosine(normal), 0.0);
}

static double exact_wide_sun(vec3 position, vec3 normal)
{
    return fabs(sun_cosine(normal)) > sin(0.5 * SIZE) ? exact_sun(position, normal) : -1.0;
}

/// Oracle 3's light: E = E⊥ cosθ⁺, of a point and of a disk.
TEST(a_solid_under_a_sun)
{
    alp_bake_options o = light_options(16);
    o.light.lighting.sun.azimuth = (float)AZIMUTH;
    o.light.lighting.sun.elevation = (float)ELEVATION;
    o.light.lighting.sun.illuminance = 500.0f;
    o.light.lighting.sun.size = 0.0f;
    hold(&(expected){"a sun", exact_sun, 500.0, 2e-6, 2e-6}, make_solid(), &o); // floats
    o.light.lighting.sun.size = (float)SIZE;
    o.light.samples = 256;
    // The balance heuristic leaves sin² of the light to rays that meet the disk by chance: one or
    // two of a texel's 256, which may be none.
    hold(&(expected){"a wide sun", exact_wide_sun, 500.0, pow(sin(0.5 * SIZE), 2.0), 2e-6},
         make_solid(), &o);
}

/// π (up (1 + cos t) + down (1 − cos t)) / 2 with up 2 and down .5 (oracle 2).
static double exact_sky(vec3 position, vec3 normal)
{
    (void)position;
    const double c = (double)normal.y;
    return ALPI_PI * (2.0 * (1.0 + c) + 0.5 * (1.0 - c)) / 2.0;
}

TEST(a_solid_under_a_sky)
{
    alp_bake_options o = light_options(256);
    o.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.light.lighting.sky.up[1] = 2.0f;
    o.light.lighting.sky.down[1] = 0.5f;
    hold(&(expected){"a sky of two colours", exact_sky, 2.0 * ALPI_PI, 2e-6, 2e-6}, make_solid(),
         &o);
}

static const vec3 LAMP = {3.0f, 2.0f, 1.0f};

/// I/r² cosθ⁺ of 50 candela.
static double exact_lamp(vec3 position, vec3 normal)
{
    const vec3 d = vec3_sub(LAMP, position);
    const double r = (double)vec3_length(d);
    return 50.0 / (r * r) * fmax((double)vec3_dot(d, normal) / r, 0.0);
}

/// A texel is the mean over its area. Half of one is h = 0.06 m, the lamp r = 2.7 m away: its
/// middle is right to (h/r)² = 5e-4 of it, and twice that leaves room for the cosine.
TEST(a_solid_under_a_lamp)
{
    const alp_bake_options o = light_options(16);
    alp_scene *scene = make_solid();
    test_lit_set_lamps(scene,
                       &(alpi_light){.kind = ALP_LIGHT_POINT,
                                     .color = {1, 1, 1},
                                     .intensity = 50.0f,
                                     .position = LAMP,
                                     .range = INFINITY},
                       1);
    hold(&(expected){"a lamp", exact_lamp, 50.0 / (2.7 * 2.7), 1e-3, 1e-3}, scene, &o);
}

// --- closed rooms --------------------------------------------------------------------------------

/// Oracle 14: the furnace is of radiance 2 everywhere, E = 2π; after no bounce it is of 1.
TEST(every_texel_of_the_furnace)
{
    for (int k = 0; k < 2; k++) {
        alp_bake_options o = light_options(256);
        alp_scene *scene = NULL;
        alp_lightmap *lightmap = NULL;
        alp_bake_report report;
        double sum = 0.0, area = 0.0, variance = 0.0;
        const double exact = k == 0 ? ALPI_PI : 2.0 * ALPI_PI;
        o.atlas.size = 32;
        o.light.bounces = k == 0 ? 0 : ALP_BOUNCES_CONVERGE;
        ASSERT_OK(context, alp_scene_load(context, "builtin:furnace", &scene));
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, &report));
        for (uint32_t i = 0; i < lightmap->texels.count; i++) {
            const texel t = texel_of(lightmap, i, 2);
            ASSERT_NEAR(t.value, exact, STANDARD_ERRORS * t.error + 1e-6 * exact);
            sum += t.area * t.value;
            variance += t.area * t.area * t.error * t.error;
            area += t.area;
        }
        ASSERT_NEAR(area, 6.0, 1e-4);
        ASSERT_NEAR(sum / area, exact, 4.0 * sqrt(variance) / area + 1e-6 * exact);
        ASSERT_NEAR(report.light_mean, exact, 2e-3 * exact);
        printf("accuracy: baked furnace, %u texels: mean %+.1e\n", lightmap->texels.count,
               sum / area / exact - 1.0);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

/// A room of one albedo with a box in it and a glowing ceiling: the mean of the texels by their
/// area is Φ / ((1 − ρ) A), as each texel's value is the mean over it.
TEST(the_mean_over_a_closed_room)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    const double rho = 0.6;
    const float a = (float)rho;
    const vec3 high = {1, 1, 1}, low = {0, 0, 0};
    alpi_builder_start(&b, context, "room");
    const uint32_t dull = alpi_builder_material(&b, "dull", (vec3){a, a, a}, low);
    alpi_builder_surface(&b, "walls", dull);
    alpi_builder_box(&b, high, low, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "box", dull);
    alpi_builder_box(&b, (vec3){0.2f, 0.3f, 0.1f}, (vec3){0.5f, 0.7f, 0.6f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "ceiling",
                         alpi_builder_material(&b, "ceiling", (vec3){a, a, a}, high));
    alpi_builder_box(&b, high, low, ALPI_FACE_TOP);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_bake_options o = light_options(256);
    o.atlas.size = 40;
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
    double sum = 0.0, area = 0.0, variance = 0.0;
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const texel t = texel_of(lightmap, i, 0);
        sum += t.area * t.value;
        variance += t.area * t.area * t.error * t.error;
        area += t.area;
    }
    const double exact = ALPI_PI / ((1.0 - rho) * scene->area), error = sqrt(variance) / area;
    printf("accuracy: baked closed room, %u texels: mean %+.1e, standard error %.1e\n",
           lightmap->texels.count, sum / area / exact - 1.0, error / exact);
    ASSERT_NEAR(area, scene->area, 1e-4 * area);
    ASSERT_NEAR(sum / area, exact, 4.0 * error);
    assert_true(error < 3e-3 * exact);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

/// A block on a slab under an even sky, and a bar through the slab that looks out on both sides.
/// The block's lower side is black to the last bit, although rays from it meet the bar in texels
/// that are half out of the slab.
TEST(nothing_below_a_block_is_lit)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alpi_builder_start(&b, context, "block");
    const uint32_t grey = alpi_builder_material(&b, "grey", (vec3){0.8f, 0.8f, 0.8f}, (vec3){0});
    alpi_builder_surface(&b, "block", grey);
    alpi_builder_box(&b, (vec3){0.37f, 0, 0.37f}, (vec3){0.64f, 0.3f, 0.64f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "slab", grey);
    alpi_builder_box(&b, (vec3){0.33f, -0.2f, 0.1f}, (vec3){0.68f, 0, 0.9f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "bar", grey);
    alpi_builder_box(&b, (vec3){0.2f, -0.1f, 0.3f}, (vec3){0.8f, -0.03f, 0.7f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_bake_options o = light_options(64);
    o.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.light.lighting.sky.up[0] = o.light.lighting.sky.down[0] = 1.0f;
    o.stitch = false;
    ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
    uint32_t below = 0, lit = 0;
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const texel t = texel_of(lightmap, i, 0);
        const uint32_t surface = scene->triangle_surface[lightmap->texels.triangles[i]];
        if (surface == 0 && t.normal.y < -0.5f) {
            assert_true(t.value == 0.0);
            below++;
        }
        lit += t.value > 0.0;
    }
    assert_true(below >= 9 && lit > 5 * below);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

enum { GLASS, GLASS_OF_TWO_SIDES, SOLID, CASES };

/// A cube on the floor of a case that it nearly fills, in a room of one albedo, ½, where all glows
/// but the case: E = 2π on every side, and half of it is bounced. A millimetre is below the cube,
/// or rays that pass the floor from below would pass the cube's lower side with it.
static alp_scene *make_case(int kind)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "case");
    const vec3 half = {0.5f, 0.5f, 0.5f}, white = {1, 1, 1}, dark = {0, 0, 0};
    const uint32_t glow = alpi_builder_material(&b, "glow", half, white);
    const uint32_t glass = alpi_builder_material(&b, "glass", white, dark);
    alpi_builder_surface(&b, "cube", glow);
    alpi_builder_box(&b, (vec3){0, 0, 0}, (vec3){1, 1, 1}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "case", glass);
    alpi_builder_box(&b, (vec3){-0.04f, -0.001f, -0.04f}, (vec3){1.04f, 1.04f, 1.04f},
                     ALPI_FACE_ALL);
    alpi_builder_surface(&b, "room", glow);
    alpi_builder_box(&b, (vec3){1.5f, 1.5f, 1.5f}, (vec3){-0.5f, -0.5f, -0.5f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[glass].transmission = kind == SOLID ? 0.0f : 1.0f;
    scene->materials[glass].double_sided = kind == GLASS_OF_TWO_SIDES;
    return scene;
}

/// In a case of clear single-sided glass there is the light that would be there without it; to
/// occlusion, which glass is solid to, it is as if it had two sides. A solid case is dark inside.
TEST(what_stands_in_a_glass_case)
{
    enum { PAGE = 128 };
    static float ao[CASES][PAGE * PAGE];
    for (int i = 0; i < CASES; i++) {
        alp_scene *scene = make_case(i);
        alp_lightmap *lightmap = NULL;
        alp_bake_options o = light_options(64);
        o.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
        o.light.bounces = ALP_BOUNCES_CONVERGE;
        o.atlas.size = PAGE;
        o.stitch = false;
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
        uint32_t count = 0;
        double sum = 0.0;
        assert_in_range(lightmap->texels.count, 1, PAGE * PAGE);
        for (uint32_t k = 0; k < lightmap->texels.count; k++) {
            const texel t = texel_of(lightmap, k, 0);
            const uint32_t surface = scene->triangle_surface[lightmap->texels.triangles[k]];
            if (surface == 0 && t.normal.y > -0.5f) { // not the side that lies in the floor
                const double exact = i == SOLID ? 0.0 : 2.0 * ALPI_PI;
                ASSERT_NEAR(t.value, exact, STANDARD_ERRORS * t.error + 1e-6 * exact);
                sum += t.value / (2.0 * ALPI_PI);
                ao[i][k] = ao_of(lightmap, k);
                assert_true(i != GLASS_OF_TWO_SIDES || ao[i][k] == ao[GLASS][k]);
                count++;
            }
        }
        assert_true(count >= 5 * 12 * 12);
        printf("accuracy: a cube in a case, %u texels: mean %.4f of that without it\n", count,
               sum / count);
        // Bounced light of neighbours comes by the same patches, and errs alike.
        ASSERT_NEAR(sum / count, i == SOLID ? 0.0 : 1.0, 2e-3);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}

/// Posts half sunk in the floor of a room where all glows and reflects a half.
static alp_scene *make_sunk_posts(void)
{
    enum { ROW = 6 };
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "sunk");
    const uint32_t glow =
        alpi_builder_material(&b, "glow", (vec3){0.5f, 0.5f, 0.5f}, (vec3){1.0f, 1.0f, 1.0f});
    alpi_builder_surface(&b, "room", glow);
    alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){0, 0, 0}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "posts", glow);
    for (int i = 0; i < ROW * ROW; i++) {
        const float x = 0.037f + 0.157f * (float)(i % ROW), z = 0.041f + 0.157f * (float)(i / ROW);
        alpi_builder_box(&b, (vec3){x, -0.1f, z}, (vec3){x + 0.083f, 0.113f, z + 0.079f},
                         ALPI_FACE_ALL);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// E = 2π wherever there is light, on walls and ceiling too, whose rays meet texels of floor and
/// posts that lie in each other in part. As dark as the mean of their points those would cost .7 %.
/// By one round of rays, and by rounds for an error.
TEST(a_room_about_sunk_posts)
{
    for (int rounds = 0; rounds < 2; rounds++) {
        alp_scene *scene = make_sunk_posts();
        alp_lightmap *lightmap = NULL;
        alp_bake_options o = light_options(256);
        o.light.bounces = ALP_BOUNCES_CONVERGE;
        o.light.error = rounds != 0 ? 0.02f : 0.0f;
        o.atlas.size = 64;
        o.stitch = false;
        ASSERT_OK(context, alp_bake(scene, &o, &lightmap, NULL));
        double sum = 0.0;
        uint32_t count = 0;
        for (uint32_t k = 0; k < lightmap->texels.count; k++) {
            const texel t = texel_of(lightmap, k, 0);
            const uint32_t surface = scene->triangle_surface[lightmap->texels.triangles[k]];
            if (surface == 0 && t.normal.y < 0.5f) {
                sum += t.value / (2.0 * ALPI_PI);
                count++;
            }
        }
        printf("accuracy: a room about sunk posts, %s, %u texels: mean %+.1e\n",
               rounds != 0 ? "for 2 %" : "256 rays", count, sum / count - 1.0);
        assert_true(count >= 500);
        ASSERT_NEAR(sum / count, 1.0, 4e-3);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
    }
}
