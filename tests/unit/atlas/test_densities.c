// SPDX-License-Identifier: MIT
// Atlases with rules of their own: texel densities by surface and material, measured from the
// result, and gaps for blocks and mip levels on whole pages.
#include "atlas_scenes.h"
#include "page_owners.h"

#include "atlas/stretch.h"

#include <stdlib.h>

static const double BIN = 0.0014; // two bins of the spread's histogram, each 2^(1/1024)

static alp_scene *cornell(alp_context *context)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    return scene;
}

/// Texels per metre of a triangle.
static double density_of(const alp_atlas *atlas, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(atlas->scene, triangle, c);
    return sqrt(texel_area(atlas, triangle) / vec3_triangle_area(c[0], c[1], c[2]));
}

typedef struct expected_factor {
    const char *surface;
    double factor;
} expected_factor;

/// All triangles of a surface have the base density times its factor; those not named have 1.
static void check_factors(alp_context *context, const char *densities, double texels_per_metre,
                          const expected_factor *expected, size_t count)
{
    alp_scene *scene = cornell(context);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 256;
    options.texels_per_metre = texels_per_metre;
    options.densities = densities;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    double base = texels_per_metre;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const char *name = scene->surfaces[scene->triangle_surface[t]].name;
        double factor = 1.0;
        for (size_t i = 0; i < count; i++) {
            factor = strcmp(expected[i].surface, name) == 0 ? expected[i].factor : factor;
        }
        base = base > 0.0 ? base : density_of(atlas, t) / factor;
        // Its flat charts keep their lengths, to the rounding of coordinates: 2^-24 of a page at
        // each end of 5 texels at least.
        ASSERT_NEAR(density_of(atlas, t), base * factor, 1e-4 * base * factor);
    }
    ASSERT_NEAR(atlas->info.stretch_mean, 1.0, 2e-4); // each has what was asked of it
    ASSERT_NEAR(atlas->info.stretch_worst, 1.0, 2e-4);
    ASSERT_NEAR(atlas->info.density_spread, 1.0, BIN);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(factors_are_kept, 1)
{
    static const expected_factor names[] = {{"floor", 2.0}, {"lamp", 0.25}};
    static const expected_factor materials[] = {{"red wall", 3.0}, {"green wall", 0.5}};
    static const expected_factor both[] = {{"floor", 1.5},
                                           {"ceiling", 1.5},
                                           {"back wall", 1.5},
                                           {"short block", 3.0},
                                           {"tall block", 3.0}};
    for (int fixed = 0; fixed < 2; fixed++) {
        const double density = fixed == 0 ? 0.0 : 150.0;
        check_factors(context, NULL, density, NULL, 0);
        check_factors(context, "floor=2,la?p=.25", density, names, 2);
        check_factors(context, "material:red=3,material:g*=5e-1", density, materials, 2);
        check_factors(context, "*block=2,material:white=1.5", density, both, 5);
        check_factors(context, "floor=1000,floor=0.002,la?p=.1,lamp=2.5", density, names, 2);
    }
}

/// A floor of twice the density d where half of it is asked for. Over its area F and the others' R,
/// the density of factor 1 is b = d √((4 F + R) / (F / 4 + R)).
TEST_WITH_CONTEXT(what_is_asked_for_and_not_given_is_stretch, 1)
{
    alp_scene *scene = cornell(context);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = 256;
    options.densities = "floor=2";
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    double floor = 0.0, rest = 0.0, d = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        const bool is_floor = atlas->factors[scene->triangle_surface[t]] > 1.0f;
        *(is_floor ? &floor : &rest) += vec3_triangle_area(c[0], c[1], c[2]);
        d = is_floor ? d : density_of(atlas, t);
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        atlas->factors[s] = atlas->factors[s] > 1.0f ? 0.5f : 1.0f;
    }
    alpi_stretch_facts facts;
    ASSERT_OK(context, alpi_stretch_measure(atlas, &facts));
    const double b = d * sqrt((4.0 * floor + rest) / (0.25 * floor + rest)), own = 0.25 * b / d;
    const double mean = (0.25 * floor * own * own + rest * b * b / (d * d)) / (0.25 * floor + rest);
    ASSERT_NEAR(facts.base, b, 1e-4 * b); // as above
    ASSERT_NEAR(facts.worst, b / d, 1e-4 * b / d);
    ASSERT_NEAR(facts.mean, sqrt(mean), 1e-4 * sqrt(mean));
    ASSERT_NEAR(facts.spread, 4.0, 4.0 * BIN);
    ASSERT_NEAR(facts.texels_per_metre, d * sqrt((4.0 * floor + rest) / (floor + rest)), 1e-4 * d);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// Two squares that share an edge are one chart, but not when they are to be of unlike density.
TEST_WITH_CONTEXT(charts_hold_one_density, 1)
{
    alp_scene *scene = cornell(context);
    alp_atlas_options options = alp_atlas_options_default();
    options.densities = "floor=1.25";
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (uint32_t u = 0; u < t; u++) {
            const bool floor =
                strcmp(scene->surfaces[scene->triangle_surface[t]].name, "floor") == 0;
            const bool other =
                strcmp(scene->surfaces[scene->triangle_surface[u]].name, "floor") == 0;
            assert_true(floor == other || atlas->triangle_charts[t] != atlas->triangle_charts[u]);
        }
    }
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(what_is_no_density_is_refused, 1)
{
    static const char *const wrong[][2] = {
        {"", "give PATTERN=FACTOR"},
        {"floor", "give PATTERN=FACTOR"},
        {"=2", "give PATTERN=FACTOR"},
        {"floor=", "give PATTERN=FACTOR"},
        {"floor=2m", "give PATTERN=FACTOR"},
        {"floor=nan", "give PATTERN=FACTOR"},
        {"floor=2,", "give PATTERN=FACTOR"},
        {"floor=0", "must be in [0.001, 1000]"},
        {"floor=-1", "must be in [0.001, 1000]"},
        {"floor=1e999", "must be in [0.001, 1000]"},
        {"floor=1000,fl*=2", "\"floor\" multiply to 2000"},
        {"material:red=0.001,red*=.5", "\"red wall\" multiply to 0.0005"},
        {"*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*=1000,*="
         "1000",
         "multiply to inf"},
        {"flor=2", "the nearest names are \"floor\""},
        {"floor=2,lmap=1", "\"lamp\""},
        {"material:blue=2", "density \"material:blue=2\""},
    };
    alp_scene *scene = cornell(context);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        alp_atlas_options options = alp_atlas_options_default();
        options.densities = wrong[i][0];
        alp_atlas *atlas = NULL;
        assert_int_equal(alp_atlas_create(scene, &options, &atlas), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(atlas);
        assert_non_null(strstr(alp_context_message(context), wrong[i][1]));
    }
    alp_scene_destroy(scene);
}

static void check_gaps(alp_context *context, const alp_scene *scene, const alpi_pack_rules *rules)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_AUTO; // new charts: a kept set could not have these gaps
    options.size = rules->size;
    options.padding = rules->padding;
    options.block = rules->block;
    options.mips = rules->mips;
    options.texels_per_metre = rules->mips > 2 ? 40.0 : 0.0;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    const size_t room = (size_t)rules->size * rules->size;
    uint16_t *page = malloc(room * sizeof *page);
    assert_non_null(page);
    for (uint32_t p = 0; p < atlas->info.pages; p++) {
        memset(page, 0xff, room * sizeof *page);
        for (uint32_t i = texels.page_first[p]; i < texels.page_first[p + 1]; i++) {
            page[texels.pixels[i][1] * rules->size + texels.pixels[i][0]] =
                (uint16_t)texels.charts[i];
        }
        check_page(page, rules);
    }
    free(page);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
}

TEST_WITH_CONTEXT(gaps_hold_on_whole_pages, 1)
{
    static const alpi_pack_rules rules[] = {{.size = 128, .padding = 0, .block = 1},
                                            {.size = 100, .padding = 2, .block = 5},
                                            {.size = 128, .padding = 1, .block = 4, .mips = 1},
                                            {.size = 256, .padding = 2, .block = 1, .mips = 3}};
    alp_scene *scenes[] = {scene_sphere(context, 16, 32), scene_confetti(context, 200)};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        check_gaps(context, scenes[0], &rules[i]);
        check_gaps(context, scenes[1], &rules[i]);
    }
    alp_scene_destroy(scenes[0]);
    alp_scene_destroy(scenes[1]);
}

TEST_WITH_CONTEXT(bad_gaps_are_refused, 1)
{
    alp_scene *scene = scene_cube(context);
    const alp_atlas_options good = alp_atlas_options_default();
    alp_atlas_options bad[] = {good, good, good, good, good, good, good};
    bad[0].block = 0;
    bad[1].block = 65;
    bad[2].mips = 9;
    bad[3].size = 100; // no multiple of 8
    bad[3].mips = 3;
    bad[4].mode = bad[5].mode = bad[6].mode = ALP_ATLAS_KEEP;
    bad[4].block = 4;
    bad[5].mips = 1;
    bad[6].densities = "*=2";
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        alp_atlas *atlas = NULL;
        assert_int_equal(alp_atlas_create(scene, &bad[i], &atlas), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(atlas);
    }
    alp_scene_destroy(scene);
}
