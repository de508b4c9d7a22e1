// SPDX-License-Identifier: MIT
// Newell's teapot, large as a tureen, on a table in a room of 4 m × 2.8 m × 4 m with cups and a
// bowl, stools, a rug, a shelf of books, balls on the floor, skirting, and a doorway to a dark
// hall: corners, gaps and contacts of many sizes. What stands on something is sunk a millimetre
// into it and has no hidden face there, so that no two faces lie in one plane.
#include "scene/builtin/builtin.h"
#include "scene/builtin/teapot.h"

static const float SUNK = 0.001f;
static const float RUG_HEIGHT = 0.012f;
static const vec3 DARK = {0.0f, 0.0f, 0.0f}; // no emission

enum { X_CUTS = 2, Y_CUTS = 3, Z_CUTS = 4 };

/// A box seen from inside, with a doorway in cell y 0, z 1 of one of its x sides. All sides are cut
/// at the lines of the doorway.
typedef struct shell {
    float x[X_CUTS], y[Y_CUTS], z[Z_CUTS];
    bool door_at_high_x;
} shell;

static const shell ROOM = {
    .x = {-2.0f, 2.0f}, .y = {0.0f, 2.05f, 2.8f}, .z = {-2.0f, 0.45f, 1.35f, 2.0f}};
static const shell HALL = {.x = {-3.3f, -2.12f},
                           .y = {0.0f, 2.05f, 2.4f},
                           .z = {-0.2f, 0.45f, 1.35f, 1.9f},
                           .door_at_high_x = true};

enum { AXIS_X, AXIS_Y, AXIS_Z };

static void build_side(alpi_builder *builder, const shell *s, int axis, bool high)
{
    static const vec3 AXES[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const float *const cuts[3] = {s->x, s->y, s->z};
    static const uint32_t counts[3] = {X_CUTS, Y_CUTS, Z_CUTS};
    // Cyclic order gives a normal along +axis, which looks inside from the low side.
    int u = (axis + (high ? 2 : 1)) % 3, v = (axis + (high ? 1 : 2)) % 3;
    bool door = axis == AXIS_X && high == s->door_at_high_x;
    float at = cuts[axis][high ? counts[axis] - 1 : 0];
    const alpi_panel panel = {.origin = vec3_scale(AXES[axis], at),
                              .u = AXES[u],
                              .v = AXES[v],
                              .u_cuts = cuts[u],
                              .v_cuts = cuts[v],
                              .u_count = counts[u],
                              .v_count = counts[v],
                              .hole_u = !door         ? ALPI_NONE
                                        : u == AXIS_Y ? 0
                                                      : 1,
                              .hole_v = !door         ? ALPI_NONE
                                        : v == AXIS_Y ? 0
                                                      : 1};
    alpi_builder_panel(builder, &panel);
}

static void build_walls(alpi_builder *builder, const shell *s)
{
    build_side(builder, s, AXIS_X, false);
    build_side(builder, s, AXIS_X, true);
    build_side(builder, s, AXIS_Z, false);
    build_side(builder, s, AXIS_Z, true);
}

static void build_shells(alpi_builder *builder, uint32_t plaster, uint32_t oak)
{
    alpi_builder_surface(builder, "floor", oak);
    build_side(builder, &ROOM, AXIS_Y, false);
    alpi_builder_surface(builder, "walls", plaster);
    build_walls(builder, &ROOM);
    alpi_builder_surface(builder, "ceiling", plaster);
    build_side(builder, &ROOM, AXIS_Y, true);
    alpi_builder_surface(builder, "hall floor", oak);
    build_side(builder, &HALL, AXIS_Y, false);
    alpi_builder_surface(builder, "hall walls", plaster);
    build_walls(builder, &HALL);
    build_side(builder, &HALL, AXIS_Y, true);
    alpi_builder_surface(builder, "doorway", plaster); // between the two, as thick as the wall
    alpi_builder_box(builder, (vec3){ROOM.x[0], ROOM.y[1], ROOM.z[2]},
                     (vec3){HALL.x[1], ROOM.y[0], ROOM.z[1]},
                     ALPI_FACE_BOTTOM | ALPI_FACE_TOP | ALPI_FACE_BACK | ALPI_FACE_FRONT);
}

/// Boards along the foot of the walls; their ends meet without overlapping.
static void build_skirting(alpi_builder *builder, uint32_t material)
{
    const float height = 0.08f, thick = 0.015f, wall = 2.0f, end = wall - thick;
    const float back = wall + SUNK, door_low = ROOM.z[1], door_high = ROOM.z[2];
    alpi_builder_surface(builder, "skirting", material);
    alpi_builder_box(builder, (vec3){-wall, -SUNK, -back}, (vec3){wall, height, -end},
                     ALPI_FACE_TOP | ALPI_FACE_FRONT);
    alpi_builder_box(builder, (vec3){-wall, -SUNK, end}, (vec3){wall, height, back},
                     ALPI_FACE_TOP | ALPI_FACE_BACK);
    alpi_builder_box(builder, (vec3){end, -SUNK, -end}, (vec3){back, height, end},
                     ALPI_FACE_TOP | ALPI_FACE_LEFT);
    // At the door the ends are flush with the doorway's sides, and so are not sunk into the wall.
    alpi_builder_box(builder, (vec3){-wall, -SUNK, -end}, (vec3){-end, height, door_low},
                     ALPI_FACE_TOP | ALPI_FACE_RIGHT | ALPI_FACE_FRONT);
    alpi_builder_box(builder, (vec3){-wall, -SUNK, door_high}, (vec3){-end, height, end},
                     ALPI_FACE_TOP | ALPI_FACE_RIGHT | ALPI_FACE_BACK);
}

/// A slab on four legs: a table or a stool.
typedef struct table {
    const char *name;
    float x, floor, z, width, depth, height, thickness, leg, inset;
} table;

static const table TABLE = {"table", 0.05f, RUG_HEIGHT, -0.45f, 1.5f,
                            0.9f,    0.74f, 0.04f,      0.06f,  0.05f};
static const table STOOLS[2] = {
    {"stool", -0.1f, 0.0f, 0.62f, 0.38f, 0.38f, 0.45f, 0.03f, 0.04f, 0.02f},
    {"far stool", -1.25f, 0.0f, -0.5f, 0.38f, 0.38f, 0.45f, 0.03f, 0.04f, 0.02f}};

static void build_table(alpi_builder *builder, const table *t, uint32_t material)
{
    float half_width = 0.5f * t->width, half_depth = 0.5f * t->depth;
    float under = t->height - t->thickness;
    alpi_builder_surface(builder, t->name, material);
    alpi_builder_box(builder, (vec3){t->x - half_width, under, t->z - half_depth},
                     (vec3){t->x + half_width, t->height, t->z + half_depth}, ALPI_FACE_ALL);
    float out_x = half_width - t->inset - 0.5f * t->leg;
    float out_z = half_depth - t->inset - 0.5f * t->leg;
    for (int i = 0; i < 4; i++) {
        float x = t->x + (i & 1 ? out_x : -out_x), z = t->z + (i & 2 ? out_z : -out_z);
        float half = 0.5f * t->leg;
        alpi_builder_box(builder, (vec3){x - half, t->floor - SUNK, z - half},
                         (vec3){x + half, under + SUNK, z + half},
                         ALPI_FACE_ALL & ~(ALPI_FACE_TOP | ALPI_FACE_BOTTOM));
    }
}

static void build_ball(alpi_builder *builder, vec3 foot, float radius, const char *name,
                       uint32_t material)
{
    alpi_builder_surface(builder, name, material);
    alpi_builder_ball(builder, &(alpi_ball){.center = {foot.x, foot.y + radius - SUNK, foot.z},
                                            .radius = radius,
                                            .top = radius,
                                            .slices = 48,
                                            .stacks = 24});
}

/// Profiles (radius, height) of a cup and a bowl; the hidden bottom is left out.
static const float CUP[][2] = {
    {0.024f, -0.001f}, {0.026f, 0.006f}, {0.04f, 0.025f},  {0.046f, 0.05f}, {0.048f, 0.078f},
    {0.045f, 0.078f},  {0.043f, 0.05f},  {0.037f, 0.027f}, {0.022f, 0.01f}, {0.0f, 0.008f}};
static const float BOWL[][2] = {{0.05f, -0.001f}, {0.052f, 0.012f}, {0.1f, 0.04f},  {0.135f, 0.08f},
                                {0.13f, 0.08f},   {0.096f, 0.045f}, {0.05f, 0.02f}, {0.0f, 0.017f}};
enum { CUP_POINTS = sizeof CUP / sizeof *CUP, BOWL_POINTS = sizeof BOWL / sizeof *BOWL };

static void build_tableware(alpi_builder *builder, uint32_t cups, uint32_t bowl)
{
    static const float CUP_PLACES[3][2] = {{0.45f, -0.22f}, {0.28f, -0.1f}, {-0.42f, -0.14f}};
    alpi_builder_surface(builder, "cups", cups);
    for (int i = 0; i < 3; i++) {
        const vec3 foot = {CUP_PLACES[i][0], TABLE.height, CUP_PLACES[i][1]};
        alpi_builder_lathe(builder, &(alpi_lathe){foot, CUP, CUP_POINTS, 32});
    }
    alpi_builder_surface(builder, "bowl", bowl);
    alpi_builder_lathe(builder, &(alpi_lathe){{0.6f, TABLE.height, -0.64f}, BOWL, BOWL_POINTS, 48});
}

static const float SHELF_LEFT = 0.1f, SHELF_RIGHT = 1.4f;
static const float SHELF_TOPS[2] = {1.4f, 1.78f};

/// Width, height and depth of each book, in metres.
static const float BOOKS[][3] = {
    {0.036f, 0.24f, 0.17f}, {0.028f, 0.21f, 0.15f}, {0.045f, 0.27f, 0.19f}, {0.031f, 0.22f, 0.16f},
    {0.052f, 0.25f, 0.18f}, {0.024f, 0.20f, 0.14f}, {0.040f, 0.28f, 0.20f}, {0.034f, 0.23f, 0.17f},
    {0.048f, 0.26f, 0.18f}, {0.027f, 0.21f, 0.15f}, {0.038f, 0.24f, 0.17f}, {0.044f, 0.22f, 0.16f},
};
enum { BOOK_COUNT = sizeof BOOKS / sizeof *BOOKS, BOOK_COLORS = 3 };

/// Every third book, so that each colour is one surface.
static void build_books(alpi_builder *builder, int color, const char *name, uint32_t material)
{
    alpi_builder_surface(builder, name, material);
    float x = SHELF_LEFT + 0.06f;
    for (int i = 0; i < BOOK_COUNT; i++) {
        const float *size = BOOKS[i];
        if (i % BOOK_COLORS == color) {
            float front = -1.76f, y = SHELF_TOPS[0];
            alpi_builder_box(builder, (vec3){x, y - SUNK, front - size[2]},
                             (vec3){x + size[0], y + size[1], front},
                             ALPI_FACE_ALL & ~ALPI_FACE_BOTTOM);
        }
        x += size[0] + 0.002f; // a gap between neighbours
    }
}

static void build_shelf(alpi_builder *builder, uint32_t wood)
{
    alpi_builder_surface(builder, "shelf", wood);
    for (int i = 0; i < 2; i++) {
        alpi_builder_box(builder, (vec3){SHELF_LEFT, SHELF_TOPS[i] - 0.03f, -2.0f - SUNK},
                         (vec3){SHELF_RIGHT, SHELF_TOPS[i], -1.72f},
                         ALPI_FACE_ALL & ~ALPI_FACE_BACK);
    }
}

/// Hangs from the ceiling over the table; only its lower face glows.
static void build_lamp(alpi_builder *builder, uint32_t housing, uint32_t glowing)
{
    const vec3 low = {-0.45f, 2.7f, -0.75f}, high = {0.55f, 2.8f + SUNK, -0.15f};
    alpi_builder_surface(builder, "lamp housing", housing);
    alpi_builder_box(builder, low, high, ALPI_FACE_ALL & ~(ALPI_FACE_TOP | ALPI_FACE_BOTTOM));
    alpi_builder_surface(builder, "lamp", glowing);
    alpi_builder_box(builder, low, high, ALPI_FACE_BOTTOM);
}

void alpi_builtin_teapot_room(alpi_builder *builder)
{
    uint32_t plaster = alpi_builder_material(builder, "plaster", (vec3){0.8f, 0.77f, 0.72f}, DARK);
    uint32_t oak = alpi_builder_material(builder, "oak", (vec3){0.42f, 0.29f, 0.18f}, DARK);
    uint32_t walnut = alpi_builder_material(builder, "walnut", (vec3){0.3f, 0.19f, 0.12f}, DARK);
    uint32_t white =
        alpi_builder_material(builder, "white paint", (vec3){0.85f, 0.85f, 0.83f}, DARK);
    uint32_t china = alpi_builder_material(builder, "china", (vec3){0.62f, 0.72f, 0.78f}, DARK);
    uint32_t wool = alpi_builder_material(builder, "wool", (vec3){0.5f, 0.12f, 0.1f}, DARK);
    uint32_t green =
        alpi_builder_material(builder, "green cloth", (vec3){0.14f, 0.3f, 0.18f}, DARK);
    uint32_t ochre =
        alpi_builder_material(builder, "ochre cloth", (vec3){0.6f, 0.42f, 0.12f}, DARK);
    uint32_t lamp = alpi_builder_material(builder, "lamp", (vec3){0.78f, 0.78f, 0.78f},
                                          (vec3){18.0f, 16.0f, 13.0f});
    build_shells(builder, plaster, oak);
    build_skirting(builder, white);
    alpi_builder_surface(builder, "rug", wool);
    alpi_builder_box(builder, (vec3){-1.0f, -SUNK, -1.15f}, (vec3){1.1f, RUG_HEIGHT, 0.35f},
                     ALPI_FACE_ALL & ~ALPI_FACE_BOTTOM);
    build_table(builder, &TABLE, walnut);
    build_table(builder, &STOOLS[0], white);
    build_table(builder, &STOOLS[1], white);
    alpi_builder_surface(builder, "teapot", china);
    alpi_builder_teapot(builder, &(alpi_teapot){.foot = {0.05f, TABLE.height - SUNK, -0.42f},
                                                .height = 0.4f,
                                                .turn = 0.6f,
                                                .segments = 10});
    build_tableware(builder, white, ochre);
    build_shelf(builder, walnut);
    build_books(builder, 0, "red books", wool);
    build_books(builder, 1, "green books", green);
    build_books(builder, 2, "ochre books", ochre);
    build_ball(builder, (vec3){1.05f, SHELF_TOPS[1], -1.86f}, 0.1f, "small ball", china);
    build_ball(builder, (vec3){-1.5f, 0.0f, -1.5f}, 0.28f, "ball", ochre);
    build_ball(builder, (vec3){-1.05f, 0.0f, -1.62f}, 0.16f, "green ball", green);
    build_lamp(builder, white, lamp);
    alpi_builder_camera(builder, (vec3){1.75f, 1.7f, 1.7f}, (vec3){-0.12f, 0.74f, -0.6f}, 0.88f);
    alpi_builder_camera(builder, (vec3){0.75f, 1.3f, 0.75f}, (vec3){0.05f, 0.87f, -0.42f}, 0.65f);
}
