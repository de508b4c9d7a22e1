// SPDX-License-Identifier: MIT
// What is said of lamps inside things and of rooms that no sky looks into, and what is not.
#include "test_support.h"

#include "base/memory.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdlib.h>

static const vec3 GREY = {0.5f, 0.5f, 0.5f}, BLACK = {0.0f, 0.0f, 0.0f};

/// Surfaces: "room", a box of 4 m seen from inside, and "block", one of 1 m about (1.2, 0, 0) seen
/// from outside.
typedef struct setup {
    alp_context *context;
    alpi_builder builder;
    alp_scene *scene;
} setup;

static setup start_room(unsigned walls)
{
    setup s = {.context = test_context(1)};
    alpi_builder *b = &s.builder;
    alpi_builder_start(b, s.context, "test room");
    const uint32_t wall = alpi_builder_material(b, "wall", GREY, BLACK);
    alpi_builder_surface(b, "room", wall);
    alpi_builder_box(b, (vec3){2, 2, 2}, (vec3){-2, -2, -2}, walls);
    const uint32_t block = alpi_builder_material(b, "block", GREY, BLACK);
    alpi_builder_surface(b, "block", block);
    return s;
}

static void add_block(setup *s)
{
    alpi_builder_box(&s->builder, (vec3){0.7f, -0.5f, -0.5f}, (vec3){1.7f, 0.5f, 0.5f},
                     ALPI_FACE_ALL);
}

static alpi_material *block_material(const setup *s)
{
    return &s->scene->materials[1];
}

static void finish(setup *s)
{
    ASSERT_OK(s->context, alpi_builder_finish(&s->builder, &s->scene));
}

static void set_lights(const setup *s, const alpi_light *lights, uint32_t count)
{
    for (uint32_t i = 0; i < s->scene->light_count; i++) {
        alpi_release(s->context, s->scene->lights[i].name);
    }
    alpi_release(s->context, s->scene->lights);
    s->scene->lights = ALPI_NEW(s->context, alpi_light, count);
    assert_non_null(s->scene->lights);
    s->scene->light_count = count;
    for (uint32_t i = 0; i < count; i++) {
        s->scene->lights[i] = lights[i];
        s->scene->lights[i].name = alpi_copy_string(s->context, "lamp");
    }
}

static alpi_light lamp(float x, float y, float z)
{
    return (alpi_light){.kind = ALP_LIGHT_POINT,
                        .color = {1.0f, 1.0f, 1.0f},
                        .intensity = 1.0f,
                        .position = {x, y, z},
                        .range = INFINITY};
}

/// What is said with this one light, NULL = none, and no sky.
static const char *told(const setup *s, const alpi_light *light)
{
    set_lights(s, light, light != NULL ? 1 : 0);
    test_log_clear();
    ASSERT_OK(s->context, alp_scene_examine(s->scene, NULL, NULL, NULL));
    return test_log_text();
}

static void stop(setup *s)
{
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

TEST(lamps_in_the_open_are_fine)
{
    setup s = start_room(ALPI_FACE_ALL);
    add_block(&s);
    finish(&s);
    const vec3 places[] = {{0, 0, 0}, {0.6999f, 0, 0}, {1.9f, 1.9f, 1.9f}, {0, 1.99999f, 0}};
    for (int i = 0; i < 4; i++) {
        const alpi_light light = lamp(places[i].x, places[i].y, places[i].z);
        assert_string_equal(told(&s, &light), "");
    }
    stop(&s);
}

TEST(a_lamp_in_a_block_is_told)
{
    setup s = start_room(ALPI_FACE_ALL);
    add_block(&s);
    finish(&s);
    alpi_light light = lamp(1.2f, 0.1f, 0.0f);
    assert_non_null(strstr(told(&s, &light), "light-inside lamp: lies inside something"));
    assert_non_null(strstr(test_log_text(), "at 1.2 0.1 0 m"));
    assert_non_null(strstr(test_log_text(), "\"block\""));
    light.intensity = 0.0f; // off: then nothing gives light, and the room is closed
    assert_null(strstr(told(&s, &light), "light-inside"));
    assert_true(test_log_has("no-light") && test_log_has("closed-room"));
    stop(&s);
}

TEST(a_lamp_behind_the_walls_is_told)
{
    setup s = start_room(ALPI_FACE_ALL);
    finish(&s);
    const vec3 places[] = {{2.1f, 0, 0}, {0, -3, 0}, {500, 20, -7}};
    for (int i = 0; i < 3; i++) {
        alpi_light light = lamp(places[i].x, places[i].y, places[i].z);
        assert_non_null(strstr(told(&s, &light), "light-inside"));
        light.kind = ALP_LIGHT_DIRECTIONAL; // that has no place
        light.direction = (vec3){0, -1, 0};
        assert_null(strstr(told(&s, &light), "light-inside"));
    }
    stop(&s);
}

/// Only the rays in its cone count.
TEST(a_spot_is_judged_by_its_cone)
{
    setup s = start_room(ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    finish(&s);
    alpi_light spot = lamp(0.0f, -2.5f, 0.0f); // under the floor
    spot.kind = ALP_LIGHT_SPOT;
    spot.outer_cone = 0.5f;
    spot.direction = (vec3){0, 1, 0};
    assert_non_null(strstr(told(&s, &spot), "light-inside"));
    spot.position.y = 5.0f; // above the open top
    spot.direction = (vec3){0, -1, 0};
    assert_string_equal(told(&s, &spot), "");
    stop(&s);
}

/// What is beside its cone does not count: in a block without a lid, a spot that looks down.
TEST(a_spot_in_an_open_block)
{
    setup s = start_room(ALPI_FACE_ALL);
    alpi_builder_box(&s.builder, (vec3){0.7f, -0.5f, -0.5f}, (vec3){1.7f, 0.5f, 0.5f},
                     ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    finish(&s);
    alpi_light spot = lamp(1.2f, 0.4f, 0.0f);
    assert_string_equal(told(&s, &spot), ""); // a bare bulb there shines over the rim
    spot.kind = ALP_LIGHT_SPOT;
    spot.outer_cone = 0.7f;
    spot.direction = (vec3){0, -1, 0};
    assert_non_null(strstr(told(&s, &spot), "light-inside"));
    stop(&s);
}

/// Around a bulb: double-sided, blended, transmissive, or open at both ends.
TEST(bulbs_and_shades_are_fine)
{
    for (int kind = 0; kind < 5; kind++) {
        setup s = start_room(ALPI_FACE_ALL);
        if (kind < 4) {
            add_block(&s);
        } else {
            alpi_builder_box(&s.builder, (vec3){0.7f, -0.5f, -0.5f}, (vec3){1.7f, 0.5f, 0.5f},
                             ALPI_FACE_ALL & ~(unsigned)(ALPI_FACE_BOTTOM | ALPI_FACE_TOP));
        }
        finish(&s);
        alpi_material *m = block_material(&s);
        m->double_sided = kind == 1;
        m->alpha_mode = kind == 2 ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
        m->base_color[3] = kind == 2 ? 0.7f : 1.0f;
        m->transmission = kind == 3 ? 0.9f : 0.0f;
        const alpi_light light = lamp(1.2f, 0.0f, 0.0f);
        assert_int_equal(strstr(told(&s, &light), "light-inside") != NULL, kind == 0);
        assert_int_equal(test_log_text()[0] == '\0', kind != 0);
        stop(&s);
    }
}

/// Exactly in a surface: fine at the ceiling, whose back nobody sees, and told of a screen between
/// two halves of the room.
TEST(lamps_in_surfaces)
{
    setup s = start_room(ALPI_FACE_ALL);
    add_block(&s);
    finish(&s);
    const alpi_light ceiling = lamp(0.3f, 2.0f, 0.1f);
    assert_string_equal(told(&s, &ceiling), "");
    const alpi_light skin = lamp(0.7f, 0.0f, 0.1f); // of the block: its inside is not lit
    assert_string_equal(told(&s, &skin), "");
    stop(&s);
    s = start_room(ALPI_FACE_ALL);
    alpi_builder_quad(&s.builder,
                      (vec3[]){{-2, -2, 0.5f}, {2, -2, 0.5f}, {2, 2, 0.5f}, {-2, 2, 0.5f}});
    finish(&s);
    const alpi_light between = lamp(0.1f, 0.2f, 0.5f);
    assert_non_null(strstr(told(&s, &between), "light-on-surface lamp: lies in the surface "
                                               "\"block\", at 0.1 0.2 0.5 m"));
    const alpi_light before = lamp(0.1f, 0.2f, 0.51f);
    assert_string_equal(told(&s, &before), "");
    stop(&s);
}

TEST(many_lamps_are_counted)
{
    enum { COUNT = 1000 };
    setup s = start_room(ALPI_FACE_ALL);
    add_block(&s);
    finish(&s);
    alpi_light lights[COUNT];
    for (int i = 0; i < COUNT; i++) {
        lights[i] = i % 10 == 3 ? lamp(1.2f, 0.0f, 0.0f) : lamp(0.0f, 0.0f, 0.0f);
    }
    char *first = NULL;
    for (int run = 0; run < 2; run++) {
        set_lights(&s, lights, COUNT);
        test_log_clear();
        ASSERT_OK(s.context, alp_scene_examine(s.scene, NULL, NULL, NULL));
        uint32_t named = 0;
        for (const char *at = test_log_text(); (at = strstr(at, "lamp: lies")) != NULL; at++) {
            named++;
        }
        assert_int_equal(named, 8);
        assert_non_null(strstr(test_log_text(), "92 more lights")); // of 100
        if (run == 0) {
            first = strdup(test_log_text());
        } else {
            assert_string_equal(test_log_text(), first);
        }
    }
    free(first);
    stop(&s);
}

// --- the room ------------------------------------------------------------------------------------

static const char *told_with_sky(const setup *s)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sun.illuminance = 1000.0f;
    test_log_clear();
    ASSERT_OK(s->context, alp_scene_examine(s->scene, &o, NULL, NULL));
    return test_log_text();
}

TEST(closed_rooms_are_told)
{
    for (int closed = 0; closed <= 1; closed++) {
        setup s = start_room(ALPI_FACE_ALL & ~(unsigned)(closed ? 0 : ALPI_FACE_LEFT));
        add_block(&s);
        finish(&s);
        assert_int_equal(strstr(told_with_sky(&s), "closed-room test room: 100 %") != NULL, closed);
        assert_false(test_log_has("no-light"));
        stop(&s);
    }
}

/// The room but for a slot in its left wall, of `slot` of its 96 m².
static void add_slotted_wall(setup *s, float slot)
{
    const float top = 2.0f - slot * 96.0f / 4.0f;
    alpi_builder_quad(&s->builder,
                      (vec3[]){{-2, -2, -2}, {-2, top, -2}, {-2, top, 2}, {-2, -2, 2}});
}

TEST(a_window_of_a_hundredth_is_an_opening)
{
    // 1024 bounces from each point: the slot is missed by e^−10 of them, and by e^−0.01.
    const float slots[] = {0.01f, 1e-5f};
    for (int i = 0; i < 2; i++) {
        setup s = start_room(ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_LEFT);
        add_slotted_wall(&s, slots[i]);
        finish(&s);
        assert_int_equal(strstr(told_with_sky(&s), "closed-room") != NULL, i == 1);
        stop(&s);
    }
}

/// Walls with an outer side: half of what is seen is in a closed room, and all in the open with the
/// door out of both shells.
TEST(walls_may_be_thick)
{
    for (int door = 0; door <= 1; door++) {
        const unsigned faces = ALPI_FACE_ALL & ~(unsigned)(door ? ALPI_FACE_LEFT : 0);
        setup s = start_room(faces);
        alpi_builder_box(&s.builder, (vec3){-2.2f, -2.2f, -2.2f}, (vec3){2.2f, 2.2f, 2.2f}, faces);
        finish(&s);
        assert_int_equal(strstr(told_with_sky(&s), "closed-room") != NULL, !door);
        // 96 m² of 96 and 116.16
        assert_int_equal(strstr(test_log_text(), "45 % of the surface") != NULL, !door);
        stop(&s);
    }
}

/// What is hidden inside other solids is in no room: two blocks of one size in one place.
TEST(hidden_faces_are_no_room)
{
    setup s = {.context = test_context(1)};
    alpi_builder *b = &s.builder;
    alpi_builder_start(b, s.context, "blocks");
    alpi_builder_surface(b, "blocks", alpi_builder_material(b, "grey", GREY, BLACK));
    alpi_builder_box(b, (vec3){-1, -1, -1}, (vec3){1, 1, 1}, ALPI_FACE_ALL);
    alpi_builder_box(b, (vec3){-0.9f, -0.9f, -0.9f}, (vec3){0.9f, 0.9f, 0.9f}, ALPI_FACE_ALL);
    finish(&s);
    assert_string_equal(told_with_sky(&s), "");
    stop(&s);
}

/// A closed room with glass in it, and one with something that shines, are no fault.
TEST(closed_rooms_that_are_fine)
{
    for (int kind = 0; kind < 5; kind++) {
        setup s = start_room(ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_LEFT);
        alpi_builder_quad(&s.builder, (vec3[]){{-2, -2, -2}, {-2, 2, -2}, {-2, 2, 2}, {-2, -2, 2}});
        finish(&s);
        alpi_material *m = block_material(&s);
        m->transmission = kind == 1 ? 1.0f : 0.0f;
        m->alpha_mode = kind == 2 ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
        m->base_color[3] = kind == 2 ? 0.3f : 1.0f;
        m->emission[1] = kind == 3 ? 1.0f : 0.0f;
        const alpi_light light = lamp(0.0f, 0.0f, 0.0f);
        set_lights(&s, &light, kind == 4 ? 1 : 0);
        assert_int_equal(strstr(told_with_sky(&s), "closed-room") != NULL, kind == 0);
        stop(&s);
    }
}

// --- odd calls -----------------------------------------------------------------------------------

static bool refuse(void *user, const alp_progress *progress)
{
    (void)user;
    (void)progress;
    return false;
}

TEST_WITH_CONTEXT(odd_calls, 1)
{
    assert_int_equal(alp_scene_examine(NULL, NULL, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    setup s = start_room(ALPI_FACE_ALL);
    finish(&s);
    alp_lighting_options o = alp_lighting_options_default();
    o.sun.size = NAN;
    assert_int_equal(alp_scene_examine(s.scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    const alpi_light light = lamp(0, 0, 0);
    set_lights(&s, &light, 1);
    assert_int_equal(alp_scene_examine(s.scene, NULL, refuse, NULL), ALP_ERROR_CANCELLED);
    stop(&s);
    alpi_builder empty;
    alp_scene *scene = NULL;
    alpi_builder_start(&empty, context, "nothing");
    ASSERT_OK(context, alpi_builder_finish(&empty, &scene));
    test_log_clear();
    ASSERT_OK(context, alp_scene_examine(scene, NULL, NULL, NULL));
    assert_true(test_log_has("no-light"));
    assert_false(test_log_has("closed-room"));
    alp_scene_destroy(scene);
}

TEST(memory_may_end)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    setup s = {.context = context};
    alpi_builder_start(&s.builder, context, "room");
    alpi_builder_surface(&s.builder, "room",
                         alpi_builder_material(&s.builder, "wall", GREY, BLACK));
    alpi_builder_box(&s.builder, (vec3){2, 2, 2}, (vec3){-2, -2, -2}, ALPI_FACE_ALL);
    finish(&s);
    const int plenty = left;
    int failures = 0;
    for (left = 0; alp_scene_examine(s.scene, NULL, NULL, NULL) != ALP_OK; left = failures) {
        failures++;
        assert_true(failures < 100);
    }
    assert_true(failures > 2);
    left = plenty;
    stop(&s);
}
