// SPDX-License-Identifier: MIT
// The doctor's pictures: names, sizes, and how much of each colour of a fault they show.
#include "test_support.h"

static const float SQUARE[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, -2}, {0, 0, -2}};
static const float BESIDE[4][3] = {{3, 0, 0}, {5, 0, 0}, {5, 0, -2}, {3, 0, -2}};
static const float UP[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
static const float DOWN[4][3] = {{0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}};
static const float FIRST[4][2] = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}};
static const float ACROSS[4][2] = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.75f, 0.75f}, {0.25f, 0.75f}};
static const float APART[4][2] = {{0.6f, 0.6f}, {0.9f, 0.6f}, {0.9f, 0.9f}, {0.6f, 0.9f}};
static const float FAR_OFF[4][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
static const uint32_t TRIANGLES[2][3] = {{0, 1, 2}, {0, 2, 3}};

static alp_scene *make(alp_context *context, const float (*uvs)[2], const float (*normals)[3])
{
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = SQUARE[0],
                           .normals = normals[0],
                           .uvs = FIRST[0],
                           .triangle_count = 2,
                           .indices = TRIANGLES[0],
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_mesh meshes[2] = {mesh, mesh};
    meshes[1].positions = BESIDE[0];
    meshes[1].uvs = uvs[0];
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    return scene;
}

/// Pixels of the reds of a fault and of its orange; of whites in `white`.
typedef struct tally {
    uint32_t red, orange, white, magenta;
} tally;

static tally count_colors(alp_image *image)
{
    const alp_image_info info = alp_image_get_info(image);
    const uint8_t *bytes = alp_image_bytes(image);
    tally t = {0, 0, 0, 0};
    for (size_t i = 0; i < (size_t)info.width * info.height; i++) {
        const int r = bytes[3 * i], g = bytes[3 * i + 1], b = bytes[3 * i + 2];
        t.red += r > 90 && g < r / 2 && b < r / 2 && g < 90;
        t.orange += r > 150 && g > r / 2 && g < 3 * r / 4 && b < g / 2;
        t.magenta += r > 150 && g < r / 3 && b > r / 2;
        t.white += r == 240 && g == 240 && b == 240;
    }
    return t;
}

static alp_image *draw(const alp_diagnosis *d, uint32_t index)
{
    alp_image *image = NULL;
    assert_int_equal(alp_diagnosis_picture(d, index, &image), ALP_OK);
    return image;
}

static alp_diagnosis *diagnose(alp_context *context, const alp_scene *scene)
{
    alp_diagnosis *d = NULL;
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
    return d;
}

TEST(sets_show_their_faults)
{
    static const struct {
        const float (*uvs)[2];
        uint32_t red, frame; // pixels
    } cases[] = {{APART, 0, 0},
                 {ACROSS, 256 * 256, 0},
                 // Three tiles of 1 + 4.2 are framed: about 4 · 1024 / 5.2 pixels.
                 {FAR_OFF, 0, 4 * 1024 * 10 / 52}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, cases[i].uvs, UP);
        alp_diagnosis *d = diagnose(context, scene);
        assert_int_equal(alp_diagnosis_picture_count(d), 3);
        assert_string_equal(alp_diagnosis_picture_name(d, 0), "scene");
        assert_string_equal(alp_diagnosis_picture_name(d, 2), "uv1");
        assert_string_equal(alp_diagnosis_picture_name(d, 3), "");
        alp_image *image = draw(d, 2);
        assert_int_equal(alp_image_get_info(image).width, 1024);
        const tally t = count_colors(image);
        // Outlines and darkened borders take a line or two of pixels of what they surround.
        ASSERT_NEAR(t.red, cases[i].red, 4 * 256);
        assert_int_equal(t.orange > 0, cases[i].frame > 0);
        ASSERT_NEAR(t.white, cases[i].frame, 16); // corners count once; lines may cross
        alp_image_destroy(image);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_SLOW(the_scene_shows_turned_normals)
{
    uint32_t red[2];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, APART, i == 0 ? UP : DOWN);
        alp_diagnosis *d = diagnose(context, scene);
        alp_image *image = draw(d, 0);
        assert_int_equal(alp_image_get_info(image).width, 960);
        assert_int_equal(alp_image_get_info(image).height, 720);
        red[i] = count_colors(image).red;
        alp_image_destroy(image);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_int_equal(red[0], 0);
    assert_true(red[1] > 10000); // the two squares fill some of the picture
}

/// A triangle whose normals look to its back has a picture of its own, in which it is magenta, and
/// is ringed; a mended one has none.
TEST(spots_are_shown_from_nearby)
{
    for (int i = TEST_STEP > 1 ? 1 : 0; i < 2; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, APART, i == 0 ? UP : DOWN);
        alp_diagnosis *d = diagnose(context, scene);
        assert_int_equal(alp_diagnosis_picture_count(d), 3 + i);
        if (i == 1) {
            assert_string_equal(alp_diagnosis_picture_name(d, 3), "spot-reversed-normals");
            alp_image *image = draw(d, 3);
            const tally t = count_colors(image);
            // The ring alone has 2 π 42 · 4 = 1056 pixels; the triangle is near.
            assert_true(t.magenta > 20000 && t.magenta < 960 * 720 / 2);
            alp_image_destroy(image);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Islands that overlap have a ring in the picture of their set.
TEST(spots_of_sets_are_ringed)
{
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, i == 0 ? APART : ACROSS, UP);
        alp_diagnosis *d = diagnose(context, scene);
        alp_image *image = draw(d, 2);
        // Half of the ring's width is magenta: 2 π 42 · 4 pixels, to a pixel on both rims.
        ASSERT_NEAR(count_colors(image).magenta, i == 0 ? 0.0 : 2.0 * 3.1416 * 42.0 * 4.0,
                    i == 0 ? 0.0 : 2.0 * 2.0 * 3.1416 * 42.0);
        alp_image_destroy(image);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(what_is_not_there_is_not_drawn, 1)
{
    alp_scene *scene = make(context, APART, UP);
    alp_diagnosis *d = diagnose(context, scene);
    alp_image *image = NULL;
    assert_int_equal(alp_diagnosis_picture(d, 3, &image), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_diagnosis_picture(NULL, 0, &image), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_diagnosis_picture(d, 0, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_diagnosis_picture_count(NULL), 0);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

TEST(every_allocation_may_fail)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = make(context, ACROSS, UP);
    alp_diagnosis *d = diagnose(context, scene);
    int failures = 0;
    alp_image *image = NULL;
    for (left = 0; alp_diagnosis_picture(d, 2, &image) != ALP_OK; left = failures) {
        assert_null(image);
        assert_true(++failures < 1000);
    }
    assert_true(failures > 5);
    left = 1000;
    alp_image_destroy(image);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
