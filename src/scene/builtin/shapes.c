// SPDX-License-Identifier: MIT
// Solids with flat faces, and what all solids share: placing, counting, grids of vertices.
#include "scene/builtin/shapes.h"

#include "base/tasks.h"

#include <math.h>

alpi_shaper alpi_shaper_start(alpi_builder *builder, double fineness)
{
    return (alpi_shaper){
        .builder = builder, .fineness = fineness, .cosine = 1.0f, .counting = builder == NULL};
}

void alpi_shaper_place(alpi_shaper *shaper, vec3 origin, double yaw)
{
    double quarters = yaw / (0.5 * ALPI_PI), c = cos(yaw), s = sin(yaw);
    bool exact = fabs(quarters - round(quarters)) < 1e-9;
    shaper->origin = origin;
    shaper->cosine = (float)(exact ? round(c) : c);
    shaper->sine = (float)(exact ? round(s) : s);
}

void alpi_shaper_surface(alpi_shaper *shaper, const char *name, uint32_t material)
{
    if (!shaper->counting) {
        alpi_builder_surface(shaper->builder, name, material);
    }
}

static uint64_t count_at(alpi_shaper_fn *build, const void *user, double fineness)
{
    alpi_shaper shaper = alpi_shaper_start(NULL, fineness);
    build(&shaper, user);
    return shaper.triangle_count;
}

double alpi_shaper_fit(alpi_shaper_fn *build, const void *user, double low, double high,
                       uint64_t wanted)
{
    enum { HALVINGS = 24 }; // far finer than the steps of the count
    for (int i = 0; i < HALVINGS; i++) {
        double middle = sqrt(low * high);
        if (count_at(build, user, middle) < wanted) {
            low = middle;
        } else {
            high = middle;
        }
    }
    uint64_t below = count_at(build, user, low), above = count_at(build, user, high);
    return above > wanted && below < wanted && wanted - below < above - wanted ? low : high;
}

uint32_t alpi_shaper_divide(const alpi_shaper *shaper, double count, uint32_t least)
{
    double cells = floor(count * shaper->fineness + 0.5);
    return cells > (double)least ? (uint32_t)cells : least;
}

uint32_t alpi_shaper_cells(const alpi_shaper *shaper, double length, double edge)
{
    return alpi_shaper_divide(shaper, length / edge, 1);
}

static vec3 turned(const alpi_shaper *shaper, vec3 v)
{
    return (vec3){shaper->cosine * v.x + shaper->sine * v.z, v.y,
                  shaper->cosine * v.z - shaper->sine * v.x};
}

static uint32_t add_vertex(alpi_shaper *shaper, vec3 position, vec3 normal)
{
    vec3 unit = vec3_normalize_or(normal, (vec3){0.0f, 1.0f, 0.0f});
    return alpi_builder_vertex(shaper->builder, vec3_add(shaper->origin, turned(shaper, position)),
                               turned(shaper, unit));
}

void alpi_shape_triangle(alpi_shaper *shaper, vec3 a, vec3 b, vec3 c)
{
    shaper->triangle_count++;
    if (shaper->counting) {
        return;
    }
    vec3 normal = vec3_triangle_normal(a, b, c, (vec3){0.0f, 1.0f, 0.0f});
    uint32_t v[3] = {add_vertex(shaper, a, normal), add_vertex(shaper, b, normal),
                     add_vertex(shaper, c, normal)};
    alpi_builder_triangle(shaper->builder, v[0], v[1], v[2]);
}

void alpi_shape_quad(alpi_shaper *shaper, const vec3 corners[4])
{
    alpi_shape_panel(shaper, corners, 1, 1);
}

// --- grids ---------------------------------------------------------------------------------------

static bool work_goes_on(alpi_shaper *shaper)
{
    alpi_builder *builder = shaper->builder;
    if (builder->result == ALP_OK) {
        builder->result =
            alpi_tick(builder->context, "scene", shaper->triangle_count, shaper->triangle_count);
    }
    return builder->result == ALP_OK;
}

static uint32_t add_row(alpi_shaper *shaper, const alpi_patch *patch, uint32_t j)
{
    uint32_t count = patch->u_count + (patch->closed ? 0 : 1), first = 0;
    for (uint32_t i = 0; i < count; i++) {
        vec3 position, normal;
        patch->at(patch->shape, i, j, &position, &normal);
        uint32_t vertex = add_vertex(shaper, position, normal);
        first = i == 0 ? vertex : first;
    }
    return first;
}

void alpi_shape_patch(alpi_shaper *shaper, const alpi_patch *patch)
{
    uint64_t ends = (patch->low_point ? 1u : 0u) + (patch->high_point ? 1u : 0u);
    shaper->triangle_count += patch->u_count * (2 * (uint64_t)patch->v_count - ends);
    if (shaper->counting || !work_goes_on(shaper)) {
        return;
    }
    uint32_t low = add_row(shaper, patch, 0);
    for (uint32_t j = 0; j < patch->v_count; j++) {
        uint32_t high = add_row(shaper, patch, j + 1);
        for (uint32_t i = 0; i < patch->u_count; i++) {
            uint32_t next = patch->closed && i + 1 == patch->u_count ? 0 : i + 1;
            if (!(patch->low_point && j == 0)) {
                alpi_builder_triangle(shaper->builder, low + i, low + next, high + next);
            }
            if (!(patch->high_point && j + 1 == patch->v_count)) {
                alpi_builder_triangle(shaper->builder, low + i, high + next, high + i);
            }
        }
        low = high;
    }
}

/// Part i/n of the way from a to b, exact at both ends.
static float between(float a, float b, uint32_t i, uint32_t n)
{
    return i == 0 ? a : i == n ? b : a + (b - a) * ((float)i / (float)n);
}

static vec3 between_points(vec3 a, vec3 b, uint32_t i, uint32_t n)
{
    return (vec3){between(a.x, b.x, i, n), between(a.y, b.y, i, n), between(a.z, b.z, i, n)};
}

typedef struct panel {
    const vec3 *corners;
    uint32_t u_count, v_count;
    vec3 normal;
} panel;

static void panel_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const panel *p = shape;
    vec3 left = between_points(p->corners[0], p->corners[3], j, p->v_count);
    vec3 right = between_points(p->corners[1], p->corners[2], j, p->v_count);
    *position = between_points(left, right, i, p->u_count);
    *normal = p->normal;
}

void alpi_shape_panel(alpi_shaper *shaper, const vec3 corners[4], uint32_t u_count,
                      uint32_t v_count)
{
    vec3 normal = vec3_cross(vec3_sub(corners[2], corners[0]), vec3_sub(corners[3], corners[1]));
    const panel p = {corners, u_count, v_count, normal};
    alpi_shape_patch(
        shaper, &(alpi_patch){.u_count = u_count, .v_count = v_count, .at = panel_at, .shape = &p});
}

// --- blocks --------------------------------------------------------------------------------------

static bool cell_is_solid(const alpi_blocks *blocks, const int64_t cell[3])
{
    for (int axis = 0; axis < 3; axis++) {
        if (cell[axis] < 0 || cell[axis] + 1 >= (int64_t)blocks->counts[axis]) {
            return false;
        }
    }
    return blocks->solid == NULL ||
           blocks->solid(blocks->user, (uint32_t)cell[0], (uint32_t)cell[1], (uint32_t)cell[2]);
}

static uint32_t block_cells(const alpi_shaper *shaper, const alpi_blocks *blocks, int axis,
                            int64_t cell)
{
    const float *cut = &blocks->cuts[axis][cell];
    return alpi_shaper_cells(shaper, (double)(cut[1] - cut[0]), (double)blocks->edge);
}

/// The side of a cell towards ±axis.
static void build_block_side(alpi_shaper *shaper, const alpi_blocks *blocks, const int64_t cell[3],
                             int axis, bool high)
{
    // Cyclic order gives a normal along +axis; the other way round on the low side.
    int u = (axis + (high ? 1 : 2)) % 3, v = (axis + (high ? 2 : 1)) % 3;
    static const bool AT_HIGH_U[4] = {false, true, true, false};
    static const bool AT_HIGH_V[4] = {false, false, true, true};
    vec3 corners[4];
    for (int k = 0; k < 4; k++) {
        float point[3];
        point[axis] = blocks->cuts[axis][cell[axis] + (high ? 1 : 0)];
        point[u] = blocks->cuts[u][cell[u] + (AT_HIGH_U[k] ? 1 : 0)];
        point[v] = blocks->cuts[v][cell[v] + (AT_HIGH_V[k] ? 1 : 0)];
        corners[k] = vec3_load(point);
    }
    alpi_shape_panel(shaper, corners, block_cells(shaper, blocks, u, cell[u]),
                     block_cells(shaper, blocks, v, cell[v]));
}

static void build_block(alpi_shaper *shaper, const alpi_blocks *blocks, const int64_t cell[3])
{
    for (int axis = 0; axis < 3; axis++) {
        for (int high = 0; high < 2; high++) {
            int64_t neighbour[3] = {cell[0], cell[1], cell[2]};
            neighbour[axis] += high ? 1 : -1;
            if (!cell_is_solid(blocks, neighbour)) {
                build_block_side(shaper, blocks, cell, axis, high == 1);
            }
        }
    }
}

void alpi_shape_blocks(alpi_shaper *shaper, const alpi_blocks *blocks)
{
    int64_t cell[3];
    for (cell[2] = 0; cell[2] + 1 < (int64_t)blocks->counts[2]; cell[2]++) {
        for (cell[1] = 0; cell[1] + 1 < (int64_t)blocks->counts[1]; cell[1]++) {
            for (cell[0] = 0; cell[0] + 1 < (int64_t)blocks->counts[0]; cell[0]++) {
                if (cell_is_solid(blocks, cell)) {
                    build_block(shaper, blocks, cell);
                }
            }
        }
    }
}

void alpi_shape_box(alpi_shaper *shaper, vec3 low, vec3 high)
{
    const float x[2] = {low.x, high.x}, y[2] = {low.y, high.y}, z[2] = {low.z, high.z};
    alpi_shape_blocks(shaper,
                      &(alpi_blocks){.cuts = {x, y, z}, .counts = {2, 2, 2}, .edge = HUGE_VALF});
}

/// Corner of a bevelled box: towards side[k] on axis k, on the face of axis `face`.
static vec3 bevel_corner(vec3 low, vec3 high, float bevel, const bool side[3], int face)
{
    const float lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    float point[3];
    for (int k = 0; k < 3; k++) {
        float inset = k == face ? 0.0f : bevel;
        point[k] = side[k] ? highs[k] - inset : lows[k] + inset;
    }
    return vec3_load(point);
}

static void build_bevel_faces(alpi_shaper *shaper, vec3 low, vec3 high, float bevel)
{
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        bool outer = face % 2 == 1;
        vec3 corners[4];
        for (int k = 0; k < 4; k++) {
            bool side[3];
            bool first = k == 1 || k == 2, second = k >= 2;
            side[axis] = outer;
            side[u] = outer ? first : second;
            side[v] = outer ? second : first;
            corners[k] = bevel_corner(low, high, bevel, side, axis);
        }
        alpi_shape_quad(shaper, corners);
    }
}

/// The strips along `axis` between the faces of the other two.
static void build_bevel_edges(alpi_shaper *shaper, vec3 low, vec3 high, float bevel, int axis)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int k = 0; k < 4; k++) {
        bool side[3], far_side[3];
        side[u] = k & 1;
        side[v] = (k & 2) != 0;
        far_side[u] = side[u];
        far_side[v] = side[v];
        side[axis] = side[u] != side[v]; // the way along the axis that looks outside
        far_side[axis] = !side[axis];
        const vec3 corners[4] = {bevel_corner(low, high, bevel, side, u),
                                 bevel_corner(low, high, bevel, side, v),
                                 bevel_corner(low, high, bevel, far_side, v),
                                 bevel_corner(low, high, bevel, far_side, u)};
        alpi_shape_quad(shaper, corners);
    }
}

void alpi_shape_bevelled_box(alpi_shaper *shaper, vec3 low, vec3 high, float bevel)
{
    if (shaper->fineness < ALPI_BEVEL_FINENESS) {
        alpi_shape_box(shaper, low, high);
        return;
    }
    build_bevel_faces(shaper, low, high, bevel);
    for (int axis = 0; axis < 3; axis++) {
        build_bevel_edges(shaper, low, high, bevel, axis);
    }
    for (int k = 0; k < 8; k++) {
        const bool side[3] = {(k & 1) != 0, (k & 2) != 0, (k & 4) != 0};
        bool odd = side[0] ^ side[1] ^ side[2]; // mirrored or not
        vec3 x = bevel_corner(low, high, bevel, side, 0),
             y = bevel_corner(low, high, bevel, side, 1),
             z = bevel_corner(low, high, bevel, side, 2);
        alpi_shape_triangle(shaper, x, odd ? y : z, odd ? z : y);
    }
}
