// SPDX-License-Identifier: MIT
// The shadow of the viewer's object in sunlight, in closed form: a ball above a floor, outside of
// the bounds of the scene.
#include "test_gl.h"

#include "picture.h"
#include "render/camera_rays.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/scene.h"

enum { WIDTH = 200, HEIGHT = 150, PIXELS = WIDTH * HEIGHT };

static const alp_render_object ball = {ALP_OBJECT_SPHERE, {0.2f, 2.0f, 0.1f}, 0.5f};

static alp_scene *build_floor(alp_context *context)
{
    const vec3 grey = {0.5f, 0.5f, 0.5f}, black = {0.0f, 0.0f, 0.0f};
    const vec3 corners[4] = {
        {-2.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 2.0f}, {2.0f, 0.0f, -2.0f}, {-2.0f, 0.0f, -2.0f}};
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "grey", grey, black));
    alpi_builder_quad(&b, corners);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static const alp_camera camera = {.position = {0.0f, 1.2f, 4.5f},
                                  .target = {0.0f, 0.3f, 0.0f},
                                  .up = {0.0f, 1.0f, 0.0f},
                                  .vertical_fov = 0.9f};

/// How far the way from the floor at a pixel to the sun passes the middle of the ball, in radii.
static float distance_of(const alpi_view *view, uint32_t pixel, vec3 to_sun)
{
    alpi_rays rays;
    alpi_rays_clear(&rays);
    view->loops->packet(view, pixel, 0, 0, &rays);
    const vec3 way = {rays.direction_x[0], rays.direction_y[0], rays.direction_z[0]};
    const vec3 place = vec3_add(view->origin, vec3_scale(way, -view->origin.y / way.y));
    const vec3 apart = vec3_cross(vec3_sub(vec3_load(ball.position), place), to_sun);
    return vec3_length(apart) / ball.radius;
}

TEST_WITH_CONTEXT(a_ball_above_the_bounds_shades_the_floor, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = build_floor(context);
    const alp_sun_options sun = {
        .azimuth = 0.5f, .elevation = 1.3f, .illuminance = 3.0f, .color = {1.0f, 1.0f, 1.0f}};
    const alp_lighting_options lighting = {.sun = sun};
    const drawing_options o = {.context = context,
                               .mode = test_gl_mode("direct"),
                               .lighting = &lighting,
                               .width = WIDTH,
                               .height = HEIGHT,
                               .object = ball,
                               .direct = true,
                               .level_zero = true};
    const vec3 to_sun = {sinf(sun.azimuth) * cosf(sun.elevation), sinf(sun.elevation),
                         cosf(sun.azimuth) * cosf(sun.elevation)};
    const float lit = 0.5f / 3.14159265f * 3.0f * sinf(sun.elevation);
    uint32_t triangles[PIXELS], dark = 0, bright = 0;
    drawing d;
    alp_image *light = NULL;
    alpi_view view;
    assert_int_equal(drawing_create(scene, &o, &d), EXIT_DONE);
    drawing_draw(&d, &camera);
    ASSERT_OK(context, picture_read_light(context, &d.targets, &light));
    picture_read_triangles(&d.targets, triangles);
    ASSERT_OK(context, alpi_view_place(context, &camera, WIDTH, HEIGHT, &view));
    view.centred = true;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float value = alp_image_floats(light)[4 * (size_t)i];
        if (triangles[i] >= scene->triangle_count) {
            continue; // the ball, or nothing
        }
        const float distance = distance_of(&view, i, to_sun);
        if (distance < 0.98f) {
            ASSERT_NEAR(value, 0.0, 1e-6);
            dark++;
        } else if (distance > 1.02f) {
            ASSERT_NEAR(value, lit, 1e-4);
            bright++;
        }
    }
    print_message("%u pixels in the shadow, %u outside\n", dark, bright);
    assert_true(dark > 100);
    assert_true(bright > 2000);
    test_gl_check();
    alp_image_destroy(light);
    drawing_destroy(&d);
    alp_scene_destroy(scene);
}
