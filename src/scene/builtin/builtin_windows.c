// SPDX-License-Identifier: MIT
// A room with three windows, two pillars and three alcoves, lit by a small bright sun outside in
// the dark: what Hugo Elias lights in "Radiosity", patch by patch. Inside, 8 m × 4 m × 6 m about
// the z axis, floor at y = 0; walls 0.35 m thick, 0.75 m where the alcoves are. Windows of
// 1.2 m × 2 m, sills at 1 m.
//
// The sun is a ball of radius 0.2 m, 15 m from the middle of the floor, 33° above the horizon and
// 25° to the left of the windows' axis: 1.5° wide, π (0.2/15)² = 5.6e-4 sr. Its radiance of (30000,
// 27000, 22000) W·sr⁻¹·m⁻² gives (16.8, 15.1, 12.3) W·m⁻² on a face that looks at it there.
#include "scene/builtin/builtin.h"
#include "scene/builtin/shapes.h"

static const vec3 DARK = {0.0f, 0.0f, 0.0f};
static const vec3 SUN_EMISSION = {30000.0f, 27000.0f, 22000.0f};
static const float SUN_RADIUS = 0.2f, SUN_DISTANCE = 15.0f;
static const float SUN_ELEVATION = 33.0f, SUN_TURN = 25.0f; // degrees

/// Planes of the walls: outer, alcove and inner faces, openings between.
static const float X[] = {-4.75f, -4.45f, -4.0f, -3.2f, -2.0f, -0.6f,
                          0.6f,   2.0f,   3.2f,  4.0f,  4.45f, 4.75f};
static const float Y[] = {0.0f, 0.5f, 1.0f, 2.6f, 3.0f, 4.0f};
static const float Z[] = {-3.35f, -3.0f, -1.9f, -0.5f, 0.6f, 2.0f, 3.0f, 3.35f};
enum {
    X_COUNT = sizeof X / sizeof *X,
    Y_COUNT = sizeof Y / sizeof *Y,
    Z_COUNT = sizeof Z / sizeof *Z,
    X_INNER = 2,
    X_END = X_COUNT - 4, // last cell inside
    Z_END = Z_COUNT - 3,
};

/// Windows in the wall at −z; two alcoves in the wall at −x, one at +x, from 0.5 m to 2.6 m.
static bool wall_is_solid(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    (void)user;
    bool inside = x >= X_INNER && x <= X_END && z >= 1 && z <= Z_END;
    bool window = z == 0 && (x == 3 || x == 5 || x == 7) && (y == 2 || y == 3);
    bool alcove_height = y == 1 || y == 2;
    bool left_alcove = x == 1 && (z == 2 || z == 4) && alcove_height;
    bool right_alcove = x == X_END + 1 && z == 4 && (alcove_height || y == 0);
    return !inside && !window && !left_alcove && !right_alcove;
}

static void build_shell(alpi_shaper *shaper, uint32_t plaster, uint32_t oak, uint32_t white)
{
    const vec3 low = {X[0], -0.2f, Z[0]}, high = {X[X_COUNT - 1], 4.25f, Z[Z_COUNT - 1]};
    alpi_shaper_surface(shaper, "floor", oak);
    alpi_shape_box(shaper, low, (vec3){high.x, 0.0f, high.z});
    alpi_shaper_surface(shaper, "walls", plaster);
    alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {X, Y, Z},
                                             .counts = {X_COUNT, Y_COUNT, Z_COUNT},
                                             .solid = wall_is_solid,
                                             .edge = HUGE_VALF});
    alpi_shaper_surface(shaper, "ceiling", white);
    alpi_shape_box(shaper, (vec3){low.x, Y[Y_COUNT - 1], low.z}, high);
}

/// Bars every other cell.
static bool frame_is_solid(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    (void)user;
    (void)z;
    return x % 2 == 0 || y % 2 == 0;
}

/// A frame of 2 × 3 panes without glass, and a board on the sill, in each window.
static void build_windows(alpi_shaper *shaper, uint32_t white)
{
    static const float across[] = {-0.6f, -0.54f, -0.02f, 0.02f, 0.54f, 0.6f};
    static const float up[] = {1.04f, 1.1f, 1.68f, 1.72f, 2.3f, 2.34f, 2.94f, 3.0f};
    static const float through[] = {-3.25f, -3.19f};
    alpi_shaper_surface(shaper, "window frames", white);
    for (int i = 0; i < 3; i++) {
        const float middle = -2.6f + 2.6f * (float)i;
        alpi_shaper_place(shaper, (vec3){middle, 0.0f, 0.0f}, 0.0);
        alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {across, up, through},
                                                 .counts = {6, 8, 2},
                                                 .solid = frame_is_solid,
                                                 .edge = HUGE_VALF});
    }
    alpi_shaper_surface(shaper, "sills", white);
    for (int i = 0; i < 3; i++) {
        alpi_shaper_place(shaper, (vec3){-2.6f + 2.6f * (float)i, 0.0f, 0.0f}, 0.0);
        alpi_shape_box(shaper, (vec3){-0.6f, 1.0f, -3.3f}, (vec3){0.6f, 1.04f, -2.94f});
    }
    alpi_shaper_place(shaper, DARK, 0.0);
}

/// A square shaft that reaches into a plinth and a cap.
static void build_pillars(alpi_shaper *shaper, uint32_t stone)
{
    alpi_shaper_surface(shaper, "pillars", stone);
    for (int i = 0; i < 2; i++) {
        alpi_shaper_place(shaper, (vec3){i == 0 ? -1.5f : 1.5f, 0.0f, 0.2f}, 0.0);
        alpi_shape_bevelled_box(shaper, (vec3){-0.36f, 0.0f, -0.36f}, (vec3){0.36f, 0.3f, 0.36f},
                                0.03f);
        alpi_shape_bevelled_box(shaper, (vec3){-0.28f, 0.2f, -0.28f}, (vec3){0.28f, 3.8f, 0.28f},
                                0.04f);
        alpi_shape_bevelled_box(shaper, (vec3){-0.36f, 3.7f, -0.36f}, (vec3){0.36f, 4.0f, 0.36f},
                                0.03f);
    }
    alpi_shaper_place(shaper, DARK, 0.0);
}

static const alpi_profile_point VASE[] = {
    {0.0f, 0.0f, 0.0f},   {0.11f, 0.0f, 0.0f},  {0.1f, 0.03f, 0.22f}, {0.09f, 0.5f, -0.1f},
    {0.13f, 0.62f, 0.0f}, {0.11f, 0.62f, 0.1f}, {0.07f, 0.5f, 0.0f},  {0.0f, 0.45f, 0.0f}};
enum { VASE_POINTS = sizeof VASE / sizeof *VASE };

static void build_furniture(alpi_shaper *shaper, uint32_t clay, uint32_t oak)
{
    alpi_shaper_surface(shaper, "vases", clay);
    alpi_shaper_place(shaper, (vec3){-4.22f, 0.5f, -1.2f}, 0.0);
    alpi_shape_turned(shaper, VASE, VASE_POINTS, 32.0);
    alpi_shaper_place(shaper, (vec3){4.2f, 0.0f, 1.3f}, 0.0);
    alpi_shape_turned(shaper, VASE, VASE_POINTS, 32.0);
    alpi_shaper_surface(shaper, "bench", oak);
    alpi_shaper_place(shaper, (vec3){0.0f, 0.0f, 2.55f}, 0.0);
    alpi_shape_bevelled_box(shaper, (vec3){-0.9f, 0.4f, -0.2f}, (vec3){0.9f, 0.46f, 0.2f}, 0.01f);
    alpi_shape_box(shaper, (vec3){-0.75f, 0.0f, -0.17f}, (vec3){-0.69f, 0.4f, 0.17f});
    alpi_shape_box(shaper, (vec3){0.69f, 0.0f, -0.17f}, (vec3){0.75f, 0.4f, 0.17f});
    alpi_shaper_place(shaper, DARK, 0.0);
}

static void build_sun(alpi_builder *builder, uint32_t glowing)
{
    const float degree = (float)(ALPI_PI / 180.0);
    float level = SUN_DISTANCE * cosf(SUN_ELEVATION * degree);
    alpi_builder_surface(builder, "sun", glowing);
    alpi_builder_ball(builder, &(alpi_ball){.center = {-level * sinf(SUN_TURN * degree),
                                                       SUN_DISTANCE * sinf(SUN_ELEVATION * degree),
                                                       -level * cosf(SUN_TURN * degree)},
                                            .radius = SUN_RADIUS,
                                            .top = SUN_RADIUS,
                                            .slices = 24,
                                            .stacks = 12});
}

void alpi_builtin_windows(alpi_builder *builder)
{
    uint32_t plaster = alpi_builder_material(builder, "plaster", (vec3){0.75f, 0.72f, 0.66f}, DARK);
    uint32_t white = alpi_builder_material(builder, "white paint", (vec3){0.8f, 0.8f, 0.78f}, DARK);
    uint32_t oak = alpi_builder_material(builder, "oak", (vec3){0.42f, 0.28f, 0.16f}, DARK);
    uint32_t stone = alpi_builder_material(builder, "stone", (vec3){0.6f, 0.56f, 0.5f}, DARK);
    uint32_t clay = alpi_builder_material(builder, "clay", (vec3){0.5f, 0.25f, 0.16f}, DARK);
    uint32_t sun = alpi_builder_material(builder, "sun", (vec3){0.5f, 0.5f, 0.5f}, SUN_EMISSION);
    alpi_shaper shaper = alpi_shaper_start(builder, 1.0);
    build_shell(&shaper, plaster, oak, white);
    build_windows(&shaper, white);
    build_pillars(&shaper, stone);
    build_furniture(&shaper, clay, oak);
    build_sun(builder, sun);
    alpi_builder_camera(builder, (vec3){-3.65f, 1.8f, 2.8f}, (vec3){-0.9f, 1.55f, -1.4f}, 1.12f);
    alpi_builder_camera(builder, (vec3){3.5f, 2.0f, -2.6f}, (vec3){-2.6f, 1.3f, 1.0f}, 1.15f);
}
