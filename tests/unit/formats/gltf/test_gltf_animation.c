// SPDX-License-Identifier: MIT
// Poses of animations: closed forms of each interpolation, and what stays in place.
#include "pack_asset.h"
#include "test_gltf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NUMBERS = 64 };

/// One channel of an animation of a triangle's node.
typedef struct track {
    const char *path, *interpolation; // NULL: left out
    int count;                        // keys
    float times[4];
    const char *type; // of the values
    int component;    // 0 = floats
    int value_count;
    float values[NUMBERS];
    int16_t shorts[NUMBERS]; // of component 5122
} track;

/// The animated node is a child of one at (0, 0, 7), and stands at (5, 0, 0) at rest.
/// @param node further members of it; a translation replaces that place
static const char *write_track(const track *t, const char *node)
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float moved[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const char *place = strstr(node, "translation") != NULL ? "" : ",'translation':[5,0,0]";
    char rest[2048], how[64] = "";
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, positions, sizeof positions, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,0]");
    pack_accessor(asset, pack_view(asset, moved, sizeof moved, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,1],'max':[0,0,1]");
    pack_accessor(asset, pack_view(asset, t->times, sizeof t->times, 0), 5126, (size_t)t->count,
                  "SCALAR", "");
    const int view = t->component == 0 ? pack_view(asset, t->values, sizeof t->values, 0)
                                       : pack_view(asset, t->shorts, sizeof t->shorts, 0);
    pack_accessor(asset, view, t->component == 0 ? 5126 : t->component, (size_t)t->value_count,
                  t->type, t->component == 0 ? "" : ",'normalized':true");
    if (t->interpolation != NULL) {
        snprintf(how, sizeof how, ",'interpolation':'%s'", t->interpolation);
    }
    snprintf(rest, sizeof rest,
             "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],'translation':[0,0,7]},"
             "{'name':'mover','mesh':0%s%s}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':1},"
             "{'POSITION':1}]}]}],"
             "'animations':[{'name':'turn','channels':[{'sampler':0,'target':{'node':1,'path':"
             "'%s'}}],'samplers':[{'input':2,'output':3%s}]}]",
             place, node, t->path, how);
    return pack_write(asset, rest);
}

static alp_scene *load(alp_context *context, const char *path)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    return scene;
}

/// Compares the corners of the triangle, which has three vertices of its own.
static void assert_corners(const alp_scene *scene, double seconds, const double expected[3][3])
{
    alp_scene *posed = NULL;
    ASSERT_OK(scene->context, alp_scene_pose(scene, 0, seconds, &posed));
    for (int v = 0; v < 3; v++) {
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(posed->positions[v][k], expected[v][k], 2e-6); // rounding of floats
        }
    }
    alp_scene_destroy(posed);
}

/// The node's translation alone.
static void assert_place(const alp_scene *scene, double seconds, double x, double y, double z)
{
    const double expected[3][3] = {{x, y, 7 + z}, {x + 1, y, 7 + z}, {x, y + 1, 7 + z}};
    assert_corners(scene, seconds, expected);
}

/// A turn about z.
static void assert_turned(const alp_scene *scene, double seconds, double degrees)
{
    const double c = cos(degrees * M_PI / 180.0), s = sin(degrees * M_PI / 180.0);
    const double expected[3][3] = {{5, 0, 7}, {5 + c, s, 7}, {5 - s, c, 7}};
    assert_corners(scene, seconds, expected);
}

TEST_WITH_CONTEXT(linear_translation, 1)
{
    const track t = {.path = "translation",
                     .count = 3,
                     .times = {1, 2, 4},
                     .type = "VEC3",
                     .value_count = 3,
                     .values = {0, 0, 0, 2, 4, 0, 2, 0, 8}};
    test_log_clear();
    alp_scene *scene = load(context, write_track(&t, ""));
    assert_false(test_log_has("animation"));
    ASSERT_NEAR(scene->positions[0][0], 5, 1e-6); // at rest
    assert_place(scene, -3, 0, 0, 0);
    assert_place(scene, 1, 0, 0, 0);
    assert_place(scene, 1.25, 0.5, 1, 0);
    assert_place(scene, 2, 2, 4, 0);
    assert_place(scene, 3.5, 2, 1, 6);
    assert_place(scene, 4, 2, 0, 8);
    assert_place(scene, 1e30, 2, 0, 8);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(stepped_scale, 1)
{
    const track t = {.path = "scale",
                     .interpolation = "STEP",
                     .count = 2,
                     .times = {0, 1},
                     .type = "VEC3",
                     .value_count = 2,
                     .values = {2, 1, 1, 3, 5, 1}};
    const double before[3][3] = {{5, 0, 7}, {7, 0, 7}, {5, 1, 7}};
    const double after[3][3] = {{5, 0, 7}, {8, 0, 7}, {5, 5, 7}};
    alp_scene *scene = load(context, write_track(&t, ""));
    assert_corners(scene, 0, before);
    assert_corners(scene, 0.999, before);
    assert_corners(scene, 1, after);
    assert_corners(scene, 2, after);
    alp_scene_destroy(scene);
}

/// Even angular speed, also where the quaternions lie on opposite sides of the sphere.
TEST_WITH_CONTEXT(rotation_on_the_sphere, 1)
{
    const float h = (float)sqrt(0.5);
    track t = {.path = "rotation",
               .interpolation = "LINEAR",
               .count = 2,
               .times = {0, 3},
               .type = "VEC4",
               .value_count = 2,
               .values = {0, 0, 0, 1, 0, 0, h, h}};
    for (int i = 0; i < 3; i++) {
        if (i == 1) { // −q is the same turn: the short way is still 90 degrees
            t.values[6] = t.values[7] = -h;
        } else if (i == 2) { // lengths do not matter
            t.values[3] = 0.5f;
            t.values[6] = t.values[7] = -2.0f;
        }
        alp_scene *scene = load(context, write_track(&t, ""));
        assert_turned(scene, 0, 0);
        assert_turned(scene, 1, 30);
        assert_turned(scene, 2.5, 75);
        assert_turned(scene, 3, 90);
        alp_scene_destroy(scene);
    }
}

/// Turns of 180 degrees, where the cosine is 0, and of 0, where the sine is.
TEST_WITH_CONTEXT(rotation_by_half_a_turn_and_by_none, 1)
{
    track t = {.path = "rotation",
               .count = 3,
               .times = {0, 1, 2},
               .type = "VEC4",
               .value_count = 3,
               .values = {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0}};
    alp_scene *scene = load(context, write_track(&t, ""));
    assert_turned(scene, 0.25, 45);
    assert_turned(scene, 1.5, 180);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(rotation_in_normalised_integers, 1)
{
    const track t = {.path = "rotation",
                     .count = 2,
                     .times = {0, 1},
                     .type = "VEC4",
                     .component = 5122,
                     .value_count = 2,
                     .shorts = {0, 0, 0, 32767, 0, 0, 32767, 32767}};
    alp_scene *scene = load(context, write_track(&t, ""));
    assert_turned(scene, 0.5, 45);
    assert_turned(scene, 1, 90);
    alp_scene_destroy(scene);
}

/// Tangents are per second: keys at 1 s and 3 s with the values and slopes of t³ give t³.
TEST_WITH_CONTEXT(cubic_translation, 1)
{
    const track t = {.path = "translation",
                     .interpolation = "CUBICSPLINE",
                     .count = 2,
                     .times = {1, 3},
                     .type = "VEC3",
                     .value_count = 6,
                     .values = {99, 99, 99, 1, 0, 2, 3, 0, 0, 27, 0, 0, 27, 4, 2, 99, 99, 99}};
    alp_scene *scene = load(context, write_track(&t, ""));
    for (int i = 0; i <= 8; i++) {
        const double seconds = 1.0 + 0.25 * i, s = 0.125 * i;
        // y: slope 0 to 0 between 0 and 4. z: constant 2.
        assert_place(scene, seconds, seconds * seconds * seconds, 4 * (3 * s * s - 2 * s * s * s),
                     2);
    }
    assert_place(scene, 0, 1, 0, 2);
    assert_place(scene, 9, 27, 4, 2);
    alp_scene_destroy(scene);
}

/// The spline is normalised; without tangents it is the chord at its middle.
TEST_WITH_CONTEXT(cubic_rotation, 1)
{
    const float h = (float)sqrt(0.5);
    track t = {.path = "rotation",
               .interpolation = "CUBICSPLINE",
               .count = 2,
               .times = {0, 1},
               .type = "VEC4",
               .value_count = 6,
               .values = {[7] = 1, [18] = h, [19] = h}};
    alp_scene *scene = load(context, write_track(&t, ""));
    assert_turned(scene, 0.5, 45);
    assert_turned(scene, 1, 90);
    alp_scene_destroy(scene);
    t.values[18] = 0; // from q to −q through 0: the key before
    t.values[19] = -1;
    scene = load(context, write_track(&t, ""));
    assert_turned(scene, 0.5, 0);
    alp_scene_destroy(scene);
}

/// Weights of two morph targets, which both move by +z.
TEST_WITH_CONTEXT(weights_of_morph_targets, 1)
{
    const track t = {.path = "weights",
                     .count = 2,
                     .times = {0, 1},
                     .type = "SCALAR",
                     .value_count = 4,
                     .values = {0, 0, 2, 4}};
    alp_scene *scene = load(context, write_track(&t, ",'weights':[7,0]"));
    assert_place(scene, 0, 5, 0, 0);
    assert_place(scene, 0.5, 5, 0, 3);
    assert_place(scene, 1, 5, 0, 6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(list_of_animations, 1)
{
    const track t = {
        .path = "translation", .count = 2, .times = {0, 2.5f}, .type = "VEC3", .value_count = 2};
    alp_scene *scene = load(context, write_track(&t, "")), *posed = NULL;
    assert_int_equal(alp_scene_get_info(scene).animations, 1);
    const alp_animation_info a = alp_scene_get_animation(scene, 0);
    assert_string_equal(a.name, "turn");
    ASSERT_NEAR(a.seconds, 2.5, 0);
    assert_int_equal(a.channels, 1);
    assert_string_equal(alp_scene_get_animation(scene, 1).name, "");
    assert_int_equal(alp_scene_find_animation(scene, "turn"), 0);
    assert_int_equal(alp_scene_find_animation(scene, "0"), 0);
    static const char *const none[] = {"1", "-1", "", "Turn", "0x0", "99999999999999999999"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        assert_true(alp_scene_find_animation(scene, none[i]) == ALP_NONE);
    }
    assert_int_equal(alp_scene_pose(scene, 1, 0, &posed), ALP_ERROR_INVALID_ARGUMENT);
    test_message_has(context, "has no animation 1; there are 1");
    assert_int_equal(alp_scene_pose(scene, 0, (double)NAN, &posed), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(posed);
    alp_scene_destroy(scene);
}

/// Posed scenes live without the one that they were made of, and can be posed themselves.
TEST_WITH_CONTEXT(poses_share_the_document, 1)
{
    const track t = {.path = "translation",
                     .count = 2,
                     .times = {0, 1},
                     .type = "VEC3",
                     .value_count = 2,
                     .values = {0, 0, 0, 8, 0, 0}};
    alp_scene *scene = load(context, write_track(&t, "")), *posed = NULL;
    alp_scene_set_metals(scene, ALP_METALS_BLACK);
    ASSERT_OK(context, alp_scene_pose(scene, 0, 0.25, &posed));
    const alp_scene_info a = alp_scene_get_info(scene), b = alp_scene_get_info(posed);
    assert_true(a.hash != b.hash);
    assert_int_equal(a.triangles, b.triangles);
    assert_int_equal(b.animations, 1);
    assert_true(posed->metals_black);
    alp_scene_destroy(scene);
    assert_place(posed, 0.5, 4, 0, 0);
    alp_scene_destroy(posed);
}

/// Far from the origin each pose has the origin of its scene, wherever its nodes are.
TEST_WITH_CONTEXT(poses_keep_the_origin, 1)
{
    const track t = {.path = "translation",
                     .count = 2,
                     .times = {0, 1},
                     .type = "VEC3",
                     .value_count = 2,
                     .values = {4e6f, 0, 0, 0, 0, 0}};
    alp_scene *scene = load(context, write_track(&t, ",'translation':[4000000,0,0]")),
              *posed = NULL;
    const double far = alp_scene_get_info(scene).origin[0];
    assert_true(far > 3e6);
    ASSERT_OK(context, alp_scene_pose(scene, 0, 1, &posed));
    ASSERT_NEAR(alp_scene_get_info(posed).origin[0], far, 0);
    ASSERT_NEAR(far + (double)posed->positions[0][0], 0, 1);
    alp_scene_destroy(posed);
    alp_scene_destroy(scene);
}

/// Every allocation of a pose may fail; nothing leaks, and the scene can still be posed.
TEST(poses_without_memory)
{
    const track t = {.path = "weights",
                     .count = 2,
                     .times = {0, 1},
                     .type = "SCALAR",
                     .value_count = 4,
                     .values = {0, 0, 2, 4}};
    int left;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = load(context, write_track(&t, "")), *posed = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int tries = 0;
    for (; result == ALP_ERROR_OUT_OF_MEMORY; tries++) {
        left = tries;
        result = alp_scene_pose(scene, 0, 1, &posed);
        assert_int_equal(result == ALP_OK, posed != NULL);
    }
    assert_int_equal(result, ALP_OK);
    assert_true(tries > 20);
    left = 1 << 20;
    assert_place(posed, 0.5, 5, 0, 3);
    alp_scene_destroy(posed);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
