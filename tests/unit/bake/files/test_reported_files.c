// SPDX-License-Identifier: MIT
// Files of public bug reports that a bake writes, each with what is right for it. They are in the
// shared folder; without it the cases are skipped.
#include "formats/formats.h"
#include "formats/gltf/gltf_document.h"
#include "test_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST_CONTEXT(2);

/// A file of the folder reports, baked and read again.
typedef struct reported {
    alp_scene *scene;
    alp_bake_report report;
    alpi_gltf_document *written;
    json_t *root;
} reported;

static const char *report_path(const char *name)
{
    char relative[128];
    (void)snprintf(relative, sizeof relative, "scenes/reports/%s", name);
    const char *path = test_shared(relative);
    if (path == NULL) {
        skip();
    }
    return path;
}

static reported bake_report(const char *name, const char *only)
{
    reported r = {.scene = test_load(context, report_path(name))};
    alp_bake_options o = alp_bake_options_default();
    const char *path = test_path(test_folder(), "baked.glb");
    o.atlas.size = 64;
    o.occlusion.distance = INFINITY;
    o.only = only;
    o.output = path;
    o.overwrite = true;
    ASSERT_OK(context, alp_bake(r.scene, &o, NULL, &r.report));
    ASSERT_OK(context, alpi_gltf_document_read(context, path, &r.written));
    r.root = r.written->root;
    return r;
}

static void close_report(reported *r)
{
    alpi_gltf_document_destroy(r->written);
    alp_scene_destroy(r->scene);
}

static json_t *item(const reported *r, const char *kind, size_t i)
{
    return json_array_get(json_object_get(r->root, kind), i);
}

static json_t *first_primitive(const reported *r, size_t mesh)
{
    return json_array_get(json_object_get(item(r, "meshes", mesh), "primitives"), 0);
}

static size_t material_of(json_t *object)
{
    return (size_t)json_integer_value(json_object_get(object, "material"));
}

static bool has_map(const reported *r, size_t material)
{
    return json_object_get(item(r, "materials", material), "occlusionTexture") != NULL;
}

TEST(variants_have_the_map)
{
    reported r = bake_report("variants.glb", NULL);
    json_t *extensions = json_object_get(first_primitive(&r, 1), "extensions");
    json_t *variants = json_object_get(extensions, "KHR_materials_variants");
    json_t *mappings = json_object_get(variants, "mappings");
    assert_int_equal(json_array_size(mappings), 2);
    assert_int_not_equal(material_of(json_array_get(mappings, 0)),
                         material_of(json_array_get(mappings, 1)));
    for (size_t i = 0; i < 2; i++) {
        assert_true(has_map(&r, material_of(json_array_get(mappings, i))));
    }
    close_report(&r);
}

TEST(a_copied_material_is_animated)
{
    reported r = bake_report("animated_material.glb", "Floor");
    const size_t copy = material_of(first_primitive(&r, 0));
    assert_int_not_equal(copy, material_of(first_primitive(&r, 1)));
    assert_true(has_map(&r, copy));
    json_t *channels = json_object_get(item(&r, "animations", 0), "channels");
    bool moved[2] = {false, false};
    for (size_t i = 0; i < json_array_size(channels); i++) {
        json_t *target = json_object_get(json_array_get(channels, i), "target");
        json_t *extension =
            json_object_get(json_object_get(target, "extensions"), "KHR_animation_pointer");
        const char *pointer = json_string_value(json_object_get(extension, "pointer"));
        assert_non_null(pointer);
        assert_true(strncmp(pointer, "/materials/", 11) == 0);
        const size_t material = strtoul(pointer + 11, NULL, 10);
        moved[material == copy] = true;
    }
    assert_true(moved[0] && moved[1]);
    close_report(&r);
}

TEST(a_hidden_box_occludes_nothing)
{
    reported r = bake_report("hidden_node.glb", NULL);
    ASSERT_NEAR(r.report.ao_mean, 1.0, 1e-6);
    assert_int_equal(r.report.surfaces_baked, 1);
    json_t *box = json_object_get(first_primitive(&r, 1), "attributes");
    assert_string_equal(json_string_value(json_object_get(item(&r, "nodes", 1), "name")), "Hidden");
    assert_null(json_object_get(box, "TEXCOORD_1"));
    assert_false(has_map(&r, material_of(first_primitive(&r, 1))));
    close_report(&r);
}

TEST(occlusion_of_an_unlit_material_is_told)
{
    test_log_clear();
    reported r = bake_report("unlit.glb", NULL);
    assert_true(test_log_has("unlit"));
    close_report(&r);
}

TEST(a_backslash_in_a_uri_is_a_slash)
{
    alp_scene *scene = test_load(context, report_path("gltf_backslash.gltf"));
    assert_int_equal(scene->triangle_count, 14);
    alp_scene_destroy(scene);
}

/// The boxes have no vertices to split: their arrays stay, and sets and a map come.
TEST(nothing_useless_is_left)
{
    reported r = bake_report("variants.glb", NULL);
    const size_t sets = 2, maps = 1, old = 8;
    assert_true(alpi_gltf_count(r.written, "accessors") <= old + sets);
    assert_true(alpi_gltf_count(r.written, "bufferViews") <= old + sets + maps);
    close_report(&r);
}
