// SPDX-License-Identifier: MIT
// The object of the viewer: as render shows it, as a part of the scene, and where it has moved.
#include "test_gl.h"

#include "options/options.h"
#include "picture.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/scene.h"
#include "shaders/bindings.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

// --- as render -----------------------------------------------------------------------------------

/// Compares pixels that see the object alike.
static void compare_object(const char *name, test_pair *pair)
{
    size_t seen = 0, alike = 0;
    for (size_t i = 0; i < (size_t)pair->width * pair->height; i++) {
        pair->alike[i] = pair->alike[i] && pair->on_object[i];
        seen += pair->on_object[i] ? 1 : 0;
        alike += pair->alike[i] ? 1 : 0;
    }
    const double equal = test_pair_equal_share(pair);
    print_message("%s: %zu pixels, %zu alike, %.4f equal\n", name, seen, alike, equal);
    if (!(seen > 1000 && 3 * alike > 2 * seen && equal >= 0.97)) {
        fail_msg("%s: %zu pixels show the object, %zu alike, and %.4f of these are equal", name,
                 seen, alike, equal);
    }
    test_pair_destroy(pair);
}

static alp_render_options room_picture(alp_object_kind kind, const alp_field *field)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_FIELD;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.without_direct = true;
    o.field = field;
    o.object = (alp_render_object){kind, {-0.3f, 1.2f, 0.3f}, 0.35f};
    return o;
}

static void check_field(const char *name, const alp_scene *scene, const alp_render_options *o,
                        GLint read)
{
    mode_light light = {0};
    assert_int_equal(gl_field_create(scene, read, o->width, o->height, &light.field), EXIT_DONE);
    light.field.workers = 2;
    gl_field_set(&light.field, o->field);
    test_pair pair = test_gl_pair_in("probes", light, scene, o);
    compare_object(name, &pair);
}

TEST_WITH_CONTEXT(an_object_reads_probes_as_in_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    const alp_scene_info info = alp_scene_get_info(scene);
    alp_probe_options bake = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    bake.spacing = 0.5f;
    bake.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    bake.atlas_size = 128;
    bake.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &bake, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, info.origin, NULL, &field));
    const alp_render_options sphere = room_picture(ALP_OBJECT_SPHERE, field);
    const alp_render_options teapot = room_picture(ALP_OBJECT_TEAPOT, field);
    check_field("sphere at pixels", scene, &sphere, READ_PIXEL);
    check_field("teapot at pixels", scene, &teapot, READ_PIXEL);
    mode_light light = {0};
    assert_int_equal(gl_field_create(scene, READ_PIXEL, WIDTH, HEIGHT, &light.field), EXIT_DONE);
    gl_field_set_probes(&light.field, probes, info.origin);
    test_pair pair = test_gl_pair_in("probes", light, scene, &teapot);
    compare_object("teapot in the shader", &pair);
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

static alp_field *fit(alp_context *context, const alp_scene *scene, alp_ambient_model model)
{
    alp_ambient_options o = alp_ambient_options_default();
    alp_field *field = NULL;
    o.model = model;
    o.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.lighting.sky.up[0] = 3.0f;
    o.points = 64;
    o.samples = 64;
    ASSERT_OK(context, alp_field_create_ambient(scene, &o, &field));
    return field;
}

/// Light of nine coefficients, the same everywhere: one look-up is exact.
TEST_WITH_CONTEXT(an_object_reads_even_light_as_in_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_field *field = fit(context, scene, ALP_AMBIENT_ENVIRONMENT);
    const alp_render_options teapot = room_picture(ALP_OBJECT_TEAPOT, field);
    check_field("teapot at its middle", scene, &teapot, READ_OBJECT);
    test_pair pair = test_gl_pair(scene, &teapot);
    compare_object("teapot by the model", &pair);
    alp_field_destroy(field);
    alp_scene_destroy(scene);
}

/// Light that changes evenly with the height of the normal: little is lost between vertices.
TEST_WITH_CONTEXT(an_object_reads_vertices_as_in_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_field *field = fit(context, scene, ALP_AMBIENT_HEMISPHERE);
    const alp_render_options sphere = room_picture(ALP_OBJECT_SPHERE, field);
    check_field("sphere at vertices", scene, &sphere, READ_VERTEX);
    alp_field_destroy(field);
    alp_scene_destroy(scene);
}

// --- as a part of the scene ----------------------------------------------------------------------

static const alp_render_object ball = {ALP_OBJECT_SPHERE, {0.3f, 0.6f, -0.2f}, 0.4f};

/// A room of 4 × 2 × 3 m without a front wall.
/// @param whole with the ball as its last surface, of the triangles that the object has
static alp_scene *build_room(alp_context *context, bool whole)
{
    const vec3 red = {0.7f, 0.3f, 0.2f}, white = {0.8f, 0.8f, 0.8f}, black = {0.0f, 0.0f, 0.0f};
    alp_scene *scene = NULL;
    alpi_builder b;
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "room", alpi_builder_material(&b, "red", red, black));
    alpi_builder_box(&b, (vec3){2.0f, 2.0f, 1.5f}, (vec3){-2.0f, 0.0f, -1.5f},
                     ALPI_FACE_ALL & ~ALPI_FACE_FRONT & ~ALPI_FACE_BACK);
    const vec3 wall[4] = {
        {-2.0f, 0.0f, -1.5f}, {2.0f, 0.0f, -1.5f}, {2.0f, 2.0f, -1.5f}, {-2.0f, 2.0f, -1.5f}};
    alpi_builder_quad(&b, wall);
    if (whole) {
        alpi_builder_surface(&b, "object", alpi_builder_material(&b, "white", white, black));
        alpi_builder_ball(&b, &(alpi_ball){.center = vec3_load(ball.position),
                                           .radius = ball.radius,
                                           .top = ball.radius,
                                           .slices = 96,
                                           .stacks = 48});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// A picture of a room.
typedef struct room_view {
    const char *mode;
    const alp_field *field; // of probes
    GLint read;
    bool volume;    // of lpv
    bool whole;     // the ball is a part of the room
    bool from_afar; // the object begins elsewhere and is moved
    alp_lamp lamp;
} room_view;

typedef struct room_picture_data {
    uint32_t triangles[PIXELS];
    alp_image *light; // float RGBA
} room_picture_data;

static mode_light make_light(const alp_scene *scene, const room_view *v)
{
    mode_light light = {0};
    if (v->volume) {
        alp_lpv_options o = alp_lpv_options_default();
        alp_lpv_scene_options frame = alp_lpv_scene_options_default();
        int code = EXIT_FAILED;
        o.cascades = 1;
        o.cell = 0.25;
        o.centre[1] = 1.0;
        o.blockers = true;
        o.iterations = 12;
        frame.points = 0;
        light.lpv = malloc(sizeof *light.lpv);
        assert_non_null(light.lpv);
        ASSERT_OK(scene->context, lpv_frame_create(scene, &o, &frame, &code, light.lpv));
        assert_int_equal(code, EXIT_DONE);
    }
    if (v->volume || v->field != NULL) {
        assert_int_equal(gl_field_create(scene, v->read, WIDTH, HEIGHT, &light.field), EXIT_DONE);
        light.field.workers = 2;
    }
    if (v->volume) {
        gl_field_set_volume(&light.field, &light.lpv->volume, false);
    } else if (v->field != NULL) {
        gl_field_set(&light.field, v->field);
    }
    return light;
}

static void draw_room(alp_context *context, const room_view *v, room_picture_data *out)
{
    alp_scene *scene = build_room(context, v->whole);
    const alp_lighting_options lighting = {.lamps = &v->lamp, .lamp_count = 1};
    drawing_options o = {.context = context,
                         .mode = test_gl_mode(v->mode),
                         .light = make_light(scene, v),
                         .lighting = &lighting,
                         .width = WIDTH,
                         .height = HEIGHT,
                         .direct = !v->volume,
                         .level_zero = true};
    const alp_camera camera = {.position = {-0.5f, 1.2f, 3.0f},
                               .target = {0.0f, 0.8f, 0.0f},
                               .up = {0.0f, 1.0f, 0.0f},
                               .vertical_fov = 0.8f};
    drawing d;
    if (!v->whole) {
        o.object = ball;
        o.object.position[0] -= v->from_afar ? 1.0f : 0.0f;
    }
    assert_int_equal(drawing_create(scene, &o, &d), EXIT_DONE);
    if (v->from_afar) {
        drawing_draw(&d, &camera);
        assert_int_equal(drawing_move_object(&d, context, ball.position), EXIT_DONE);
    }
    drawing_draw(&d, &camera);
    ASSERT_OK(context, picture_read_light(context, &d.targets, &out->light));
    picture_read_triangles(&d.targets, out->triangles);
    test_gl_check();
    drawing_destroy(&d);
    alp_scene_destroy(scene);
}

/// Whether the light of two pixels differs by less than a thousandth of white.
static bool is_equal(const float *a, const float *b)
{
    bool equal = true;
    for (int k = 0; k < 3; k++) {
        equal = equal && fabsf(a[k] - b[k]) <= 1e-3f * fmaxf(1.0f, fabsf(b[k]));
    }
    return equal;
}

/// Draws the room with the ball in it, and the ball beside it.
static void check_room(alp_context *context, const char *name, room_view v)
{
    room_picture_data *parts = calloc(2, sizeof *parts);
    uint32_t same = 0, equal = 0;
    assert_non_null(parts);
    draw_room(context, &v, &parts[0]);
    v.whole = true;
    v.from_afar = false;
    draw_room(context, &v, &parts[1]);
    const float *a = alp_image_floats(parts[0].light), *b = alp_image_floats(parts[1].light);
    for (uint32_t i = 0; i < PIXELS; i++) {
        same += parts[0].triangles[i] == parts[1].triangles[i] ? 1 : 0;
        equal += is_equal(a + 4 * (size_t)i, b + 4 * (size_t)i) ? 1 : 0;
    }
    print_message("%s: %.4f see the same, %.4f equal\n", name, (double)same / PIXELS,
                  (double)equal / PIXELS);
    if (!(same >= 0.999 * PIXELS && equal >= 0.999 * PIXELS)) {
        fail_msg("%s: %u of %d pixels see the same, and %u are equal", name, same, PIXELS, equal);
    }
    alp_image_destroy(parts[0].light);
    alp_image_destroy(parts[1].light);
    free(parts);
}

static alp_lamp lamp_above(void)
{
    return (alp_lamp){.kind = ALP_LIGHT_POINT,
                      .color = {1.0f, 1.0f, 1.0f},
                      .intensity = 3.0f,
                      .position = {0.6f, 1.8f, 0.2f}};
}

TEST_WITH_CONTEXT(an_object_casts_the_shadow_of_a_part_of_the_scene, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    room_view v = {.mode = "direct", .lamp = lamp_above()};
    check_room(context, "direct", v);
    v.from_afar = true;
    check_room(context, "direct, moved", v);
}

TEST_WITH_CONTEXT(an_object_lights_a_volume_as_a_part_of_the_scene, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    room_view v = {.mode = "lpv", .read = READ_PIXEL, .volume = true, .lamp = lamp_above()};
    check_room(context, "lpv", v);
    v.from_afar = true;
    check_room(context, "lpv, moved", v);
}

TEST_WITH_CONTEXT(an_object_that_moved_reads_the_field_where_it_is, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    static const char *const names[] = {"pixel, moved", "vertex, moved", "object, moved"};
    alp_scene *scene = build_room(context, false);
    const alp_lamp lamp = lamp_above();
    alp_probe_options bake = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    bake.spacing = 0.5f;
    bake.lighting.lamps = &lamp;
    bake.lighting.lamp_count = 1;
    bake.atlas_size = 128;
    bake.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &bake, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS,
                                               alp_scene_get_info(scene).origin, NULL, &field));
    for (GLint read = READ_PIXEL; read <= READ_OBJECT; read++) {
        check_room(
            context, names[read],
            (room_view){
                .mode = "probes", .field = field, .read = read, .from_afar = true, .lamp = lamp});
    }
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}
