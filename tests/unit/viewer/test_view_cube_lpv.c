// SPDX-License-Identifier: MIT
// The cube map of a point in a volume of light: the faces show one volume, that of the point.
#include "test_gl.h"

#include "gl/gl_cube.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 32 };

typedef float picture[SIDE][SIDE][4];

static const float point[3] = {0.2f, 0.3f, 0.35f};

/// A volume of two grids, the finer of which lies round the eye.
static mode_light make_light(alp_context *context, const alp_scene *scene)
{
    mode_light light = {.lpv = malloc(sizeof *light.lpv)};
    alp_lpv_options o = alp_lpv_options_for_scene(scene, 16, 2);
    alp_lpv_scene_options frame = alp_lpv_scene_options_default();
    int code = EXIT_FAILED;
    assert_non_null(light.lpv);
    frame.points = 0;
    o.blockers = true;
    ASSERT_OK(context, lpv_frame_create(scene, &o, &frame, &code, light.lpv));
    assert_int_equal(code, EXIT_DONE);
    gl_field_create(scene, READ_PIXEL, SIDE, SIDE, &light.field);
    gl_field_set_volume(&light.field, &light.lpv->volume, false);
    return light;
}

/// Draws the view of a face, as a camera sees it, by the light that the volume has.
static void draw_face(drawing *d, const float axes[2][3], picture pixels)
{
    const alp_scene_info info = alp_scene_get_info(d->scene);
    alp_camera camera = {.vertical_fov = (float)(0.5 * M_PI)};
    for (int k = 0; k < 3; k++) {
        camera.position[k] = point[k];
        camera.target[k] = point[k] + axes[0][k];
        camera.up[k] = axes[1][k];
    }
    const camera_view view = camera_view_of(&camera, SIDE, SIDE, &info);
    drawing_draw_view(d, &view);
    glGetTextureImage(d->targets.light, 0, GL_RGBA, GL_FLOAT, sizeof(picture), pixels);
}

/// Texels of a face, which is a mirror image, that are those of a picture.
static uint32_t count_equal(picture face, picture drawn)
{
    uint32_t equal = 0;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const float *a = face[y][SIDE - 1 - x], *b = drawn[y][x];
            bool same = true;
            for (int k = 0; k < 4; k++) {
                same = same && fabsf(a[k] - b[k]) <= 1e-3f * fmaxf(fabsf(b[k]), 1e-3f);
            }
            equal += same;
        }
    }
    return equal;
}

TEST_WITH_CONTEXT(faces_show_the_volume_of_the_point, 2)
{
    static const float axes[6][2][3] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}},
                                        {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {0, 0, 1}},
                                        {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
    static const float nowhere[3] = {0.0f, 0.0f, 0.0f};
    static picture faces[6], drawn;
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_lighting_options lighting = alp_lighting_options_default();
    const drawing_options options = {.context = context,
                                     .mode = test_gl_mode("lpv"),
                                     .light = make_light(context, scene),
                                     .lighting = &lighting,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .level_zero = true};
    drawing d;
    gl_cube cube;
    uint32_t equal = 0;
    double sum = 0.0;
    assert_int_equal(drawing_create(scene, &options, &d), EXIT_DONE);
    assert_int_equal(gl_cube_create(SIDE, &cube), EXIT_DONE);
    gl_cube_draw(&cube, &d, point);
    glGetTextureImage(cube.faces, 0, GL_RGBA, GL_FLOAT, sizeof faces, faces);
    drawing_light(&d, point, nowhere, NULL);
    for (int i = 0; i < 6; i++) {
        draw_face(&d, axes[i], drawn);
        equal += count_equal(faces[i], drawn);
        sum += (double)drawn[SIDE / 2][SIDE / 2][0];
    }
    test_gl_check();
    gl_cube_destroy(&cube);
    drawing_destroy(&d);
    alp_scene_destroy(scene);
    assert_true(sum > 0.1);
    if (equal < 6 * SIDE * SIDE * 98 / 100) {
        fail_msg("%u of %d texels are those of the volume", equal, 6 * SIDE * SIDE);
    }
}
