// SPDX-License-Identifier: MIT
// Normal maps: read with the material, decoded when a host asks for them; and tangents.
#include "drawn_asset.h"

#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define NORMAL(members)                                                                            \
    "{'name':'m','pbrMetallicRoughness':{'metallicFactor':0},'normalTexture':{" members "}}"
#define TRANSFORM(members) ",'extensions':{'KHR_texture_transform':{" members "}}"

// --- reading -------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(a_normal_map_is_loaded_when_it_is_asked_for, 1)
{
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0,'texCoord':1,'scale':-0.5" TRANSFORM(
                                                "'offset':[0.5,0.25],'scale':[2,4]")));
    const alp_material_info m = alp_scene_get_material(scene, 0);
    assert_int_equal(m.normal_texture.image, DRAWN_IMAGE);
    assert_int_equal(m.normal_texture.uv_slot, 1);
    assert_int_equal(m.normal_texture.wrap_u, ALP_WRAP_CLAMP);
    ASSERT_NEAR(m.normal_scale, -0.5, 0.0);
    const float transform[2][3] = {{2, 0, 0.5f}, {0, 4, 0.25f}};
    for (int k = 0; k < 6; k++) {
        ASSERT_NEAR(m.normal_texture.transform[k / 3][k % 3], transform[k / 3][k % 3], 0.0);
    }
    assert_null(alp_scene_get_image(scene, DRAWN_IMAGE)); // light does not need it
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    const alp_image *image = alp_scene_get_image(scene, DRAWN_IMAGE);
    assert_non_null(image);
    assert_int_equal(((const uint8_t *)alp_image_pixels(image))[1], 90); // 83 + 7
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    assert_ptr_equal(alp_scene_get_image(scene, DRAWN_IMAGE), image); // once
    assert_null(scene->images[DRAWN_IMAGE]); // writers of scenes do not meet it
    assert_null(alp_scene_get_image(scene, DRAWN_SAME));
    assert_string_equal(test_log_text(), "");
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(an_image_that_light_reads_too_is_not_loaded_twice, 1)
{
    alp_scene *scene = drawn_asset(
        context, "{'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0},"
                 "'normalTexture':{'index':0}},{'normalTexture':{'index':2}}"); // no surface has it
    const alp_image *image = alp_scene_get_image(scene, DRAWN_IMAGE);
    assert_non_null(image);
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    assert_ptr_equal(alp_scene_get_image(scene, DRAWN_IMAGE), image);
    assert_null(scene->normal_maps[DRAWN_IMAGE]);
    assert_null(alp_scene_get_image(scene, DRAWN_SAME));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(normal_maps_that_cannot_be_read_cost_a_warning_when_loaded, 1)
{
    static const struct {
        const char *material;
        bool lost; // the texture is none
    } cases[] = {{NORMAL("'index':1"), false},
                 {NORMAL("'index':3"), true},
                 {NORMAL("'index':0,'texCoord':4"), true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_log_clear();
        alp_scene *scene = drawn_asset(context, cases[i].material);
        assert_string_equal(test_log_text(), ""); // a bake has nothing to say of it
        assert_int_equal(alp_scene_get_material(scene, 0).normal_texture.image == ALP_NONE,
                         cases[i].lost);
        ASSERT_OK(context, alp_scene_load_normal_maps(scene));
        assert_true(test_log_has("image"));
        assert_null(alp_scene_get_image(scene, DRAWN_BROKEN));
        test_log_clear();
        ASSERT_OK(context, alp_scene_load_normal_maps(scene)); // said once
        assert_string_equal(test_log_text(), "");
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(a_normal_texture_that_is_not_there_costs_itself, 1)
{
    test_log_clear();
    alp_scene *scene = drawn_asset(context, NORMAL("'index':4"));
    assert_true(test_log_has("missing"));
    assert_int_equal(alp_scene_get_material(scene, 0).normal_texture.image, ALP_NONE);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(malformed_normal_textures_are_refused_as_others_are, 1)
{
    static const struct {
        const char *material, *words;
    } cases[] = {{NORMAL("'scale':1"), "index"},
                 {NORMAL("'index':0,'scale':'big'"), "scale"},
                 {"{'normalTexture':7}", "normalTexture"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        assert_int_equal(drawn_asset_read(context, cases[i].material, &scene),
                         ALP_ERROR_INVALID_DATA);
        assert_null(scene);
        test_message_has(context, cases[i].words);
    }
}

TEST_WITH_CONTEXT(scales_stay_finite, 1)
{
    static const struct {
        const char *text;
        double scale;
    } cases[] = {{"1e300", 1000.0}, {"-1e300", -1000.0}, {"999", 999.0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char material[256];
        snprintf(material, sizeof material, NORMAL("'index':0,'scale':%s"), cases[i].text);
        test_log_clear();
        alp_scene *scene = drawn_asset(context, material);
        ASSERT_NEAR(alp_scene_get_material(scene, 0).normal_scale, cases[i].scale, 0.0);
        assert_int_equal(test_log_has("material-range"), i < 2);
        alp_scene_destroy(scene);
    }
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    scene->materials[0].normal_scale = (float)NAN;
    ASSERT_OK(context, alpi_scene_finish_quietly(scene));
    ASSERT_NEAR(alp_scene_get_material(scene, 0).normal_scale, 1.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(scenes_without_a_file_have_no_normal_maps, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    ASSERT_OK(context, alp_scene_load_normal_maps(scene));
    assert_int_equal(alp_scene_load_normal_maps(NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

TEST(memory_that_runs_out_leaves_the_scene_as_it_was)
{
    int left = 1 << 20;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    int allowed = 0;
    for (alp_result result = ALP_ERROR_OUT_OF_MEMORY; result != ALP_OK; allowed++) {
        left = allowed;
        result = alp_scene_load_normal_maps(scene);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(alp_scene_get_image(scene, DRAWN_IMAGE) != NULL, result == ALP_OK);
        assert_true(allowed < 1000);
    }
    assert_true(allowed > 4);
    left = 1 << 20;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

// --- tangents ------------------------------------------------------------------------------------

static void check_tangents(const alp_scene *scene, double x, double y, double w)
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    float tangents[4][4];
    assert_int_equal(g.vertex_count, 4);
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    for (int v = 0; v < 4; v++) {
        ASSERT_NEAR(tangents[v][0], x, 1e-6);
        ASSERT_NEAR(tangents[v][1], y, 1e-6);
        ASSERT_NEAR(tangents[v][2], 0.0, 1e-6);
        ASSERT_NEAR(tangents[v][3], w, 0.0);
    }
}

TEST_WITH_CONTEXT(tangents_follow_u_of_the_normal_texture, 1)
{
    static const struct {
        const char *material;
        double x, y, w;
    } cases[] = {
        {NORMAL("'index':0"), 1, 0, 1},
        {NORMAL("'index':0,'texCoord':1"), -1, 0, -1}, // mirrored
        {NORMAL("'index':0" TRANSFORM("'texCoord':1")), -1, 0, -1},
        {NORMAL("'index':0" TRANSFORM("'scale':[-1,1]")), -1, 0, -1},
        {NORMAL("'index':0" TRANSFORM("'scale':[1,-2]")), 1, 0, -1}, // upside down
        {NORMAL("'index':0" TRANSFORM("'scale':[3,3],'offset':[9,9]")), 1, 0, 1},
        // u' = v, which grows downwards on the square
        {NORMAL("'index':0" TRANSFORM("'rotation':1.5707963267948966")), 0, -1, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = drawn_asset(context, cases[i].material);
        check_tangents(scene, cases[i].x, cases[i].y, cases[i].w);
        alp_scene_destroy(scene);
    }
}

/// u and v of a texture are the coordinates of a point along t and against b, in metres, so that
/// the gradient of a bump in them is the gradient over the surface.
TEST_WITH_CONTEXT(the_frame_is_the_derivative_of_the_texture, 1)
{
    alp_scene *scene = drawn_asset(
        context, NORMAL("'index':0" TRANSFORM("'scale':[2,2],'rotation':0.7,'offset':[0.1,0]")));
    const alp_geometry g = alp_scene_get_geometry(scene);
    const alp_texture_info texture = alp_scene_get_material(scene, 0).normal_texture;
    float tangents[4][4];
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    double place[4][2];
    for (int v = 0; v < 4; v++) {
        const float *uv = g.uvs[texture.uv_slot][v];
        for (int k = 0; k < 2; k++) {
            const float *row = texture.transform[k];
            place[v][k] = (double)(row[0] * uv[0] + row[1] * uv[1] + row[2]);
        }
    }
    const double t[2] = {(double)tangents[0][0], (double)tangents[0][1]};
    const double w = (double)tangents[0][3], b[2] = {-w * t[1], w * t[0]}; // w · (0,0,1) × t
    for (int v = 1; v < 4; v++) {
        const double x = (double)g.positions[v][0], y = (double)g.positions[v][1];
        ASSERT_NEAR(place[v][0] - place[0][0], 2.0 * (x * t[0] + y * t[1]), 1e-5);
        ASSERT_NEAR(place[v][1] - place[0][1], -2.0 * (x * b[0] + y * b[1]), 1e-5);
    }
    alp_scene_destroy(scene);
}

static void check_frames(const alp_scene *scene)
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    float(*tangents)[4] = malloc(g.vertex_count * sizeof *tangents);
    assert_non_null(tangents);
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    for (uint32_t v = 0; v < g.vertex_count; v++) {
        double length = 0.0, along = 0.0;
        for (int k = 0; k < 3; k++) {
            length += (double)tangents[v][k] * (double)tangents[v][k];
            along += (double)tangents[v][k] * (double)g.normals[v][k];
        }
        ASSERT_NEAR(length, 1.0, 1e-5);
        ASSERT_NEAR(along, 0.0, 1e-5);
        assert_true(tangents[v][3] == 1.0f || tangents[v][3] == -1.0f);
    }
    free(tangents);
}

TEST_WITH_CONTEXT(every_vertex_gets_a_frame, 1)
{
    static const char *const materials[] = {
        "{}", NORMAL("'index':0" TRANSFORM("'scale':[0,1]")), NORMAL("'index':0,'texCoord':2"),
        NORMAL("'index':0" TRANSFORM("'scale':[1e38,-1e38],'rotation':1e30")), NORMAL("'index':3")};
    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++) {
        alp_scene *scene = drawn_asset(context, materials[i]);
        check_frames(scene);
        alp_scene_destroy(scene);
    }
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    scene->uvs[0][0][0] = (float)NAN;
    scene->uvs[0][1][1] = INFINITY;
    check_frames(scene);
    alp_scene_destroy(scene);
    scene = test_load(context, "builtin:teapot-room");
    check_frames(scene);
    assert_int_equal(alp_scene_make_tangents(scene, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_scene_make_tangents(NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

/// Vertex 0 lies in two triangles. The second is mirrored in the image; its angle there is made
/// larger, then smaller, than the 45° of the first.
TEST_WITH_CONTEXT(the_larger_angle_decides_where_mirrored_halves_share_a_vertex, 1)
{
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    scene->positions[2][0] = -1.0f; // 0 3 2: 135° at vertex 0
    scene->uvs[0][2][0] = 3.0f;     // behind vertex 3 along u
    float tangents[4][4];
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    ASSERT_NEAR(tangents[1][3], 1.0, 0.0);
    ASSERT_NEAR(tangents[2][3], -1.0, 0.0);
    ASSERT_NEAR(tangents[0][3], -1.0, 0.0);
    scene->triangle_usable[1] = false;
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    ASSERT_NEAR(tangents[0][3], 1.0, 0.0);
    scene->triangle_usable[1] = true;
    scene->positions[2][0] = 0.9f; // 3°
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    ASSERT_NEAR(tangents[0][3], 1.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(directions_are_weighted_by_angle, 1)
{
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    scene->positions[2][0] = -1.0f; // 135° at vertex 0, beside 45°
    scene->positions[2][1] = 0.0f;
    scene->uvs[0][2][0] = 0.0f; // there u = y, v = 1 - x
    scene->uvs[0][2][1] = 2.0f;
    float tangents[4][4];
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    ASSERT_NEAR(tangents[0][0], 1.0 / sqrt(10.0), 1e-6); // 45° (1, 0) + 135° (0, 1)
    ASSERT_NEAR(tangents[0][1], 3.0 / sqrt(10.0), 1e-6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(normals_behind_the_triangle_keep_the_image_upright, 1)
{
    alp_scene *scene = drawn_asset(context, NORMAL("'index':0"));
    for (int v = 0; v < 4; v++) {
        scene->normals[v][2] = -1.0f;
    }
    check_tangents(scene, 1.0, 0.0, -1.0); // -cross(-z, x) = +y
    alp_scene_destroy(scene);
}

/// P(u, v) = (cos φ, −v, sin φ) with φ = −2π u, seen from outside with its image upright:
/// dP/du is along (sin φ, 0, −cos φ).
TEST_WITH_CONTEXT(tangents_of_a_cylinder_are_its_derivative, 1)
{
    enum { SIDES = 12, VERTICES = 2 * (SIDES + 1) };
    float positions[VERTICES][3], normals[VERTICES][3], uvs[VERTICES][2], tangents[VERTICES][4];
    uint32_t indices[2 * SIDES][3];
    for (uint32_t i = 0; i < VERTICES; i++) { // the seam twice
        const double u = (i / 2) / (double)SIDES, phi = -2.0 * acos(-1.0) * u;
        const float v = (float)(i % 2);
        memcpy(positions[i], (float[]){(float)cos(phi), -v, (float)sin(phi)}, 3 * sizeof(float));
        memcpy(normals[i], (float[]){(float)cos(phi), 0.0f, (float)sin(phi)}, 3 * sizeof(float));
        memcpy(uvs[i], (float[]){(float)u, v}, 2 * sizeof(float));
    }
    for (uint32_t i = 0; i < SIDES; i++) { // above left, below left, below right, above right
        const uint32_t a = 2 * i, b = a + 1, c = a + 3, d = a + 2;
        memcpy(indices[2 * i], (uint32_t[]){a, b, c}, sizeof *indices);
        memcpy(indices[2 * i + 1], (uint32_t[]){a, c, d}, sizeof *indices);
    }
    const alp_mesh mesh = {.vertex_count = VERTICES,
                           .triangle_count = 2 * SIDES,
                           .positions = positions[0],
                           .normals = normals[0],
                           .uvs = uvs[0],
                           .indices = indices[0]};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    scene->materials[0].normal_texture.image = 0;
    scene->materials[0].normal_texture.uv_set = 1;
    assert_int_equal(alp_scene_make_tangents(scene, tangents), ALP_OK);
    for (uint32_t i = 0; i < VERTICES; i++) {
        ASSERT_NEAR(tangents[i][0], normals[i][2], 1e-6);
        ASSERT_NEAR(tangents[i][1], 0.0, 1e-6);
        ASSERT_NEAR(tangents[i][2], -normals[i][0], 1e-6);
        ASSERT_NEAR(tangents[i][3], 1.0, 0.0);
    }
    alp_scene_destroy(scene);
}
