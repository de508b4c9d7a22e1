// SPDX-License-Identifier: MIT
// Ambient occlusion of the viewer where its value is known, and the light that it dims.
#include "test_gl.h"

#include "options/options.h"
#include "passes/pass_ssao.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 480, HEIGHT = 360, PIXELS = WIDTH * HEIGHT };

/// Results of the pass.
typedef struct found {
    float share[PIXELS];
    float seen[PIXELS][4]; // normal, and distance
    float positions[PIXELS][3];
} found;

static void add_quad(alpi_builder *b, const char *name, const vec3 corners[4])
{
    alpi_builder_surface(
        b, name,
        alpi_builder_material(b, name, (vec3){0.5f, 0.5f, 0.5f}, (vec3){0.0f, 0.0f, 0.0f}));
    alpi_builder_quad(b, corners);
}

/// A floor, y = 0, and a wall on it, x = 0, which is left of the camera.
static alp_scene *make_scene(alp_context *context, bool wall)
{
    static const vec3 floor[4] = {{0, 0, 5}, {10, 0, 5}, {10, 0, -5}, {0, 0, -5}};
    static const vec3 left[4] = {{0, 0, 5}, {0, 0, -5}, {0, 10, -5}, {0, 10, 5}};
    alpi_builder builder;
    alp_scene *scene = NULL;
    alpi_builder_start(&builder, context, "corner");
    add_quad(&builder, "floor", floor);
    if (wall) {
        add_quad(&builder, "wall", left);
    }
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}

static void place(const camera_view *view, found *f)
{
    for (size_t i = 0; i < PIXELS; i++) {
        const float x = 2.0f * ((float)(i % WIDTH) + 0.5f) / WIDTH - 1.0f;
        const float y = 1.0f - 2.0f * ((float)(i / WIDTH) + 0.5f) / HEIGHT;
        for (int k = 0; k < 3; k++) {
            f->positions[i][k] =
                view->origin[k] +
                f->seen[i][3] * (view->forward[k] + x * view->right[k] + y * view->up[k]);
        }
    }
}

/// Draws the pass from (4, 3, 0) towards (1, .5, 0).
static void find(const alp_scene *scene, float radius, found *f)
{
    const alp_camera camera = {.position = {4.0f, 3.0f, 0.0f},
                               .target = {1.0f, 0.5f, 0.0f},
                               .up = {0.0f, 1.0f, 0.0f},
                               .vertical_fov = 1.0f};
    const alp_scene_info info = alp_scene_get_info(scene);
    const camera_view view = camera_view_of(&camera, WIDTH, HEIGHT, &info);
    gl_targets targets;
    gl_scene drawn;
    pass_ssao pass;
    assert_int_equal(gl_targets_create(WIDTH, HEIGHT, &targets), EXIT_DONE);
    assert_int_equal(gl_scene_create(scene, true, false, &drawn), EXIT_DONE);
    assert_int_equal(pass_ssao_create(&targets, false, radius, &pass), EXIT_DONE);
    pass_ssao_draw(&pass, &drawn, &view, &targets);
    glGetTextureImage(pass.share, 0, GL_RED, GL_FLOAT, sizeof f->share, f->share);
    glGetTextureImage(pass.seen, 0, GL_RGBA, GL_FLOAT, sizeof f->seen, f->seen);
    place(&view, f);
    pass_ssao_destroy(&pass);
    gl_scene_destroy(&drawn);
    gl_targets_destroy(&targets);
    test_gl_check();
}

/// Mean share of a surface at distances from the edge.
/// @param up whether of the floor, else of the wall
static double mean_share(const found *f, bool up, double low, double high)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double from_edge = (double)f->positions[i][up ? 0 : 1];
        if (f->seen[i][3] > 0.0f && (f->seen[i][1] > 0.5f) == up && from_edge >= low &&
            from_edge < high) {
            sum += (double)f->share[i];
            count++;
        }
    }
    assert_true(count > 20);
    return sum / (double)count;
}

TEST_WITH_CONTEXT(an_open_plane_is_not_occluded, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = make_scene(context, false);
    found *f = malloc(sizeof *f);
    assert_non_null(f);
    find(scene, 1.0f, f);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(f->share[i] == 1.0f);
    }
    free(f);
    alp_scene_destroy(scene);
}

/// At height h over the floor, in radii, the pass leaves open 1 - mean over distances d in [0, 1]
/// of P(t cos a > h / d). The tangential part t of a direction has the density of the cosine, t^2
/// is even in [0, 1], and a is even. It is 1/2 at h = 0 and 1 from h = 1 on.
static double expected_share(double h)
{
    enum { STEPS = 200 };
    double behind = 0.0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double d = (i % STEPS + 0.5) / STEPS,
                     angle = M_PI * ((i / STEPS + 0.5) / STEPS - 0.5);
        const double least = h / (d * cos(angle)); // half of the angles point away
        behind += least < 1.0 ? 0.5 * (1.0 - least * least) : 0.0;
    }
    return 1.0 - behind / (STEPS * STEPS);
}

/// At the edge half the light comes from behind the wall. Farther than the radius none does.
TEST_WITH_CONTEXT(a_wall_takes_half_the_light_at_its_edge, 2)
{
    static const double radius = 1.2, heights[][2] = {{0.0, 0.04}, {0.3, 0.35}, {0.6, 0.65}};
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = make_scene(context, true);
    found *f = malloc(sizeof *f);
    assert_non_null(f);
    assert_true(fabs(expected_share(0.0) - 0.5) < 1e-12);
    find(scene, (float)radius, f);
    for (int i = 0; i < 6; i++) {
        const double *h = heights[i / 2];
        const double expected = expected_share(0.5 * (h[0] + h[1]) / radius);
        const double share = mean_share(f, i % 2 != 0, h[0], h[1]);
        if (!(fabs(share - expected) < 0.06)) {
            fail_msg("%s at %.2f m: %.3f instead of %.3f", i % 2 != 0 ? "floor" : "wall", h[0],
                     share, expected);
        }
    }
    for (int up = 0; up < 2; up++) {
        assert_true(mean_share(f, up != 0, 1.3 * radius, 1.8 * radius) == 1.0);
    }
    free(f);
    alp_scene_destroy(scene);
}

// --- the light of a picture ----------------------------------------------------------------------

/// The Cornell box by an even ambient light of irradiance 1, with a lamp or without.
/// @param choice of --with   @param share NULL, or out: [PIXELS] of the pass
static alp_image *draw(const alp_scene *scene, alp_context *context, int choice, bool direct,
                       bool occluded, float *share)
{
    command_line line = {.command = COMMAND_VIEW};
    alp_lighting_options lighting = alp_lighting_options_default();
    alp_lamp lamp = alp_lamp_default();
    lamp.position[0] = 0.3f;
    lamp.position[1] = 0.4f;
    lamp.intensity = 1.0f;
    lighting.lamps = &lamp;
    lighting.lamp_count = 1;
    line.values[OPTION_WITH].choice = choice;
    const drawing_options options = {.context = context,
                                     .mode = view_mode_of(&line),
                                     .lighting = &lighting,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .direct = direct,
                                     .level_zero = true,
                                     .ssao_radius = occluded ? 0.1f : 0.0f};
    alp_film_options film = alp_film_options_default();
    alp_ambient_options fit = alp_ambient_options_default();
    alp_field *field = NULL;
    alp_camera camera;
    alp_image *developed = NULL, *light = NULL;
    drawing d;
    assert_int_equal(drawing_create(scene, &options, &d), EXIT_DONE);
    fit.points = 16;
    fit.samples = 16;
    ASSERT_OK(context, alp_field_create_ambient(scene, &fit, &field));
    gl_ambient_create(field, &d.light.ambient);
    ASSERT_OK(context, alp_render_find_camera(scene, NULL, &camera));
    drawing_draw(&d, &camera);
    ASSERT_OK(context, drawing_develop(&d, context, &film, &developed, &light));
    if (share != NULL) {
        glGetTextureImage(d.ssao.share, 0, GL_RED, GL_FLOAT, PIXELS * sizeof *share, share);
    }
    alp_image_destroy(developed);
    alp_field_destroy(field);
    drawing_destroy(&d);
    test_gl_check();
    return light;
}

/// Light is emission + direct light + share of the pass * ambient light.
TEST_WITH_CONTEXT(occlusion_dims_ambient_light_alone, 2)
{
    enum { NONE = 0, CONSTANT = 4 }; // choices of --with
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    float *share = malloc(PIXELS * sizeof *share);
    double dimmed = 0.0, direct = 0.0;
    assert_non_null(share);
    alp_image *emission = draw(scene, context, NONE, false, true, NULL);
    alp_image *ambient = draw(scene, context, CONSTANT, false, false, NULL);
    alp_image *all = draw(scene, context, CONSTANT, true, false, NULL);
    alp_image *occluded = draw(scene, context, CONSTANT, true, true, share);
    for (size_t i = 0; i < (size_t)4 * PIXELS; i++) {
        const double e = (double)alp_image_floats(emission)[i];
        const double a = (double)alp_image_floats(ambient)[i] - e;
        const double expected = (double)alp_image_floats(all)[i] - (1.0 - (double)share[i / 4]) * a;
        if (i % 4 < 3) {
            ASSERT_NEAR(alp_image_floats(occluded)[i], expected, 1e-4 * (1.0 + expected));
            dimmed += (1.0 - (double)share[i / 4]) * a;
            direct += (1.0 - (double)share[i / 4]) * ((double)alp_image_floats(all)[i] - a - e);
        }
    }
    assert_true(dimmed > 0.0 && direct > 0.0);
    alp_image_destroy(emission);
    alp_image_destroy(ambient);
    alp_image_destroy(all);
    alp_image_destroy(occluded);
    free(share);
    alp_scene_destroy(scene);
}
