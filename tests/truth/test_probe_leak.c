// SPDX-License-Identifier: MIT
// Light of probes that leaks through a thin wall: two closed rooms, one of them lit, and eight
// places of the wall against the lattice.
#include "test_scenes.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

enum { PLACES = 8, POINTS = 4096 };
static const float THICKNESS = 0.05f, SHELL = 0.2f, MARGIN = 0.05f;
static const vec3 HOUSE = {8.05f, 3.0f, 5.0f}; // inside of the outer walls

/// A wall across x in [wall, wall + THICKNESS] parts the house. All walls are closed solids.
static alp_scene *make_rooms(alp_context *context, float wall)
{
    const vec3 shell = {SHELL, SHELL, SHELL};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "rooms");
    const uint32_t paint =
        alpi_builder_material(&b, "paint", (vec3){0.6f, 0.6f, 0.6f}, (vec3){0.0f, 0.0f, 0.0f});
    alpi_builder_surface(&b, "outside", paint);
    alpi_builder_box(&b, vec3_scale(shell, -1.0f), vec3_add(HOUSE, shell), ALPI_FACE_ALL);
    alpi_builder_surface(&b, "lit", paint);
    alpi_builder_box(&b, (vec3){wall, HOUSE.y, HOUSE.z}, (vec3){0.0f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "dark", paint);
    alpi_builder_box(&b, HOUSE, (vec3){wall + THICKNESS, 0.0f, 0.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static float random_unit(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    return (float)((*state >> 9) + 0.5) * 0x1p-23f;
}

/// Points of a room, MARGIN from its walls, with normals of all directions.
static void scatter(vec3 low, vec3 high, float (*positions)[3], float (*normals)[3])
{
    uint32_t state = 1;
    for (int i = 0; i < POINTS; i++) {
        const float at[3] = {random_unit(&state), random_unit(&state), random_unit(&state)};
        positions[i][0] = low.x + MARGIN + at[0] * (high.x - low.x - 2.0f * MARGIN);
        positions[i][1] = low.y + MARGIN + at[1] * (high.y - low.y - 2.0f * MARGIN);
        positions[i][2] = low.z + MARGIN + at[2] * (high.z - low.z - 2.0f * MARGIN);
        const float z = 2.0f * random_unit(&state) - 1.0f, turn = 6.2831853f * random_unit(&state);
        const float flat = sqrtf(1.0f - z * z);
        normals[i][0] = flat * cosf(turn);
        normals[i][1] = flat * sinf(turn);
        normals[i][2] = z;
    }
}

typedef struct room_light {
    double mean, worst; // E at points of the room, and the largest
} room_light;

static room_light light_of(const alp_field *field, vec3 low, vec3 high)
{
    static float positions[POINTS][3], normals[POINTS][3], irradiance[POINTS][3];
    room_light light = {0.0, 0.0};
    scatter(low, high, positions, normals);
    alp_field_irradiance(field, POINTS, (const float(*)[3])positions, (const float(*)[3])normals,
                         irradiance);
    for (int i = 0; i < POINTS; i++) {
        light.mean += (double)irradiance[i][1] / POINTS;
        light.worst = fmax(light.worst, (double)irradiance[i][1]);
    }
    return light;
}

/// Light of the dark room over that of the lit one.
static room_light leak(const alp_probes *probes, alp_probe_lookup lookup, float wall)
{
    alp_field *field = NULL;
    assert_int_equal(alp_field_create_probes(probes, lookup, NULL, NULL, &field), ALP_OK);
    const room_light lit =
        light_of(field, (vec3){0.0f, 0.0f, 0.0f}, (vec3){wall, HOUSE.y, HOUSE.z});
    const room_light dark = light_of(field, (vec3){wall + THICKNESS, 0.0f, 0.0f}, HOUSE);
    alp_field_destroy(field);
    assert_true(lit.mean > 0.0);
    return (room_light){dark.mean / lit.mean, dark.worst / lit.mean};
}

static alp_probes *bake(alp_context *context, alp_scene *scene, float wall)
{
    alp_lamp lamp = alp_lamp_default();
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    lamp.intensity = 100.0f;
    lamp.position[0] = 0.5f * wall;
    lamp.position[1] = 0.7f * HOUSE.y;
    lamp.position[2] = 0.4f * HOUSE.z;
    o.lighting.lamps = &lamp;
    o.lighting.lamp_count = 1;
    o.spacing = 1.0f;
    o.atlas_size = 256;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    return probes;
}

// With a wall of 5 cm and probes 1 m apart, a hundredth of the lit room's light is the most.
TEST_SLOW_WITH_CONTEXT(a_thin_wall_leaks_no_light, 2)
{
    double worst = 0.0, worst_three = 0.0;
    for (int i = 0; i < PLACES; i++) {
        const float wall = 4.0f + (float)i / PLACES;
        alp_scene *scene = make_rooms(context, wall);
        alp_probes *probes = bake(context, scene, wall);
        const room_light ours = leak(probes, ALP_LOOKUP_OURS, wall);
        const room_light three = leak(probes, ALP_LOOKUP_THREE, wall);
        printf("leak: | %.3f | %.2f %% | %.0f %% | %.2f %% |\n", (double)wall, 100.0 * ours.mean,
               100.0 * ours.worst, 100.0 * three.mean);
        worst = fmax(worst, ours.mean);
        worst_three = fmax(worst_three, three.mean);
        alp_probes_destroy(probes);
        alp_scene_destroy(scene);
    }
    printf("accuracy: probes 1 m apart, a wall of 5 cm: light of a dark room over the lit one's, "
           "worst of 8 places: %.2f %%, three.js look-up %.1f %%\n",
           100.0 * worst, 100.0 * worst_three);
    assert_true(worst <= 0.01);
    assert_true(worst_three > worst);
}
