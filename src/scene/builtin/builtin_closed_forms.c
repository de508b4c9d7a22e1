// SPDX-License-Identifier: MIT
// Built-in scenes whose light or occlusion is known exactly.
#include "scene/builtin/builtin.h"

static const vec3 NO_EMISSION = {0.0f, 0.0f, 0.0f};
static const float HALF_SIDE = 2.0f; // of the ground planes

void alpi_builtin_furnace(alpi_builder *builder)
{
    uint32_t glowing = alpi_builder_material(builder, "glowing grey", (vec3){0.5f, 0.5f, 0.5f},
                                             (vec3){1.0f, 1.0f, 1.0f});
    alpi_builder_surface(builder, "furnace", glowing);
    alpi_builder_box(builder, (vec3){1.0f, 1.0f, 1.0f}, (vec3){0.0f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    alpi_builder_camera(builder, (vec3){0.85f, 0.7f, 0.9f}, (vec3){0.3f, 0.35f, 0.2f}, 1.2f);
}

void alpi_builtin_bowl(alpi_builder *builder)
{
    uint32_t clay = alpi_builder_material(builder, "clay", (vec3){0.7f, 0.6f, 0.5f}, NO_EMISSION);
    alpi_builder_surface(builder, "bowl", clay);
    // 88 stacks from the pole to the rim at 120°, one of them at the equator. Such facets change
    // the openness by .003 at most.
    alpi_builder_ball(
        builder,
        &(alpi_ball){.radius = 1.0f, .top = 0.5f, .slices = 256, .stacks = 88, .inside = true});
    alpi_builder_camera(builder, (vec3){0.0f, 2.9f, 1.3f}, (vec3){0.0f, -0.2f, 0.0f}, 0.7f);
}

static void build_ground(alpi_builder *builder)
{
    uint32_t ground =
        alpi_builder_material(builder, "ground", (vec3){0.6f, 0.6f, 0.6f}, NO_EMISSION);
    alpi_builder_surface(builder, "ground", ground);
    const float s = HALF_SIDE;
    alpi_builder_quad(builder,
                      (const vec3[4]){{-s, 0.0f, s}, {s, 0.0f, s}, {s, 0.0f, -s}, {-s, 0.0f, -s}});
}

void alpi_builtin_sphere_plane(alpi_builder *builder)
{
    build_ground(builder);
    uint32_t red = alpi_builder_material(builder, "red", (vec3){0.6f, 0.25f, 0.2f}, NO_EMISSION);
    alpi_builder_surface(builder, "sphere", red);
    alpi_builder_ball(builder, &(alpi_ball){.center = {0.0f, 0.5f, 0.0f},
                                            .radius = 0.5f,
                                            .top = 0.5f,
                                            .slices = 128,
                                            .stacks = 64});
    alpi_builder_camera(builder, (vec3){1.5f, 1.3f, 2.2f}, (vec3){0.0f, 0.35f, 0.0f}, 0.7f);
}

void alpi_builtin_torus_plane(alpi_builder *builder)
{
    build_ground(builder);
    uint32_t blue = alpi_builder_material(builder, "blue", (vec3){0.25f, 0.4f, 0.6f}, NO_EMISSION);
    alpi_builder_surface(builder, "torus", blue);
    alpi_builder_ring(builder, &(alpi_ring){.center = {0.0f, 0.25f, 0.0f},
                                            .major_radius = 0.6f,
                                            .minor_radius = 0.25f,
                                            .slices = 128,
                                            .sides = 64});
    alpi_builder_camera(builder, (vec3){1.4f, 1.7f, 2.3f}, (vec3){0.0f, 0.15f, 0.0f}, 0.75f);
}
