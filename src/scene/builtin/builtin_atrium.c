// SPDX-License-Identifier: MIT
// An open court of 16 m × 9.6 m between two storeys of round arches on columns, with galleries of
// 3.2 m behind them: much of the sky for the court, little of it for the galleries, and curves,
// mouldings and leaves of every size down to a centimetre. The ground floor lies at y = 0, the
// court three steps of a hand below, the upper floor at 6.5 m, the roof at 12.15 m.
//
// The building is the same for every number of triangles; curves and flat parts are cut finer, and
// leaves, balusters and dentils are more, until the number is met. Solids stand on each other or
// reach into each other; each is closed by itself.
#include "scene/builtin/builtin_atrium.h"
#include "scene/builtin/builtin.h"

#include <math.h>

static const vec3 ORIGIN = {0.0f, 0.0f, 0.0f};

/// Heights of a storey: floor, springing and top of its arcades.
typedef struct storey {
    float floor, spring, top;
    const char *columns, *piers, *arcades, *short_arcades, *mouldings, *galleries, *walls;
} storey;

static const storey STOREYS[2] = {
    {0.0f, 4.0f, ALPI_ATRIUM_CEILING, "ground columns", "ground piers", "ground arcades",
     "ground short arcades", "ground mouldings", "ground gallery arches", "ground walls"},
    {ALPI_ATRIUM_UPPER, 9.7f, ALPI_ATRIUM_EAVES, "upper columns", "upper piers", "upper arcades",
     "upper short arcades", "upper mouldings", "upper gallery arches", "upper walls"}};

/// Thickness of the arcades, radius of their arches, half an abacus.
static const float WALL = 0.5f, RADIUS = 1.3f, ABACUS = 0.38f;
static const float SHAFT = 0.23f; // radius at the foot

// --- what stands at the court --------------------------------------------------------------------

/// Base, shaft with a little entasis, and bell, between plinth and abacus.
static void build_column(alpi_shaper *shaper, const storey *s)
{
    float height = s->spring - s->floor, neck = height - 0.5f, r = SHAFT;
    const alpi_profile_point points[] = {
        {0.0f, 0.14f, 0.0f},
        {r + 0.12f, 0.14f, 0.5f}, // torus
        {r + 0.11f, 0.24f, 0.0f},
        {r + 0.07f, 0.26f, -0.35f}, // scotia
        {r + 0.06f, 0.33f, 0.5f},   // torus
        {r + 0.05f, 0.39f, 0.0f},
        {r + 0.02f, 0.41f, -0.15f},
        {r, 0.47f, 0.008f},      // shaft
        {r * 0.86f, neck, 0.5f}, // ring
        {r * 0.86f, neck + 0.05f, 0.0f},
        {r * 0.86f + 0.005f, neck + 0.06f, -0.18f}, // bell
        {r + 0.1f, neck + 0.36f, 0.3f},
        {r + 0.1f, neck + 0.4f, 0.0f},
        {0.0f, neck + 0.4f, 0.0f},
    };
    alpi_shape_turned(shaper, points, sizeof points / sizeof *points, 18.0);
    alpi_shape_bevelled_box(shaper, (vec3){-0.38f, 0.0f, -0.38f}, (vec3){0.38f, 0.14f, 0.38f},
                            0.015f);
    alpi_shape_bevelled_box(shaper, (vec3){-ABACUS, height - 0.1f, -ABACUS},
                            (vec3){ABACUS, height, ABACUS}, 0.02f);
}

/// Two rows of leaves that lean out round the bell.
static void build_capital_leaves(alpi_shaper *shaper, const storey *s)
{
    uint32_t count = alpi_shaper_divide(shaper, 8.0, 2);
    float neck = s->spring - s->floor - 0.5f;
    for (uint32_t row = 0; row < 2; row++) {
        float size = row == 0 ? 0.1f : 0.12f;
        float width = fminf(0.05f, 0.6f / (float)count);
        for (uint32_t i = 0; i < count; i++) {
            double c, sine;
            alpi_builder_turn(2 * i + row, 2 * count, &c, &sine);
            vec3 out = {(float)c, 0.0f, (float)sine};
            vec3 along = vec3_scale((vec3){out.x * 0.35f, 0.94f, out.z * 0.35f}, size);
            vec3 across = vec3_scale((vec3){-out.z, 0.0f, out.x}, width);
            vec3 middle = vec3_scale(out, row == 0 ? 0.235f : 0.275f);
            middle.y = neck + (row == 0 ? 0.14f : 0.25f);
            alpi_shape_leaf(shaper, middle, along, vec3_scale(across, -1.0f), 0.03f);
        }
    }
}

/// A square pier in a corner of the court, on the plinth and below the abacus of a column.
static void build_pier(alpi_shaper *shaper, const storey *s)
{
    static const float STEPS[][3] = {
        // from, to (above the floor, or below the springing), half side
        {0.0f, 0.14f, 0.42f},   {0.14f, 0.4f, 0.34f},   {0.4f, -0.5f, 0.29f},
        {-0.5f, -0.42f, 0.33f}, {-0.42f, -0.1f, 0.29f}, {-0.1f, 0.0f, 0.4f}};
    float height = s->spring - s->floor;
    for (size_t i = 0; i < sizeof STEPS / sizeof *STEPS; i++) {
        float low = STEPS[i][0] + (STEPS[i][0] < 0.0f ? height : 0.0f);
        float high = STEPS[i][1] + (STEPS[i][1] <= 0.0f ? height : 0.0f);
        float half = STEPS[i][2];
        alpi_shape_bevelled_box(shaper, (vec3){-half, low, -half}, (vec3){half, high, half}, 0.02f);
    }
}

static bool is_corner(uint32_t support)
{
    return support == 0 || support == ALPI_ATRIUM_X_BAYS;
}

/// Calls `build` at every support round the court that is a corner, or that is none.
static void build_supports(alpi_shaper *shaper, const storey *s, bool corners,
                           void (*build)(alpi_shaper *shaper, const storey *s))
{
    for (uint32_t i = 0; i <= ALPI_ATRIUM_X_BAYS; i++) {
        for (int side = -1; side <= 1; side += 2) {
            if (is_corner(i) == corners) {
                float x = ALPI_ATRIUM_BAY * (float)i - ALPI_ATRIUM_HALF_X;
                alpi_shaper_place(shaper, (vec3){x, s->floor, (float)side * ALPI_ATRIUM_HALF_Z},
                                  0.0);
                build(shaper, s);
            }
        }
    }
    for (uint32_t i = 1; i < ALPI_ATRIUM_Z_BAYS && !corners; i++) {
        for (int side = -1; side <= 1; side += 2) {
            float z = ALPI_ATRIUM_BAY * (float)i - ALPI_ATRIUM_HALF_Z;
            alpi_shaper_place(shaper, (vec3){(float)side * ALPI_ATRIUM_HALF_X, s->floor, z}, 0.0);
            build(shaper, s);
        }
    }
}

// --- arches --------------------------------------------------------------------------------------

/// Side k of the court: local +z looks into it, local x runs along it.
static void place_side(alpi_shaper *shaper, int side, float height)
{
    bool at_x = side % 2 == 1;
    float away = at_x ? ALPI_ATRIUM_HALF_X : ALPI_ATRIUM_HALF_Z;
    static const float SINES[4] = {0.0f, 1.0f, 0.0f, -1.0f}, COSINES[4] = {1.0f, 0.0f, -1.0f, 0.0f};
    vec3 origin = {-away * SINES[side], height, -away * COSINES[side]};
    alpi_shaper_place(shaper, origin, 0.5 * ALPI_PI * side);
}

static uint32_t side_bays(int side)
{
    return side % 2 == 1 ? ALPI_ATRIUM_Z_BAYS : ALPI_ATRIUM_X_BAYS;
}

/// Those of sides 0 and 2, or of 1 and 3.
static void build_arcades(alpi_shaper *shaper, const storey *s, int first)
{
    for (int side = first; side < 4; side += 2) {
        float half = 0.5f * ALPI_ATRIUM_BAY * (float)side_bays(side);
        // Long sides go round the corner, short ones stand between them.
        float end = half + (side % 2 == 0 ? 0.5f : -0.5f) * WALL;
        place_side(shaper, side, 0.0f);
        alpi_shape_arcade(shaper, &(alpi_arcade){.start = -end,
                                                 .end = end,
                                                 .first = 0.5f * ALPI_ATRIUM_BAY - half,
                                                 .distance = ALPI_ATRIUM_BAY,
                                                 .arch_count = side_bays(side),
                                                 .radius = RADIUS,
                                                 .thickness = WALL,
                                                 .spring = s->spring,
                                                 .top = s->top});
    }
}

/// Archivolts on the court's side, with a keystone each.
static void build_mouldings(alpi_shaper *shaper, const storey *s)
{
    // From the wall's inside round the front; radius and z.
    const float z = 0.5f * WALL;
    const alpi_profile_point section[] = {
        {RADIUS - 0.02f, z - 0.04f, 0.0f},  {RADIUS + 0.2f, z - 0.04f, 0.0f},
        {RADIUS + 0.2f, z + 0.05f, 0.5f},   {RADIUS + 0.13f, z + 0.05f, 0.0f},
        {RADIUS + 0.12f, z + 0.03f, -0.2f}, {RADIUS + 0.05f, z + 0.03f, 0.4f},
        {RADIUS - 0.02f, z + 0.03f, 0.0f},
    };
    for (int side = 0; side < 4; side++) {
        uint32_t bays = side_bays(side);
        place_side(shaper, side, 0.0f);
        for (uint32_t i = 0; i < bays; i++) {
            float x = ALPI_ATRIUM_BAY * ((float)i + 0.5f - 0.5f * (float)bays);
            float crown = s->spring + RADIUS;
            alpi_shape_archivolt(shaper, section, sizeof section / sizeof *section, x, s->spring);
            alpi_shape_bevelled_box(shaper, (vec3){x - 0.09f, crown - 0.06f, z - 0.1f},
                                    (vec3){x + 0.09f, crown + 0.27f, z + 0.12f}, 0.02f);
        }
    }
}

/// Arches across the galleries, from the arcades to pilasters on the outer walls.
static void build_gallery_arches(alpi_shaper *shaper, const storey *s)
{
    const float start = 0.5f * WALL, end = ALPI_ATRIUM_GALLERY, thick = 0.36f;
    const alpi_arcade arch = {.start = start,
                              .end = end,
                              .first = 0.5f * (start + end),
                              .distance = 0.0f,
                              .arch_count = 1,
                              .radius = RADIUS,
                              .thickness = thick,
                              .spring = s->spring,
                              .top = s->top};
    for (int side = 0; side < 4; side++) {
        bool at_x = side % 2 == 1;
        float away = at_x ? ALPI_ATRIUM_HALF_X : ALPI_ATRIUM_HALF_Z;
        float half = 0.5f * ALPI_ATRIUM_BAY * (float)side_bays(side);
        for (uint32_t i = 0; i <= side_bays(side); i++) {
            // Local +x leads outwards.
            float along = ALPI_ATRIUM_BAY * (float)i - half;
            const vec3 places[4] = {{-along, 0.0f, away},
                                    {away, 0.0f, along},
                                    {along, 0.0f, -away},
                                    {-away, 0.0f, -along}};
            alpi_shaper_place(shaper, places[side], 0.5 * ALPI_PI * (side + 3));
            alpi_shape_arcade(shaper, &arch);
            alpi_shape_bevelled_box(shaper, (vec3){end - 0.16f, s->floor, -0.22f},
                                    (vec3){end + 0.05f, s->spring - 0.14f, 0.22f}, 0.02f);
            alpi_shape_bevelled_box(shaper, (vec3){end - 0.24f, s->spring - 0.14f, -0.28f},
                                    (vec3){end + 0.05f, s->spring, 0.28f}, 0.02f);
        }
    }
}

static void build_storey(alpi_shaper *shaper, const storey *s, const alpi_atrium_materials *m)
{
    alpi_shaper_surface(shaper, s->columns, m->marble);
    build_supports(shaper, s, false, build_column);
    build_supports(shaper, s, false, build_capital_leaves);
    alpi_shaper_surface(shaper, s->piers, m->stone);
    build_supports(shaper, s, true, build_pier);
    alpi_shaper_surface(shaper, s->arcades, m->plaster);
    build_arcades(shaper, s, 0);
    alpi_shaper_surface(shaper, s->short_arcades, m->plaster);
    build_arcades(shaper, s, 1);
    alpi_shaper_surface(shaper, s->mouldings, m->stone);
    build_mouldings(shaper, s);
    alpi_shaper_surface(shaper, s->galleries, m->stone);
    build_gallery_arches(shaper, s);
    alpi_shaper_place(shaper, ORIGIN, 0.0);
    alpi_shaper_surface(shaper, s->walls, m->plaster);
    alpi_atrium_build_walls(shaper, s->floor, s->top, s->floor > 0.0f);
}

static void build(alpi_shaper *shaper, const void *user)
{
    const alpi_atrium_materials *materials = user;
    for (int i = 0; i < 2; i++) {
        build_storey(shaper, &STOREYS[i], materials);
    }
    alpi_atrium_build_floors(shaper, materials);
    alpi_atrium_build_ornaments(shaper, materials);
    alpi_atrium_build_garden(shaper, materials);
}

void alpi_builtin_atrium(alpi_builder *builder, const uint32_t *values)
{
    const vec3 dark = {0.0f, 0.0f, 0.0f};
    const alpi_atrium_materials materials = {
        .stone = alpi_builder_material(builder, "limestone", (vec3){0.62f, 0.57f, 0.48f}, dark),
        .marble = alpi_builder_material(builder, "marble", (vec3){0.78f, 0.76f, 0.72f}, dark),
        .plaster = alpi_builder_material(builder, "plaster", (vec3){0.72f, 0.6f, 0.45f}, dark),
        .paving = alpi_builder_material(builder, "paving", (vec3){0.45f, 0.41f, 0.36f}, dark),
        .clay = alpi_builder_material(builder, "terracotta", (vec3){0.5f, 0.24f, 0.15f}, dark),
        .leaf = alpi_builder_material(builder, "leaves", (vec3){0.12f, 0.22f, 0.06f}, dark),
        .wood = alpi_builder_material(builder, "bark", (vec3){0.25f, 0.18f, 0.12f}, dark),
        .water = alpi_builder_material(builder, "water", (vec3){0.05f, 0.1f, 0.11f}, dark)};
    double fineness = alpi_shaper_fit(build, &materials, 0.2, 16.0, values[0]);
    alpi_shaper shaper = alpi_shaper_start(builder, fineness);
    build(&shaper, &materials);
    // From the court's corner under the sky, and along a gallery.
    alpi_builder_camera(builder, (vec3){-3.4f, 1.3f, 4.0f}, (vec3){3.2f, 4.3f, -4.0f}, 1.25f);
    alpi_builder_camera(builder, (vec3){-10.6f, 1.8f, 6.9f}, (vec3){2.0f, 2.6f, 5.2f}, 1.05f);
    alpi_builder_camera(builder, (vec3){-9.9f, 8.4f, -6.6f}, (vec3){5.0f, 4.6f, 4.0f}, 1.1f);
}
