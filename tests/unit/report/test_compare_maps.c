// SPDX-License-Identifier: MIT
// Maps of two assets, compared on their surface: the figures are those of pictures that are painted
// over the baked ones, for which they are known.
#include "test_obj.h"

#include "atlas/atlas.h"
#include "formats/formats.h"
#include "maps/lightmap.h"
#include "report/same_triangles.h"
#include "scene/area_points.h"
#include "scene/blend_weights.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 64 };

/// A scene baked to a .gltf, whose pictures lie beside it.
typedef struct baked {
    alp_scene *source;
    alp_lightmap *lightmap;
    char path[600];
    const char *map_ending; // of the picture of its map
    bool lit;
} baked;

static const alp_lightmap_as EXTRAS = ALP_LIGHTMAP_AS_EXTRAS;

/// @param as NONE: occlusion; else light in that form
static baked bake(alp_context *context, alp_atlas_mode mode, alp_lightmap_as as, const char *name)
{
    baked b = {.lit = as != ALP_LIGHTMAP_AS_NONE};
    alp_bake_options options = alp_bake_options_default();
    b.map_ending = as == EXTRAS ? ".light.exr" : b.lit ? ".light.png" : ".ao.png";
    snprintf(b.path, sizeof b.path, "%s/%s.gltf", test_folder(), name);
    options.atlas.mode = mode;
    options.atlas.size = SIZE;
    options.occlusion.samples = 8;
    options.output = b.path;
    if (b.lit) {
        options.maps = ALP_MAP_LIGHT;
        options.lightmap_as = as;
        options.lightmap_format = as == EXTRAS ? ALP_LIGHTMAP_EXR : options.lightmap_format;
        options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
        options.light.samples = 4;
        options.light.bounces = 0;
    }
    ASSERT_OK(context, alp_scene_load(context, "builtin:sphere-plane", &b.source));
    ASSERT_OK(context, alp_bake(b.source, &options, &b.lightmap, NULL));
    assert_int_equal(b.lightmap->page_count, 1);
    return b;
}

static void release(baked *b)
{
    alp_lightmap_destroy(b->lightmap);
    alp_scene_destroy(b->source);
}

/// Puts another picture in the place of the map: values [SIZE][SIZE] in [0, 1], grey.
static void paint(alp_context *context, const baked *b, const float *values, bool srgb)
{
    char path[700];
    snprintf(path, sizeof path, "%.*s%s", (int)(strlen(b->path) - strlen(".gltf")), b->path,
             b->map_ending);
    const bool floats = strstr(path, ".exr") != NULL;
    alp_image *image = NULL;
    const alp_image_info info = {SIZE, SIZE, 3, floats ? ALP_COMPONENT_FLOAT : ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        const float value = values[i / 3];
        if (floats) {
            alp_image_floats(image)[i] = value;
        } else {
            alp_image_bytes(image)[i] =
                (uint8_t)((srgb ? alpi_linear_to_srgb(value) : value) * 255.0f + 0.5f);
        }
    }
    ASSERT_OK(context, alp_image_save(image, path, true));
    alp_image_destroy(image);
}

static void paint_constant(alp_context *context, const baked *b, float value)
{
    static float values[SIZE * SIZE];
    for (int i = 0; i < SIZE * SIZE; i++) {
        values[i] = value;
    }
    paint(context, b, values, false);
}

static alp_map_difference compare(alp_context *context, const char *first, const char *second,
                                  const alp_map_compare_options *options)
{
    alp_scene *a = NULL, *b = NULL;
    alp_map_difference d;
    ASSERT_OK(context, alp_scene_load(context, first, &a));
    ASSERT_OK(context, alp_scene_load(context, second, &b));
    ASSERT_OK(context, alp_scene_compare_maps(a, b, options, &d));
    alp_scene_destroy(a);
    alp_scene_destroy(b);
    return d;
}

static alp_map_compare_options few_points(void)
{
    alp_map_compare_options options = alp_map_compare_options_default();
    options.points = 5000; // no multiple of a row
    return options;
}

TEST_WITH_CONTEXT(nothing_differs_from_itself, 2)
{
    static const alp_lightmap_as forms[] = {ALP_LIGHTMAP_AS_NONE, ALP_LIGHTMAP_AS_EMISSIVE,
                                            ALP_LIGHTMAP_AS_MOZ, ALP_LIGHTMAP_AS_EXTRAS};
    const alp_map_compare_options options = few_points();
    for (int i = 0; i < 4; i++) {
        baked b = bake(context, ALP_ATLAS_BLEND, forms[i], "self");
        const alp_map_difference d = compare(context, b.path, b.path, &options);
        assert_int_equal(d.map, b.lit ? ALP_MAP_LIGHT : ALP_MAP_AO);
        assert_true(d.blended_first && d.blended_second);
        assert_int_equal(d.points, 5000);
        assert_int_equal(d.only_first + d.only_second, 0);
        assert_true(d.rmse == 0.0 && d.bias == 0.0 && d.maximum == 0.0 && d.p99 == 0.0);
        assert_true(d.mean_first > 0.0);
        release(&b);
    }
}

/// Nor from the same with other first corners: they are found again by where they are.
TEST_WITH_CONTEXT(first_corners_do_not_matter, 2)
{
    baked b = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "turned");
    alp_scene *a = NULL, *turned = NULL;
    ASSERT_OK(context, alp_scene_load(context, b.path, &a));
    ASSERT_OK(context, alp_scene_load(context, b.path, &turned));
    for (uint32_t t = 0; t < turned->triangle_count; t++) {
        uint32_t *c = turned->triangles[t];
        const uint32_t old[3] = {c[0], c[1], c[2]};
        for (uint32_t k = 0; k < 3; k++) {
            c[k] = old[(k + 1 + t % 2) % 3];
        }
    }
    const alp_map_compare_options options = few_points();
    alp_map_difference d;
    ASSERT_OK(context, alp_scene_compare_maps(a, turned, &options, &d));
    ASSERT_NEAR(d.maximum, 0.0, 1e-4); // rounding of coordinates, 64 times as much in texels
    alp_scene_destroy(turned);
    alp_scene_destroy(a);
    release(&b);
}

/// A constant is what it is however it is blended: the weights sum to 1.
TEST_WITH_CONTEXT(a_constant_map_is_exact, 2)
{
    baked blend = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "blend");
    baked charts = bake(context, ALP_ATLAS_CHARTS, ALP_LIGHTMAP_AS_NONE, "charts");
    paint_constant(context, &blend, 153.0f / 255.0f);
    paint_constant(context, &charts, 51.0f / 255.0f);
    alp_map_compare_options options = few_points();
    alp_map_difference d = compare(context, blend.path, charts.path, &options);
    assert_true(d.blended_first && !d.blended_second);
    const double rounding = 1e-6; // of weights, and of three products
    ASSERT_NEAR(d.bias, 0.4, rounding);
    ASSERT_NEAR(d.rmse, 0.4, rounding);
    ASSERT_NEAR(d.maximum, 0.4, rounding);
    ASSERT_NEAR(d.p99, 0.4, rounding);
    ASSERT_NEAR(d.mean_first, 0.6, rounding);
    ASSERT_NEAR(d.mean_second, 0.2, rounding);
    options.scale = 0.5;
    d = compare(context, blend.path, charts.path, &options);
    ASSERT_NEAR(d.rmse, 0.1, rounding);
    release(&charts);
    release(&blend);
}

/// A ramp across the page, which bilinear look-ups give at any place between the middles of its
/// first and last texels.
static double ramp_at(float u)
{
    return fmin(fmax(((double)u * SIZE - 0.5) / (SIZE - 1), 0.0), 1.0);
}

/// What a blended look-up of the ramp gives, from the atlas that was written.
static double blended_ramp(const baked *b, const alpi_area_point *p)
{
    float weights[3];
    double sum = 0.0;
    alpi_surface_weights(b->source, false, p->triangle, p->b1, p->b2, weights);
    for (int k = 0; k < 3; k++) {
        const float(*uv)[2] = (const float(*)[2])b->lightmap->atlas->set_uvs[p->triangle][k];
        const float u = uv[0][0] + p->b1 * (uv[1][0] - uv[0][0]) + p->b2 * (uv[2][0] - uv[0][0]);
        sum += (double)weights[k] * ramp_at(u);
    }
    return sum;
}

/// What the texels of a surface are multiplied by: of each material, as the file says it.
static double scale_of(const alp_scene *written, const alpi_light_maps *maps, uint32_t surface)
{
    const uint32_t material = written->surfaces[surface].material;
    return maps->maps[material].texture.image != ALPI_NONE ? (double)maps->maps[material].scale
           : written->materials[material].emission[0] > 0.0f
               ? (double)written->materials[material].emission[0]
               : 1.0;
}

/// The mean and the root of the mean square of the ramp, blended, over the points of a comparison.
static void expect_ramp(const baked *b, double *mean, double *root, double *scale)
{
    static alpi_area_point points[5000];
    alp_scene *written = NULL;
    alpi_light_maps maps;
    ASSERT_OK(b->source->context, alp_scene_load(b->source->context, b->path, &written));
    ASSERT_OK(b->source->context, alpi_gltf_read_light_maps(written, &maps));
    assert_true(alpi_area_points(b->source, 5000, points));
    double sum = 0.0, squares = 0.0;
    *scale = 0.0;
    for (int p = 0; p < 5000; p++) {
        const uint32_t surface = written->triangle_surface[points[p].triangle];
        const double s = scale_of(written, &maps, surface);
        const double value = s * blended_ramp(b, &points[p]);
        sum += value / 5000;
        squares += value * value / 5000;
        *scale = fmax(*scale, s);
    }
    *mean = sum;
    *root = sqrt(squares);
    alpi_light_maps_release(written->context, &maps);
    alp_scene_destroy(written);
}

/// Each form of map is read in its three sets with their weights: the mean and the mean square of a
/// ramp are those of the atlas.
TEST_SLOW_WITH_CONTEXT(each_form_is_blended, 2)
{
    static const alp_lightmap_as forms[] = {ALP_LIGHTMAP_AS_NONE, ALP_LIGHTMAP_AS_EMISSIVE,
                                            ALP_LIGHTMAP_AS_MOZ, ALP_LIGHTMAP_AS_EXTRAS};
    static float ramp[SIZE * SIZE];
    for (int i = 0; i < SIZE * SIZE; i++) {
        ramp[i] = (float)(i % SIZE) / (SIZE - 1);
    }
    for (int i = 0; i < 4; i++) {
        baked b = bake(context, ALP_ATLAS_BLEND, forms[i], "ramp");
        baked black = bake(context, ALP_ATLAS_BLEND, forms[i], "black");
        paint(context, &b, ramp, forms[i] == ALP_LIGHTMAP_AS_EMISSIVE);
        paint_constant(context, &black, 0.0f);
        const alp_map_compare_options options = few_points();
        const alp_map_difference d = compare(context, b.path, black.path, &options);
        double mean, root, scale;
        expect_ramp(&b, &mean, &root, &scale);
        // Half a step of eight bits, of sRGB at its steepest 2.4 times that; floats.
        const double step = forms[i] == ALP_LIGHTMAP_AS_EXTRAS     ? 0.0
                            : forms[i] == ALP_LIGHTMAP_AS_EMISSIVE ? 1.2 / 255.0
                                                                   : 0.5 / 255.0;
        ASSERT_NEAR(d.mean_first, mean, scale * (step + 1e-5));
        ASSERT_NEAR(d.rmse, root, scale * (step + 1e-5));
        release(&black);
        release(&b);
    }
}

static vec3 texel_position(const alp_lightmap *l, uint32_t texel)
{
    vec3 c[3];
    const float b1 = l->texels.barycentrics[texel][0], b2 = l->texels.barycentrics[texel][1];
    alpi_triangle_corners(l->scene, l->texels.triangles[texel], c);
    return vec3_mad(vec3_mad(vec3_scale(c[0], 1.0f - b1 - b2), b1, c[1]), b2, c[2]);
}

/// Light that grows evenly along x, 0 to 1 over the scene. @return its slope, per metre
static double paint_slope(alp_context *context, const baked *b)
{
    static float page[4 * SIZE * SIZE], values[SIZE * SIZE];
    const alp_scene *scene = b->source;
    const float across = scene->bounds_max.x - scene->bounds_min.x;
    memset(page, 0, sizeof page);
    for (uint32_t i = 0; i < b->lightmap->texels.count; i++) {
        const uint16_t *at = b->lightmap->texels.pixels[i];
        float *pixel = page + 4 * ((size_t)at[1] * SIZE + at[0]);
        pixel[0] = (texel_position(b->lightmap, i).x - scene->bounds_min.x) / across;
        pixel[3] = 1.0f;
    }
    ASSERT_OK(context, alpi_dilate(context, page, SIZE, SIZE));
    for (int i = 0; i < SIZE * SIZE; i++) {
        values[i] = page[4 * i];
    }
    paint(context, b, values, false);
    return 1.0 / (double)across;
}

/// What a look-up reads lies within a texel of its place in x and in y, and stands for a place half
/// a texel from its middle at most, or, beside a chart, for one that is a texel further: 2½ texels
/// each way. A blend is a mean of such look-ups; a texel of the chart of axis k is 1 / |n_k| as
/// long as it is wide, and counts n_k².
TEST_WITH_CONTEXT(smooth_light_is_the_same_in_charts, 2)
{
    baked blend = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "blend");
    baked charts = bake(context, ALP_ATLAS_CHARTS, ALP_LIGHTMAP_AS_NONE, "charts");
    paint_slope(context, &blend);
    const double slope = paint_slope(context, &charts);
    const alp_atlas_info of_blend = alp_atlas_get_info(blend.lightmap->atlas);
    const alp_atlas_info of_charts = alp_atlas_get_info(charts.lightmap->atlas);
    const double reach = 2.5 * sqrt(2.0);
    const double bound = slope * reach *
                             (of_charts.stretch_worst / of_charts.texels_per_metre +
                              sqrt(3.0) / of_blend.texels_per_metre) +
                         1.0 / 255.0;
    assert_true(bound < 0.5); // it says something
    const alp_map_compare_options options = few_points();
    const alp_map_difference d = compare(context, blend.path, charts.path, &options);
    assert_true(d.maximum <= bound && d.maximum > 0.0);
    // Errors of all signs: their mean is that of eight bits and of what lies beside charts.
    assert_true(fabs(d.bias) <= bound / 10.0);
    release(&charts);
    release(&blend);
}

/// A tool that drops attributes of our own leaves one set, which is a map too.
TEST_WITH_CONTEXT(without_all_sets_the_first_is_read, 2)
{
    baked b = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "whole");
    const alp_map_compare_options options = few_points();
    size_t size;
    char *text = (char *)test_read_file(b.path, &size), *name = text;
    while ((name = strstr(name, "\"TEXCOORD_2\":")) != NULL) {
        memcpy(name, "\"_DROPPED_2\"", strlen("\"_DROPPED_2\""));
    }
    char path[600];
    snprintf(path, sizeof path, "%.*spart.gltf", (int)(strlen(b.path) - strlen("whole.gltf")),
             b.path);
    test_write_file(path, text, size);
    const alp_map_difference d = compare(context, path, b.path, &options);
    assert_true(!d.blended_first && d.blended_second && d.points == 5000 && d.maximum > 0.0);
    free(text);
    release(&b);
}

/// Where the largest difference is: on the one texel that differs.
TEST_WITH_CONTEXT(the_largest_is_found, 2)
{
    static float values[SIZE * SIZE];
    baked a = bake(context, ALP_ATLAS_CHARTS, ALP_LIGHTMAP_AS_NONE, "one");
    baked b = bake(context, ALP_ATLAS_CHARTS, ALP_LIGHTMAP_AS_NONE, "other");
    const alpi_texels *texels = &a.lightmap->texels;
    uint32_t texel = texels->count - 1; // a whole one of the sphere
    while (a.source->triangle_surface[texels->triangles[texel]] == 0 ||
           texels->coverages[texel] < 0.99f) {
        texel--;
    }
    const vec3 place = texel_position(a.lightmap, texel);
    const uint16_t *at = a.lightmap->texels.pixels[texel];
    paint(context, &a, values, false);
    values[at[1] * SIZE + at[0]] = 1.0f;
    paint(context, &b, values, false);
    // By default as many points that some hundred lie on a texel.
    const alp_map_difference d = compare(context, a.path, b.path, NULL);
    const uint32_t triangle = a.lightmap->texels.triangles[texel];
    assert_int_equal(d.maximum_surface, a.source->triangle_surface[triangle]);
    assert_true(d.maximum > 0.5 && d.bias < 0.0);
    // Within the texel and half of the next one, of a chart of L2 stretch 2 at most.
    const float *found = d.maximum_position;
    const double texel_size = 1.0 / alp_atlas_get_info(a.lightmap->atlas).texels_per_metre;
    ASSERT_NEAR(vec3_length(vec3_sub(vec3_load(found), place)), 0.0, 2.0 * 2.0 * texel_size);
    release(&b);
    release(&a);
}

/// Charts over several pages: primitives are cut into parts, and triangles stand in another order.
TEST_WITH_CONTEXT(pages_do_not_matter, 2)
{
    char path[600];
    snprintf(path, sizeof path, "%s/pages.gltf", test_folder());
    baked one = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "one");
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_BLEND;
    options.atlas.size = SIZE;
    options.atlas.texels_per_metre = 15.0;
    options.occlusion.samples = 8;
    options.output = path;
    ASSERT_OK(context, alp_bake(one.source, &options, NULL, NULL));
    alp_scene *written = test_load(context, path);
    alpi_same_triangles same;
    ASSERT_OK(context, alpi_same_triangles_find(one.source, written, &same));
    uint32_t moved = 0;
    for (uint32_t t = 0; t < written->triangle_count; t++) {
        moved += one.source->triangle_usable[t] && same.numbers[t] != t;
    }
    assert_true(moved > 0);
    const alp_map_compare_options few = few_points();
    const alp_map_difference d = compare(context, one.path, path, &few);
    assert_int_equal(d.points, 5000);
    // Accessibility of eight rays each: standard errors of at most 1 / (2 sqrt(8)) in both.
    assert_true(d.blended_second && d.rmse < 0.25);
    alpi_same_triangles_release(context, &same);
    alp_scene_destroy(written);
    release(&one);
}

static void require_fault(alp_context *context, const char *first, const char *second,
                          const alp_map_compare_options *options, alp_result code,
                          const char *words)
{
    alp_scene *a = NULL, *b = NULL;
    alp_map_difference d;
    ASSERT_OK(context, alp_scene_load(context, first, &a));
    ASSERT_OK(context, alp_scene_load(context, second, &b));
    assert_int_equal(alp_scene_compare_maps(a, b, options, &d), code);
    if (strstr(alp_context_message(context), words) == NULL) {
        fail_msg("\"%s\" is not in: %s", words, alp_context_message(context));
    }
    alp_scene_destroy(a);
    alp_scene_destroy(b);
}

TEST_WITH_CONTEXT(faults_are_named, 2)
{
    const char *plain = "builtin:sphere-plane";
    baked ao = bake(context, ALP_ATLAS_BLEND, ALP_LIGHTMAP_AS_NONE, "ao");
    baked light = bake(context, ALP_ATLAS_BLEND, EXTRAS, "light");
    alp_map_compare_options options = few_points();
    const alp_result data = ALP_ERROR_INVALID_DATA, argument = ALP_ERROR_INVALID_ARGUMENT;
    require_fault(context, "builtin:cornell", ao.path, &options, data, "triangles with area");
    require_fault(context, ao.path, plain, &options, data,
                  "builtin:sphere-plane has neither an occlusion map nor one of light");
    require_fault(context, ao.path, light.path, &options, data, "a map of occlusion alone");
    options.map = ALP_MAP_LIGHT;
    require_fault(context, light.path, ao.path, &options, data, "ao.gltf has no map of light");
    options.map = ALP_MAP_AO;
    require_fault(context, light.path, ao.path, &options, data, "light.gltf has no occlusion map");
    options.map = ALP_MAP_BENT;
    require_fault(context, ao.path, ao.path, &options, argument, "neither occlusion nor light");
    options = few_points();
    options.points = 0;
    require_fault(context, ao.path, ao.path, &options, argument, "0 points");
    options = few_points();
    options.struct_size = 1;
    require_fault(context, ao.path, ao.path, &options, argument, "_default()");
    options = few_points();
    paint_constant(context, &light, NAN);
    require_fault(context, light.path, light.path, &options, data, "a value that is not finite");
    release(&light);
    release(&ao);
}

TEST(every_allocation_may_fail)
{
    int left = 1 << 20, failures = 0;
    alp_context *context = test_context_failing(&left);
    baked b = bake(context, ALP_ATLAS_BLEND, EXTRAS, "failing");
    alp_scene *first = NULL, *second = NULL;
    ASSERT_OK(context, alp_scene_load(context, b.path, &first));
    ASSERT_OK(context, alp_scene_load(context, b.path, &second));
    for (uint32_t t = 0; t < second->triangle_count; t++) { // so that they are sorted too
        const uint32_t *c = second->triangles[t], turned[3] = {c[1], c[2], c[0]};
        memcpy(second->triangles[t], turned, sizeof turned);
    }
    const alp_map_compare_options options = few_points();
    for (int room = 0; room < 1000; room++, failures++) {
        alp_map_difference d;
        left = room;
        const alp_result result = alp_scene_compare_maps(first, second, &options, &d);
        left = 1 << 20;
        if (result == ALP_OK) {
            break;
        }
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
    }
    assert_in_range(failures, 10, 999);
    alp_scene_destroy(first);
    alp_scene_destroy(second);
    release(&b);
    alp_context_destroy(context);
}
