// SPDX-License-Identifier: MIT
// A hamlet by a lake among hills: a solid of 240 m × 240 m whose top is a height field, houses on
// level ground, conifers and round trees, and water, level at y = 0. Outdoors: most points see most
// of the sky, and thin, scattered things shade large faces.
//
// Height field and trees share the triangles; their places do not depend on the number.
#include "scene/builtin/builtin_terrain.h"

#include "base/memory.h"
#include "base/random.h"
#include "scene/builtin/builtin.h"

#include <math.h>

#define COUNT(points) ((uint32_t)(sizeof(points) / sizeof *(points)))

typedef struct terrain {
    uint32_t trees; // ALPI_NONE = by fineness
    uint32_t ground, water, plaster, tiles, wood, needles, leaves, stone;
    const alpi_ground *field; // NULL while triangles are counted
} terrain;

// --- houses --------------------------------------------------------------------------------------

static const float FOUNDATION = 2.0f; // below the ground, so that no gap opens where that is coarse

/// Cells of a house between its walls' planes; doors and windows are recessed by one cell.
static bool house_is_solid(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    const uint32_t *counts = user; // of cells along x, y, z
    bool at_side = x == 0 || x + 1 == counts[0], at_end = z == 0 || z + 1 == counts[2];
    bool in_row = z % 2 == 0 && z > 0 && z + 1 < counts[2];
    bool window = at_side && in_row && (y == 2 || (y == 5 && counts[1] > 5));
    bool door = at_end && z == 0 && x == 2 && (y == 1 || y == 2);
    return !window && !door;
}

/// Where triangles are few, houses have plain walls, one after the other.
static const double PLAIN_HOUSES = 0.15;

/// Walls to the eaves. Local z is along the ridge, y = 0 the ground.
static void build_walls(alpi_shaper *shaper, const alpi_house *house, bool openings)
{
    const float half_x = 0.5f * house->width, half_z = 0.5f * house->length, deep = 0.18f;
    const float x[] = {-half_x, -half_x + deep, -0.55f, 0.55f, half_x - deep, half_x};
    const float y[] = {-FOUNDATION, 0.25f, 1.0f, 2.3f, 3.0f, 3.7f, 4.9f, house->eaves};
    const float z[] = {-half_z,         -half_z + deep, -0.62f * half_z, -0.36f * half_z,
                       -0.13f * half_z, 0.13f * half_z, 0.36f * half_z,  0.62f * half_z,
                       half_z - deep,   half_z};
    float heights[8];
    uint32_t levels = house->eaves > 5.0f ? 8 : 5;
    for (uint32_t i = 0; i < levels; i++) {
        heights[i] = i + 1 == levels ? house->eaves : y[i];
    }
    if (!openings) {
        alpi_shape_box(shaper, (vec3){-half_x, -FOUNDATION, -half_z},
                       (vec3){half_x, house->eaves, half_z});
        return;
    }
    const uint32_t cells[3] = {COUNT(x) - 1, levels - 1, COUNT(z) - 1};
    alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {x, heights, z},
                                             .counts = {COUNT(x), levels, COUNT(z)},
                                             .solid = house_is_solid,
                                             .user = cells,
                                             .edge = HUGE_VALF});
}

/// The gables: a prism between eaves and ridge, as wide as the walls.
static void build_gables(alpi_shaper *shaper, const alpi_house *house)
{
    const float w = 0.5f * house->width, l = 0.5f * house->length;
    const float ridge = house->eaves + house->slope * w;
    const vec3 a = {-w, house->eaves, l}, b = {w, house->eaves, l}, c = {0.0f, ridge, l};
    const vec3 d = {-w, house->eaves, -l}, e = {w, house->eaves, -l}, f = {0.0f, ridge, -l};
    alpi_shape_triangle(shaper, a, b, c);
    alpi_shape_triangle(shaper, e, d, f);
    alpi_shape_quad(shaper, (const vec3[4]){d, e, b, a});
    alpi_shape_quad(shaper, (const vec3[4]){b, e, f, c});
    alpi_shape_quad(shaper, (const vec3[4]){d, a, c, f});
}

/// Two slopes of one bent slab that rest on the gables and hang over all sides.
static void build_roof(alpi_shaper *shaper, const alpi_house *house)
{
    const float over = 0.45f, thick = 0.22f, w = 0.5f * house->width + over;
    const float l = 0.5f * house->length + over;
    const float ridge = house->eaves + house->slope * 0.5f * house->width;
    const float foot = house->eaves - house->slope * over;
    // Section, counter-clockwise seen from +z: under left, ridge, right; over right, ridge, left.
    const float section[6][2] = {{-w, foot},        {0.0f, ridge},         {w, foot},
                                 {w, foot + thick}, {0.0f, ridge + thick}, {-w, foot + thick}};
    vec3 front[6], back[6];
    for (int i = 0; i < 6; i++) {
        front[i] = (vec3){section[i][0], section[i][1], l};
        back[i] = (vec3){section[i][0], section[i][1], -l};
    }
    for (int i = 0; i < 6; i++) {
        int next = (i + 1) % 6;
        alpi_shape_quad(shaper, (const vec3[4]){front[i], back[i], back[next], front[next]});
    }
    for (int i = 0; i < 2; i++) {
        int low = i, high = 5 - i;
        alpi_shape_quad(shaper,
                        (const vec3[4]){front[low], front[low + 1], front[high - 1], front[high]});
        alpi_shape_quad(shaper,
                        (const vec3[4]){back[low + 1], back[low], back[high], back[high - 1]});
    }
}

static void place_house(alpi_shaper *shaper, const alpi_house *house)
{
    alpi_shaper_place(shaper, (vec3){house->x, alpi_terrain_pad(house), house->z},
                      (double)house->turn);
}

static void build_houses(alpi_shaper *shaper, const terrain *t)
{
    const alpi_house *houses = alpi_terrain_houses();
    alpi_shaper_surface(shaper, "house walls", t->plaster);
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        place_house(shaper, &houses[i]);
        build_walls(shaper, &houses[i], shaper->fineness > PLAIN_HOUSES + 0.02 * i);
    }
    alpi_shaper_surface(shaper, "gables", t->plaster);
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        place_house(shaper, &houses[i]);
        build_gables(shaper, &houses[i]);
    }
    alpi_shaper_surface(shaper, "roofs", t->tiles);
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        place_house(shaper, &houses[i]);
        build_roof(shaper, &houses[i]);
    }
    alpi_shaper_surface(shaper, "chimneys", t->stone);
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        const alpi_house *h = &houses[i];
        float ridge = h->eaves + h->slope * 0.5f * h->width;
        place_house(shaper, h);
        alpi_shape_box(shaper, (vec3){0.5f, ridge - 1.2f, 0.2f * h->length},
                       (vec3){1.15f, ridge + 1.0f, 0.2f * h->length + 0.65f});
    }
}

// --- trees ---------------------------------------------------------------------------------------

static bool is_conifer(uint32_t tree)
{
    return alpi_hash32(tree ^ 0x51ed270bu) % 5 < 3;
}

static void place_tree(alpi_shaper *shaper, const terrain *t, uint32_t tree, float *size)
{
    *size = 1.0f;
    if (!shaper->counting) {
        vec3 foot = alpi_terrain_tree(t->field, tree);
        uint32_t bits = alpi_random_key(tree, 0, 3);
        *size = 0.75f + 0.6f * alpi_unit_float(bits);
        alpi_shaper_place(shaper, foot,
                          2.0 * ALPI_PI * (double)alpi_unit_float(bits * 0x9e3779b9u));
    }
}

/// Scaled copy of a profile, turned.
static void build_scaled(alpi_shaper *shaper, const alpi_profile_point *points, uint32_t count,
                         float size, double slices)
{
    alpi_profile_point scaled[16];
    for (uint32_t i = 0; i < count; i++) {
        scaled[i] =
            (alpi_profile_point){points[i].out * size, points[i].up * size, points[i].bulge};
    }
    alpi_shape_turned(shaper, scaled, count, slices);
}

/// A conifer of 10 m and a round tree of 8 m; trunks begin below the ground.
static const alpi_profile_point TRUNK[] = {
    {0.0f, -0.6f, 0.0f}, {0.3f, -0.6f, 0.0f}, {0.16f, 3.4f, 0.0f}, {0.0f, 3.6f, 0.0f}};
static const alpi_profile_point CONIFER[] = {
    {0.0f, 1.5f, 0.0f}, {2.1f, 1.2f, 0.0f},  {1.0f, 4.3f, 0.0f}, {1.6f, 4.1f, 0.0f},
    {0.6f, 7.0f, 0.0f}, {1.05f, 6.8f, 0.0f}, {0.0f, 10.0f, 0.0f}};

static void build_crown(alpi_shaper *shaper, uint32_t tree, float size)
{
    if (is_conifer(tree)) {
        build_scaled(shaper, CONIFER, COUNT(CONIFER), size, 7.0);
        return;
    }
    vec3 foot = shaper->origin;
    shaper->origin.y += 4.9f * size;
    alpi_shape_blob(shaper, &(alpi_blob){.radius = 2.3f * size,
                                         .height_scale = 1.15f,
                                         .roughness = 0.16f,
                                         .key = tree,
                                         .slices = 15.0});
    shaper->origin = foot;
}

/// Which trees a surface holds.
typedef enum tree_part { PART_TRUNK, PART_NEEDLES, PART_LEAVES } tree_part;

static void build_tree_part(alpi_shaper *shaper, const terrain *t, uint32_t count, tree_part part)
{
    for (uint32_t tree = 0; tree < count; tree++) {
        if (part != PART_TRUNK && is_conifer(tree) != (part == PART_NEEDLES)) {
            continue;
        }
        float size;
        place_tree(shaper, t, tree, &size);
        if (part == PART_TRUNK) {
            build_scaled(shaper, TRUNK, COUNT(TRUNK), size, 6.0);
        } else {
            build_crown(shaper, tree, size);
        }
    }
}

/// Whether any of `count` trees is a conifer, or is none: a surface must not be empty.
static bool has_kind(uint32_t count, bool conifer)
{
    uint32_t tree = 0;
    while (tree < count && is_conifer(tree) != conifer) {
        tree++;
    }
    return tree < count;
}

static void build_trees(alpi_shaper *shaper, const terrain *t)
{
    uint32_t count = t->trees;
    double fineness = shaper->fineness;
    if (count == ALPI_NONE) {
        count = (uint32_t)(170.0 * fineness);
    }
    shaper->fineness = sqrt(fineness); // number and cells each take half of the growth
    if (count > 0) {
        alpi_shaper_surface(shaper, "trunks", t->wood);
        build_tree_part(shaper, t, count, PART_TRUNK);
    }
    if (has_kind(count, true)) {
        alpi_shaper_surface(shaper, "conifers", t->needles);
        build_tree_part(shaper, t, count, PART_NEEDLES);
    }
    if (has_kind(count, false)) {
        alpi_shaper_surface(shaper, "round trees", t->leaves);
        build_tree_part(shaper, t, count, PART_LEAVES);
    }
    shaper->fineness = fineness;
}

// --- all -----------------------------------------------------------------------------------------

/// A disc that reaches into the shore all round.
static void build_lake(alpi_shaper *shaper, uint32_t water)
{
    const alpi_profile_point points[] = {{0.0f, -0.2f, 0.0f},
                                         {ALPI_LAKE_RIM, -0.2f, 0.0f},
                                         {ALPI_LAKE_RIM, 0.0f, 0.0f},
                                         {0.0f, 0.0f, 0.0f}};
    double fineness = shaper->fineness;
    shaper->fineness = sqrt(fineness);
    alpi_shaper_surface(shaper, "lake", water);
    alpi_shaper_place(shaper, (vec3){ALPI_LAKE_X, 0.0f, ALPI_LAKE_Z}, 0.0);
    alpi_shape_turned(shaper, points, COUNT(points), 32.0);
    shaper->fineness = fineness;
}

/// A deck on posts from the shore towards the middle of the lake.
static void build_jetty(alpi_shaper *shaper, uint32_t wood)
{
    enum { POSTS = 5 };
    const float start = ALPI_LAKE_X + 20.0f, spacing = 3.2f;
    alpi_shaper_surface(shaper, "jetty", wood);
    alpi_shaper_place(shaper, (vec3){start, 0.0f, ALPI_LAKE_Z}, 0.0);
    alpi_shape_box(shaper, (vec3){-0.3f, 0.5f, -0.9f},
                   (vec3){spacing * (float)(POSTS - 1) + 0.3f, 0.62f, 0.9f});
    for (int i = 0; i < 2 * POSTS; i++) {
        const int pair = i / 2;
        float x = spacing * (float)pair, z = i % 2 == 0 ? -1.0f : 1.0f;
        alpi_shape_box(shaper, (vec3){x - 0.12f, -5.5f, z - 0.12f},
                       (vec3){x + 0.12f, 1.3f, z + 0.12f});
    }
}

static uint32_t ground_cells(const alpi_shaper *shaper)
{
    return alpi_shaper_divide(shaper, 110.0, 16);
}

static void build(alpi_shaper *shaper, const void *user)
{
    const terrain *t = user;
    uint32_t cells = ground_cells(shaper);
    alpi_shaper_place(shaper, (vec3){0.0f, 0.0f, 0.0f}, 0.0);
    alpi_shaper_surface(shaper, "ground", t->ground);
    alpi_terrain_build_ground(shaper, t->field, cells);
    build_lake(shaper, t->water);
    build_jetty(shaper, t->wood);
    build_houses(shaper, t);
    build_trees(shaper, t);
}

static terrain make_terrain(alpi_builder *builder, uint32_t trees)
{
    const vec3 dark = {0.0f, 0.0f, 0.0f};
    return (terrain){
        .trees = trees,
        .ground = alpi_builder_material(builder, "grass", (vec3){0.2f, 0.28f, 0.1f}, dark),
        .water = alpi_builder_material(builder, "water", (vec3){0.05f, 0.08f, 0.1f}, dark),
        .plaster = alpi_builder_material(builder, "plaster", (vec3){0.75f, 0.7f, 0.6f}, dark),
        .tiles = alpi_builder_material(builder, "roof tiles", (vec3){0.42f, 0.17f, 0.1f}, dark),
        .wood = alpi_builder_material(builder, "bark", (vec3){0.22f, 0.16f, 0.11f}, dark),
        .needles = alpi_builder_material(builder, "needles", (vec3){0.07f, 0.15f, 0.07f}, dark),
        .leaves = alpi_builder_material(builder, "leaves", (vec3){0.16f, 0.26f, 0.07f}, dark),
        .stone = alpi_builder_material(builder, "stone", (vec3){0.45f, 0.43f, 0.4f}, dark)};
}

void alpi_builtin_terrain(alpi_builder *builder, const uint32_t *values)
{
    const double coarsest = 0.02, finest = 20.0;
    terrain t = make_terrain(builder, values[1]);
    alpi_shaper least = alpi_shaper_start(NULL, coarsest);
    build(&least, &t);
    if (least.triangle_count > values[0] && builder->result == ALP_OK) {
        builder->result = alpi_fail(builder->context, ALP_ERROR_INVALID_ARGUMENT,
                                    "builtin:terrain: trees=%u: %u triangles are too few; give "
                                    "%llu or more, or fewer trees",
                                    values[1], values[0], (unsigned long long)least.triangle_count);
    }
    if (builder->result != ALP_OK) {
        return;
    }
    double fineness = alpi_shaper_fit(build, &t, coarsest, finest, values[0]);
    alpi_shaper shaper = alpi_shaper_start(builder, fineness);
    alpi_ground *field = NULL;
    builder->result = alpi_terrain_make_ground(builder->context, ground_cells(&shaper), &field);
    if (builder->result == ALP_OK) {
        t.field = field;
        build(&shaper, &t);
    }
    alpi_terrain_destroy_ground(builder->context, field);
    alpi_builder_camera(builder, (vec3){-62.0f, 33.0f, 84.0f}, (vec3){6.0f, 1.0f, -4.0f}, 0.85f);
    alpi_builder_camera(builder, (vec3){-50.0f, 5.0f, 18.0f}, (vec3){20.0f, 3.0f, -4.0f}, 0.7f);
}
