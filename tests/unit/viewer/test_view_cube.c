// SPDX-License-Identifier: MIT
// Cube maps of the viewer against radiance that is known, and their projection against the
// library's.
#include "test_gl.h"

#include "gl/gl_cube.h"

#include <alpenglow/sh.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Fills faces with noise, or with one value.
static void fill(const gl_cube *cube, bool noise)
{
    const size_t count = (size_t)6 * cube->side * cube->side;
    float(*pixels)[4] = malloc(count * sizeof *pixels);
    assert_non_null(pixels);
    uint32_t state = 1;
    for (size_t i = 0; i < 4 * count; i++) {
        state = state * 1664525u + 1013904223u;
        pixels[i / 4][i % 4] = noise ? (float)(state >> 8) * 0x1p-24f : 1.0f;
    }
    glTextureSubImage3D(cube->faces, 0, 0, 0, 0, (GLsizei)cube->side, (GLsizei)cube->side, 6,
                        GL_RGBA, GL_FLOAT, pixels);
    free(pixels);
}

/// The library's projection of the same faces.
static alp_sh9 project(alp_context *context, const gl_cube *cube)
{
    const size_t face = (size_t)cube->side * cube->side;
    float(*pixels)[4] = malloc(6 * face * sizeof *pixels);
    float(*light)[3] = malloc(6 * face * sizeof *light);
    const float *faces[6];
    alp_sh_projection *projection = NULL;
    alp_sh9 radiance;
    assert_non_null(pixels);
    assert_non_null(light);
    glGetTextureImage(cube->faces, 0, GL_RGBA, GL_FLOAT, (GLsizei)(6 * face * sizeof *pixels),
                      pixels);
    for (size_t i = 0; i < 3 * 6 * face; i++) {
        light[i / 3][i % 3] = pixels[i / 3][3] * pixels[i / 3][i % 3];
    }
    for (size_t i = 0; i < 6; i++) {
        faces[i] = light[i * face];
    }
    ASSERT_OK(context, alp_sh_projection_create(context, cube->side, &projection));
    ASSERT_OK(context, alp_sh_project_cube(projection, faces, &radiance));
    alp_sh_projection_destroy(projection);
    free(light);
    free(pixels);
    return radiance;
}

/// @param part of the largest coefficient
static void check_equal(const alp_sh9 *a, const alp_sh9 *b, double part)
{
    double largest = 0.0, difference = 0.0;
    for (int i = 0; i < 27; i++) {
        largest = fmax(largest, fabs((double)b->c[i / 3][i % 3]));
        difference =
            fmax(difference, fabs((double)a->c[i / 3][i % 3] - (double)b->c[i / 3][i % 3]));
    }
    if (!(difference <= part * largest)) {
        fail_msg("a coefficient differs by %.3g of the largest", difference / largest);
    }
}

/// The same faces twice give the same bits, and the library's coefficients.
static void check_projection(alp_context *context, uint32_t side, bool noise, double part)
{
    gl_cube cube;
    alp_sh9 first, second;
    assert_int_equal(gl_cube_create(side, &cube), EXIT_DONE);
    fill(&cube, noise);
    gl_cube_project(&cube, &first);
    gl_cube_project(&cube, &second);
    assert_memory_equal(&first, &second, sizeof first);
    const alp_sh9 expected = project(context, &cube);
    check_equal(&first, &expected, part);
    gl_cube_destroy(&cube);
    test_gl_check();
}

TEST_WITH_CONTEXT(projections_of_noise_are_those_of_the_library, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    check_projection(context, 256, true, 1e-6);
    check_projection(context, 8, true, 1e-5);
    check_projection(context, 13, true, 2e-6); // rows and lanes that are left over
}

TEST(projections_of_one_value_are_twice_the_root_of_pi)
{
    if (!test_gl_open()) {
        skip();
    }
    gl_cube cube;
    alp_sh9 drawn, expected = {.c = {{0.0f}}};
    assert_int_equal(gl_cube_create(128, &cube), EXIT_DONE);
    fill(&cube, false);
    gl_cube_project(&cube, &drawn);
    for (int k = 0; k < 3; k++) {
        expected.c[0][k] = (float)(2.0 * sqrt(M_PI));
    }
    check_equal(&drawn, &expected, 1e-6);
    gl_cube_destroy(&cube);
    test_gl_check();
}

// --- drawn cubes ---------------------------------------------------------------------------------

enum { SIDE = 64 };

/// Draws the cube of a mode.
static void capture(const alp_scene *scene, const drawing_options *options, const float point[3],
                    gl_cube *cube)
{
    drawing d;
    assert_int_equal(drawing_create(scene, options, &d), EXIT_DONE);
    assert_int_equal(gl_cube_create(SIDE, cube), EXIT_DONE);
    gl_cube_draw(cube, &d, point);
    test_gl_check();
    drawing_destroy(&d);
}

static const view_mode *mode_of(int choice)
{
    command_line line = {.command = COMMAND_VIEW};
    line.values[OPTION_WITH].choice = choice;
    return view_mode_of(&line);
}

TEST_WITH_CONTEXT(faces_see_the_sky_in_their_directions, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_lighting_options lighting = alp_lighting_options_default();
    lighting.sky.kind = ALP_SKY_HEMISPHERE;
    for (int k = 0; k < 3; k++) {
        lighting.sky.up[k] = (float)(k + 1);
        lighting.sky.down[k] = 0.25f;
    }
    lighting.sky.strength = 1.0f;
    const drawing_options options = {.context = context,
                                     .mode = mode_of(0),
                                     .lighting = &lighting,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .level_zero = true};
    const float point[3] = {0.0f, 100.0f, 300.0f}; // the box is a pixel there
    gl_cube cube;
    alp_sh9 drawn, expected = {.c = {{0.0f}}};
    capture(scene, &options, point, &cube);
    gl_cube_project(&cube, &drawn);
    alp_sh_add_hemisphere(&expected, (const float[3]){0.0f, 1.0f, 0.0f}, lighting.sky.up,
                          lighting.sky.down);
    check_equal(&drawn, &expected, 2e-3);
    gl_cube_destroy(&cube);
    alp_scene_destroy(scene);
}

/// Backs of single-sided surfaces send no light, and fronts send theirs.
TEST_WITH_CONTEXT(faces_see_fronts_of_surfaces, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_lighting_options lighting = alp_lighting_options_default();
    const drawing_options options = {.context = context,
                                     .mode = mode_of(0),
                                     .lighting = &lighting,
                                     .width = SIDE,
                                     .height = SIDE,
                                     .level_zero = true};
    const float point[3] = {0.28f, 0.4f, 0.28f};
    gl_cube cube;
    alp_sh9 drawn;
    capture(scene, &options, point, &cube);
    gl_cube_project(&cube, &drawn);
    gl_cube_destroy(&cube);
    alp_scene_destroy(scene);
    assert_true(drawn.c[0][0] > 0.0f && drawn.c[1][0] > 0.0f); // the lamp is above
}

/// Albedos that rays find from the middle of the Cornell box, in the direction of each texel.
TEST_WITH_CONTEXT(faces_see_the_walls_of_render, 2)
{
    static const float axes[6][2][3] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}},
                                        {{0, 1, 0}, {0, 0, -1}}, {{0, -1, 0}, {0, 0, 1}},
                                        {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
    const float point[3] = {0.28f, 0.4f, 0.28f};
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    const drawing_options options = {
        .context = context, .mode = mode_of(1), .width = SIDE, .height = SIDE, .level_zero = true};
    gl_cube cube;
    float(*pixels)[SIDE][SIDE][4] = malloc(6 * sizeof *pixels);
    uint32_t equal = 0;
    assert_non_null(pixels);
    capture(scene, &options, point, &cube);
    glGetTextureImage(cube.faces, 0, GL_RGBA, GL_FLOAT, (GLsizei)(6 * sizeof *pixels), pixels);
    for (int face = 0; face < 6; face++) {
        alp_render_options o = alp_render_options_default();
        alp_image *image = NULL;
        o.method = ALP_RENDER_ALBEDO;
        o.width = o.height = SIDE;
        o.samples = 1;
        o.camera.vertical_fov = (float)(0.5 * M_PI);
        for (int k = 0; k < 3; k++) {
            o.camera.position[k] = point[k];
            o.camera.target[k] = point[k] + axes[face][0][k];
            o.camera.up[k] = axes[face][1][k];
        }
        ASSERT_OK(context, alp_render(scene, &o, &image));
        const float *rendered = alp_image_floats(image);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t mirrored = SIDE - 1 - i % SIDE;
            const float *drawn = pixels[face][i / SIDE][mirrored];
            equal += fabsf(drawn[0] - rendered[(size_t)4 * i]) < 1e-5f &&
                     fabsf(drawn[1] - rendered[(size_t)4 * i + 1]) < 1e-5f;
        }
        alp_image_destroy(image);
    }
    free(pixels);
    gl_cube_destroy(&cube);
    alp_scene_destroy(scene);
    if (equal < 6 * SIDE * SIDE * 98 / 100) {
        fail_msg("%u of %d texels are those of render", equal, 6 * SIDE * SIDE);
    }
}
