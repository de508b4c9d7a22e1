// SPDX-License-Identifier: MIT
// Two modes in one picture, against the pictures of each.
#include "test_gl.h"

#include "divider.h"
#include "options/options.h"

#include <string.h>

enum { WIDTH = 41, HEIGHT = 16 };

typedef struct parts {
    drawing left, right;
    alp_image *left_bytes, *right_bytes; // by the numbers of the left one
    alp_image *left_light, *right_light;
} parts;

static void open_mode(alp_context *context, const alp_scene *scene, int choice, drawing *d)
{
    command_line line = {.command = COMMAND_VIEW};
    line.values[OPTION_WITH].choice = choice;
    const alp_lighting_options lighting = alp_lighting_options_default();
    const drawing_options options = {.context = context,
                                     .mode = view_mode_of(&line),
                                     .lighting = &lighting,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .level_zero = true};
    assert_int_equal(drawing_create(scene, &options, d), EXIT_DONE);
}

static void draw(const alp_scene *scene, parts *p)
{
    alp_camera camera;
    ASSERT_OK(NULL, alp_render_find_camera(scene, NULL, &camera));
    drawing_draw(&p->left, &camera);
    drawing_draw(&p->right, &camera);
}

/// Emission on the left, albedo on the right.
static void open_parts(alp_context *context, const alp_scene *scene, parts *p)
{
    alp_film_options film = alp_render_film_options(ALP_RENDER_FIELD);
    open_mode(context, scene, 0, &p->left);
    open_mode(context, scene, 1, &p->right);
    draw(scene, p);
    ASSERT_OK(context, drawing_develop(&p->left, context, &film, &p->left_bytes, &p->left_light));
    film.auto_exposure = false;
    ASSERT_OK(context,
              drawing_develop(&p->right, context, &film, &p->right_bytes, &p->right_light));
}

static void close_parts(parts *p)
{
    alp_image_destroy(p->left_bytes);
    alp_image_destroy(p->right_bytes);
    alp_image_destroy(p->left_light);
    alp_image_destroy(p->right_light);
    drawing_destroy(&p->right);
    drawing_destroy(&p->left);
}

/// @param column of the line   @param bytes of a pixel
static void check_pixels(const void *joined, const void *left, const void *right, const void *line,
                         uint32_t column, size_t bytes)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint32_t x = i % WIDTH;
        const char *from = x < column ? left : right;
        const void *expected = x == column ? line : (const void *)(from + i * bytes);
        assert_memory_equal((const char *)joined + i * bytes, expected, bytes);
    }
}

static void check_divider(alp_context *context, const alp_scene *scene, double share,
                          uint32_t column)
{
    static const uint8_t white[3] = {255, 255, 255};
    static const float nothing[4];
    alp_film_options film = alp_render_film_options(ALP_RENDER_FIELD);
    alp_image *bytes = NULL, *light = NULL;
    parts p;
    open_parts(context, scene, &p);
    assert_int_equal(divider_column(share, WIDTH), column);
    draw(scene, &p);
    ASSERT_OK(context, divider_develop(&p.left, &p.right, column, context, &film, &bytes, &light));
    check_pixels(alp_image_bytes(bytes), alp_image_bytes(p.left_bytes),
                 alp_image_bytes(p.right_bytes), white, column, sizeof white);
    check_pixels(alp_image_floats(light), alp_image_floats(p.left_light),
                 alp_image_floats(p.right_light), nothing, column, sizeof nothing);
    alp_image_destroy(bytes);
    alp_image_destroy(light);
    close_parts(&p);
    test_gl_check();
}

TEST_WITH_CONTEXT(parts_beside_a_divider_are_those_of_their_modes, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    check_divider(context, scene, 0.5, 20);
    check_divider(context, scene, 0.0, 0);
    check_divider(context, scene, 1.0, WIDTH - 1);
    alp_scene_destroy(scene);
}
