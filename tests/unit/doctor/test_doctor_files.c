// SPDX-License-Identifier: MIT
// Files that are odd and load: the doctor names what is odd about each. Built-in scenes are well.
#include "test_support.h"

#include <stdio.h>

typedef struct heard {
    alp_report_finding messages[64];
    char texts[64][3][256];
    uint32_t count;
} heard;

static void hear(void *user, const alp_log_message *message)
{
    heard *h = user;
    if (message->level != ALP_LOG_WARNING || h->count == 64) {
        return;
    }
    const char *const parts[3] = {message->code, message->object, message->text};
    for (int k = 0; k < 3; k++) {
        snprintf(h->texts[h->count][k], sizeof h->texts[0][0], "%s", parts[k]);
    }
    h->messages[h->count] =
        (alp_report_finding){h->texts[h->count][0], h->texts[h->count][1], h->texts[h->count][2]};
    h->count++;
}

/// Loads as alpenglow info does, and looks.
static alp_diagnosis *look(const char *path, heard *h, alp_context **context, alp_scene **scene)
{
    *h = (heard){.count = 0};
    alp_context_options options = alp_context_options_default();
    options.worker_count = 1;
    options.log = hear;
    options.log_user = h;
    ASSERT_OK(NULL, alp_context_create(&options, context));
    ASSERT_OK(*context, alp_scene_load(*context, path, scene));
    ASSERT_OK(*context, alp_scene_examine(*scene, NULL, NULL, NULL));
    alp_diagnosis_options o = alp_diagnosis_options_default();
    o.messages = h->messages;
    o.message_count = h->count;
    alp_diagnosis *d = NULL;
    ASSERT_OK(*context, alp_scene_diagnose(*scene, &o, &d));
    return d;
}

static bool has(const alp_diagnosis *d, const char *code)
{
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        if (strcmp(alp_diagnosis_get_finding(d, i).code, code) == 0) {
            return true;
        }
    }
    return false;
}

/// How many findings are worse than notes.
static uint32_t count_grave(const alp_diagnosis *d)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        if (f.severity != ALP_SEVERITY_NOTE) {
            print_message("%s: %s\n", f.code, f.what);
            count++;
        }
    }
    return count;
}

typedef struct odd_file {
    const char *file, *codes[2]; // NULL: it is odd and legal, and nothing is wrong
} odd_file;

static void check_odd_file(const odd_file *odd, heard *h)
{
    char path[128];
    snprintf(path, sizeof path, "scenes/broken/crafted/%s", odd->file);
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_diagnosis *d = look(test_shared(path), h, &context, &scene);
    for (int k = 0; k < 2 && odd->codes[k] != NULL; k++) {
        if (!has(d, odd->codes[k])) {
            fail_msg("%s: no finding %s", odd->file, odd->codes[k]);
        }
    }
    if (odd->codes[0] == NULL && count_grave(d) > 0) {
        fail_msg("%s: something is wrong with it", odd->file);
    }
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(odd_files_have_their_finding)
{
    static const odd_file cases[] = {
        {"albedo_one_parallel_plates.glb", {"white"}},
        {"albedo_out_of_range.glb", {"material-range"}},
        {"collinear_triangles.glb", {"no-triangles", "zero-area"}},
        {"concave_ngon.obj", {NULL}},
        {"corrupt_png.glb", {"image"}},
        {"crlf_tabs_continuation.obj", {NULL}},
        {"degenerate_indices.glb", {"no-triangles", "zero-area"}},
        {"empty_scene.gltf", {"no-triangles"}},
        {"far_from_origin_6378km.glb", {"precision"}},
        {"huge_coordinates_1e30.glb", {"bad-coordinates", "no-triangles"}},
        {"index_count_not_3n.glb", {"leftover-indices"}},
        {"inf_vertices.glb", {"bad-coordinates", "no-triangles"}},
        {"mirrored_node.glb", {"mirrored"}},
        {"missing_mtl.obj", {"mtllib", "material"}},
        {"missing_normals.glb", {"no-normals"}},
        {"missing_uvs.glb", {"no-uvs"}},
        {"nan_vertices.glb", {"bad-coordinates", "no-triangles"}},
        {"no_geometry.dae", {"no-triangles"}},
        {"no_scene.gltf", {NULL}},
        {"overlapping_uv1.glb", {"uv-overlap"}},
        {"point_light_on_surface.glb", {"light-on-surface"}},
        {"points_only.glb", {"no-triangles"}},
        {"polygons_with_hole.dae", {NULL}},
        {"polylist_mixed.dae", {NULL}},
        {"relative_indices.obj", {"backs-seen"}},
        {"spot_inner_gt_outer.glb", {"light"}},
        {"tristrips_trifans.dae", {"coplanar"}}, // one square as a strip and as a fan
        {"uv1_outside_unit_square.glb", {"uv-outside"}},
        {"z_up_inches.dae", {NULL}},
        {"zero_area_uv1.glb", {"uv-flat"}},
        {"zero_normals.glb", {"bad-normals"}},
        {"zero_scale.glb", {"no-triangles", "zero-area"}},
        {"zero_size_scene.glb", {"no-triangles", "zero-area"}},
    };
    if (test_shared("scenes/broken/crafted") == NULL) {
        print_message("no shared scenes: skipped\n");
        skip();
    }
    heard *h = test_malloc(sizeof *h);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        check_odd_file(&cases[i], h);
    }
    test_free(h);
}

/// What is so: gables are prisms between walls and roof, which only their ends look out of; the
/// fountain's lower step is let into the court.
static bool is_meant(const char *scene, const alp_finding *f)
{
    static const struct {
        const char *scene, *name;
        alp_finding_kind kind;
    } meant[] = {{"builtin:atrium", "lower step", ALP_FINDING_BURIED},
                 {"builtin:terrain", "gables", ALP_FINDING_BURIED}};
    bool any = f->kind == ALP_FINDING_NO_UVS || f->kind == ALP_FINDING_NO_LIGHT;
    for (size_t i = 0; i < sizeof meant / sizeof *meant; i++) {
        any = any || (f->kind == meant[i].kind && strcmp(scene, meant[i].scene) == 0 &&
                      strcmp(f->name, meant[i].name) == 0);
    }
    return any;
}

TEST(built_in_scenes_are_well)
{
    static const char *const names[] = {
        "builtin:cornell",      "builtin:furnace",     "builtin:bowl",
        "builtin:sphere-plane", "builtin:torus-plane", "builtin:teapot-room",
        "builtin:windows",      "builtin:atrium",      "builtin:terrain"};
    heard *h = test_malloc(sizeof *h);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        alp_context *context = NULL;
        alp_scene *scene = NULL;
        alp_diagnosis *d = look(names[i], h, &context, &scene);
        for (uint32_t k = 0; k < alp_diagnosis_finding_count(d); k++) {
            const alp_finding f = alp_diagnosis_get_finding(d, k);
            if (!is_meant(names[i], &f)) {
                fail_msg("%s: %s: %s", names[i], f.code, f.what);
            }
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    test_free(h);
}
