// SPDX-License-Identifier: MIT
// Assets with overlapping charts: the three sets that were made come back from the file, where no
// set is free as attributes of their own, and what has no place for them is refused.
#include "quad_asset.h"
#include "test_obj.h"

#include "atlas/atlas.h"
#include "maps/lightmap.h"

#include <stdio.h>
#include <stdlib.h>

static alp_bake_options blend_options(const char *output)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_BLEND;
    options.atlas.size = 64;
    options.occlusion.samples = 8;
    options.output = output;
    return options;
}

static alp_lightmap *bake(const alp_scene *scene, const char *output)
{
    const alp_bake_options options = blend_options(output);
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alp_bake(scene, &options, &lightmap, NULL));
    return lightmap;
}

/// Sets first, first + 1 … of a written scene hold those of the map, to `tolerance`.
static void check_sets(const alp_scene *written, const alp_lightmap *lightmap, uint32_t first,
                       int count, double tolerance)
{
    assert_int_equal(written->triangle_count, lightmap->scene->triangle_count);
    for (uint32_t t = 0; t < written->triangle_count; t++) {
        for (int i = 0; i < 6 * count; i++) {
            const int k = i / 6, corner = i % 6 / 2, axis = i % 2;
            assert_non_null(written->uvs[first + (uint32_t)k]);
            const uint32_t v = written->triangles[t][corner];
            ASSERT_NEAR(written->uvs[first + (uint32_t)k][v][axis],
                        lightmap->atlas->set_uvs[t][k][corner][axis], tolerance);
        }
    }
}

/// What a written scene reads of its own map is what the map gave, to half a step of eight bits.
static void check_blend(const alp_scene *written, const alp_lightmap *lightmap)
{
    for (uint32_t t = 0; t < written->triangle_count; t++) {
        float value = -1.0f, rgb[3];
        assert_true(alpi_surface_occlusion(written, t, 0.3f, 0.5f, &value));
        alpi_lightmap_sample(lightmap, t, 0.3f, 0.5f, rgb);
        ASSERT_NEAR(value, rgb[0], 0.5 / 255.0 + 1e-5); // and rounding
    }
}

static bool file_has(const char *path, const char *words)
{
    size_t size;
    unsigned char *bytes = test_read_file(path, &size);
    const size_t length = strlen(words);
    bool found = false;
    for (size_t i = 0; i + length <= size && !found; i++) {
        found = memcmp(bytes + i, words, length) == 0;
    }
    free(bytes);
    return found;
}

TEST_WITH_CONTEXT(three_sets_come_back, 2)
{
    const char *folder = quad_folder();
    const char *once = test_path(folder, "once.glb"), *twice = test_path(folder, "twice.glb");
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_lightmap *lightmap = bake(scene, once);
    alp_scene *written = test_load(context, once);
    assert_int_equal(alp_scene_get_surface(written, 0).uv_sets, 3);
    check_sets(written, lightmap, 0, 3, 0.0);
    assert_true(file_has(once, "\"alpenglow_blend\":{\"sets\":[\"TEXCOORD_0\",\"TEXCOORD_1\","
                               "\"TEXCOORD_2\"],\"weights\":\"n*n\",\"frame\":\"object\","
                               "\"maps\":[\"occlusionTexture\"]}"));
    check_blend(written, lightmap);
    alp_lightmap_destroy(lightmap);
    // Once more: they take the place of those before.
    const char *again = test_path(test_folder(), "again.glb");
    lightmap = bake(written, again);
    alp_scene *last = test_load(context, again);
    assert_int_equal(alp_scene_get_surface(last, 0).uv_sets, 3);
    check_sets(last, lightmap, 0, 3, 0.0);
    check_blend(last, lightmap);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(last);
    // Of a file that does not say what is ours all stays, and one set is free still.
    quad_unmark(once);
    alp_scene_destroy(written);
    written = test_load(context, once);
    lightmap = bake(written, twice);
    last = test_load(context, twice);
    check_sets(last, lightmap, 3, 3, 0.0); // two of them behind the sets
    assert_int_equal(alp_scene_get_surface(last, 0).uv_sets, 4);
    check_blend(last, lightmap);
    assert_true(
        file_has(twice, "\"sets\":[\"TEXCOORD_3\",\"_ALPENGLOW_UV_1\",\"_ALPENGLOW_UV_2\"]"));
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(last);
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
    quad_list(once, twice);
}

/// Occlusion that comes to be read with one set is not blended any more, and the light that still
/// is stays; nothing keeps the sets of a blend, and the doctor does not complain of them.
TEST_WITH_CONTEXT(a_map_of_one_set_ends_the_blend, 2)
{
    const char *folder = quad_folder();
    const char *once = test_path(folder, "once.glb"), *twice = test_path(folder, "twice.glb");
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = blend_options(once);
    options.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
    options.lightmap_as = ALP_LIGHTMAP_AS_MOZ;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.samples = 4;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    alp_scene *written = test_load(context, once);
    alp_diagnosis *diagnosis = NULL;
    ASSERT_OK(context, alp_scene_diagnose(written, NULL, &diagnosis));
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(diagnosis); i++) {
        const alp_finding finding = alp_diagnosis_get_finding(diagnosis, i);
        assert_int_not_equal(finding.place, ALP_PLACE_UV_SET);
    }
    assert_false(alp_diagnosis_get_uv_set(diagnosis, 1).holds_bake);
    alp_diagnosis_destroy(diagnosis);
    options = blend_options(twice);
    options.atlas.mode = ALP_ATLAS_AUTO;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(written, &options, &lightmap, NULL));
    assert_int_equal(alp_atlas_get_info(lightmap->atlas).mode, ALP_ATLAS_CHARTS);
    assert_true(file_has(twice, "\"frame\":\"object\",\"maps\":[\"MOZ_lightmap\"]}"));
    alp_scene *last = test_load(context, twice);
    check_blend(last, lightmap);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(last);
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
    quad_list(once, twice);
}

/// Light on top of the occlusion of `from`, which stays, by the one atlas or the other.
static void bake_light(const alp_scene *from, alp_atlas_mode mode, const char *output)
{
    alp_bake_options options = blend_options(output);
    options.existing_ao = ALP_EXISTING_AO_KEEP;
    options.atlas.mode = mode;
    options.overwrite = true;
    options.maps = ALP_MAP_LIGHT;
    options.lightmap_as = ALP_LIGHTMAP_AS_MOZ;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.samples = 4;
    ASSERT_OK(from->context, alp_bake(from, &options, NULL, NULL));
}

/// A material says for each map with which sets it is read: what one bake gave stays blended when
/// another adds its own, and a third that puts another map in its place takes it from the list.
TEST_WITH_CONTEXT(light_after_occlusion_keeps_both, 2)
{
    const char *folder = quad_folder();
    const char *once = test_path(folder, "once.glb"), *twice = test_path(folder, "twice.glb");
    const char *thrice = test_path(test_folder(), "thrice.glb");
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_lightmap *lightmap = bake(scene, once);
    alp_scene *written = test_load(context, once);
    bake_light(written, ALP_ATLAS_BLEND, twice);
    assert_true(file_has(twice,
                         "\"sets\":[\"TEXCOORD_3\",\"_ALPENGLOW_UV_1\",\"_ALPENGLOW_UV_2\"],"
                         "\"weights\":\"n*n\",\"frame\":\"object\","
                         "\"maps\":[\"MOZ_lightmap\"],\"earlier\":[{\"sets\":[\"TEXCOORD_0\","
                         "\"TEXCOORD_1\",\"TEXCOORD_2\"],\"maps\":[\"occlusionTexture\"]}]}"));
    alp_scene *both = test_load(context, twice);
    assert_true(both->materials[0].occlusion_texture.blended);
    check_blend(both, lightmap); // corners are where they were: their numbers differ alone
    bake_light(both, ALP_ATLAS_BLEND, thrice);
    assert_true(file_has(thrice,
                         "\"sets\":[\"TEXCOORD_3\",\"_ALPENGLOW_UV_1\",\"_ALPENGLOW_UV_2\"],"
                         "\"weights\":\"n*n\",\"frame\":\"object\","
                         "\"maps\":[\"MOZ_lightmap\"],\"earlier\":[{\"sets\":["
                         "\"TEXCOORD_0\",\"TEXCOORD_1\",\"TEXCOORD_2\"],"
                         "\"maps\":[\"occlusionTexture\"]}]}"));
    bake_light(both, ALP_ATLAS_CHARTS, thrice); // of one set: none is left to the second bake
    assert_true(file_has(thrice,
                         "\"maps\":[],\"earlier\":[{\"sets\":[\"TEXCOORD_0\","
                         "\"TEXCOORD_1\",\"TEXCOORD_2\"],\"maps\":[\"occlusionTexture\"]}]}"));
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(both);
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
    quad_list(once, twice);
}

/// Light that takes the occlusion away takes its sets from the list too.
TEST_WITH_CONTEXT(light_in_place_of_occlusion, 2)
{
    const char *once = test_path(test_folder(), "once.glb");
    const char *twice = test_path(test_folder(), "twice.glb");
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_lightmap_destroy(bake(scene, once));
    alp_scene *written = test_load(context, once);
    alp_bake_options options = blend_options(twice);
    options.maps = ALP_MAP_LIGHT;
    options.lightmap_as = ALP_LIGHTMAP_AS_MOZ;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.samples = 4;
    ASSERT_OK(context, alp_bake(written, &options, NULL, NULL));
    assert_true(file_has(twice, "\"maps\":[\"MOZ_lightmap\"]}"));
    assert_false(file_has(twice, "occlusionTexture"));
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
}

/// Extras that speak of another map than the one that is there: an editor kept them, and put in an
/// occlusionTexture of its own.
TEST_WITH_CONTEXT(a_blend_of_other_sets_is_not_read, 2)
{
    const char *output = test_path(test_folder(), "once.gltf");
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_lightmap *lightmap = bake(scene, output);
    size_t size;
    char *text = (char *)test_read_file(output, &size);
    char *sets = strstr(text, "\"sets\":[\"TEXCOORD_0\"");
    assert_non_null(sets);
    sets[strlen("\"sets\":[\"TEXCOORD_")] = '3';
    test_write_file(output, text, size);
    alp_scene *written = test_load(context, output);
    assert_true(written->materials[0].occlusion_texture.image != ALPI_NONE);
    assert_false(written->materials[0].occlusion_texture.blended);
    free(text);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(collada_has_three_sets, 2)
{
    const char *path = test_shared("scenes/collada/sphere.dae");
    if (path == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, path);
    const char *output = test_path(test_folder(), "sphere.dae");
    const uint32_t first = alp_scene_get_surface(scene, 0).uv_sets;
    alp_lightmap *lightmap = bake(scene, output);
    alp_scene *written = test_load(context, output);
    assert_int_equal(alp_scene_get_surface(written, 0).uv_sets, first + 3);
    check_sets(written, lightmap, first, 3, 1e-6); // v is turned over: rounding
    for (uint32_t set = 0; set < first + 3; set++) {
        assert_int_equal(alpi_scene_set_is_blended(written, set), set >= first);
    }
    assert_true(file_has(output, "ALPENGLOW_2"));
    check_blend(written, lightmap);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(written);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(what_has_one_set_is_refused, 1)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = blend_options(test_path(test_folder(), "a.obj"));
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_UNSUPPORTED);
    assert_non_null(strstr(alp_context_message(context), "three coordinate sets"));
    options.output = test_path(test_folder(), "a.json");
    options.maps = ALP_MAP_LIGHT;
    options.lightmap_as = ALP_LIGHTMAP_AS_THREE;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_UNSUPPORTED);
    assert_non_null(strstr(alp_context_message(context), "--atlas blend has three"));
    alp_scene_destroy(scene);
}

/// Sums over the surface count each place once, however many charts it is in.
TEST_WITH_CONTEXT(light_and_occlusion_keep_their_sums, 2)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_report reports[2];
    for (int i = 0; i < 2; i++) {
        alp_bake_options options = blend_options(NULL);
        options.atlas.mode = i == 0 ? ALP_ATLAS_CHARTS : ALP_ATLAS_BLEND;
        options.occlusion.samples = 64;
        options.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
        options.light.samples = 64;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &reports[i]));
    }
    const alp_light_energy *charts = &reports[0].light_energy, *blend = &reports[1].light_energy;
    assert_true(charts->known && blend->known);
    // The lamp is flat: all of it in one chart, but for the areas of texels at its rim, in floats.
    ASSERT_NEAR(blend->emitted, charts->emitted, 1e-4 * charts->emitted);
    // What is lost or found is of rays and of texels that see in part: .004 ± .010 of it over 12
    // seeds at 64² and 64 rays. Counting each place once for each of its charts would be threefold.
    ASSERT_NEAR(blend->absorbed + blend->escaped + blend->behind + blend->unshot, blend->emitted,
                0.045 * blend->emitted);
    ASSERT_NEAR(reports[1].ao_mean, reports[0].ao_mean, 0.01);
    alp_scene_destroy(scene);
}
