// SPDX-License-Identifier: MIT
// The terrain's height field: smooth noise on five lattices, a basin for the lake, level ground for
// each house. A function of place alone, so that finer grids show the same hills.
#include "scene/builtin/builtin_terrain.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <math.h>

static const double LAKE_DEPTH = 5.0, LOWEST_HILL = 3.0, HIGHEST_HILL = 30.0;
static const double PAD_LEVEL = 10.0, PAD_END = 17.0; // radii where level ground ends, hills begin

static const alpi_house HOUSES[ALPI_HOUSE_COUNT] = {
    {31.0f, 14.0f, 0.5f, 8.0f, 11.0f, 3.4f, 0.9f},  {36.0f, -9.0f, 1.9f, 7.0f, 9.5f, 5.6f, 0.85f},
    {52.0f, 4.0f, -0.2f, 8.0f, 12.0f, 5.8f, 0.8f},  {22.0f, -34.0f, 1.1f, 7.5f, 10.0f, 3.4f, 1.0f},
    {47.0f, -32.0f, 0.1f, 7.0f, 9.0f, 3.3f, 0.9f},  {50.0f, 31.0f, 1.2f, 7.5f, 11.0f, 5.6f, 0.85f},
    {20.0f, 36.0f, -0.5f, 7.0f, 10.0f, 3.4f, 0.95f}};

const alpi_house *alpi_terrain_houses(void)
{
    return HOUSES;
}

// --- heights -------------------------------------------------------------------------------------

/// 0 below `low`, 1 above `high`, without a kink.
static double smooth_step(double low, double high, double x)
{
    double t = fmin(1.0, fmax(0.0, (x - low) / (high - low)));
    return t * t * (3.0 - 2.0 * t);
}

static double lattice_value(int64_t x, int64_t z, uint32_t octave)
{
    return (double)alpi_unit_float(alpi_random_key((uint64_t)x, (uint64_t)z, octave));
}

/// Random values at whole coordinates, between them by quintics (Perlin 2002): [0, 1].
static double noise(double x, double z, uint32_t octave)
{
    double fx = floor(x), fz = floor(z), u = x - fx, v = z - fz;
    int64_t ix = (int64_t)fx, iz = (int64_t)fz;
    double s = u * u * u * (u * (6.0 * u - 15.0) + 10.0);
    double t = v * v * v * (v * (6.0 * v - 15.0) + 10.0);
    double low = lattice_value(ix, iz, octave) * (1.0 - s) + lattice_value(ix + 1, iz, octave) * s;
    double high =
        lattice_value(ix, iz + 1, octave) * (1.0 - s) + lattice_value(ix + 1, iz + 1, octave) * s;
    return low * (1.0 - t) + high * t;
}

/// Hills, higher away from the lake, and its basin.
static double hills(double x, double z)
{
    double sum = 0.0, weight = 1.0, all = 0.0, scale = 1.0 / 62.0;
    for (uint32_t octave = 0; octave < 5; octave++) {
        sum += weight * noise(x * scale + 17.0 * octave, z * scale, octave);
        all += weight;
        weight *= 0.42;
        scale *= 2.1;
    }
    double away = hypot(x - (double)ALPI_LAKE_X, z - (double)ALPI_LAKE_Z);
    double rise = 0.1 + 0.9 * smooth_step(30.0, 130.0, away);
    double height = LOWEST_HILL + rise * (HIGHEST_HILL - LOWEST_HILL) * (sum / all);
    double radius = (double)ALPI_LAKE_RADIUS, shore = smooth_step(0.6 * radius, 1.4 * radius, away);
    return -LAKE_DEPTH + (height + LAKE_DEPTH) * shore;
}

float alpi_terrain_pad(const alpi_house *house)
{
    return (float)hills((double)house->x, (double)house->z);
}

/// Level ground wins over hills, and over what slopes down from other houses: the weight of each is
/// its own level times what the others leave. Houses stand more than 2 PAD_LEVEL apart.
static double height_at(double x, double z)
{
    double level[ALPI_HOUSE_COUNT], left = 1.0;
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        double away = hypot(x - (double)HOUSES[i].x, z - (double)HOUSES[i].z);
        level[i] = 1.0 - smooth_step(PAD_LEVEL, PAD_END, away);
        left *= 1.0 - level[i];
    }
    double sum = left > 0.0 ? left * hills(x, z) : 0.0, weights = left;
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        double weight = level[i];
        for (int k = 0; k < ALPI_HOUSE_COUNT && weight > 0.0; k++) {
            weight *= k == i ? 1.0 : 1.0 - level[k];
        }
        if (weight > 0.0) {
            sum += weight * (double)alpi_terrain_pad(&HOUSES[i]);
            weights += weight;
        }
    }
    return sum / weights;
}

// --- the grid ------------------------------------------------------------------------------------

static float line_at(uint32_t i, uint32_t cells)
{
    return i == cells ? ALPI_GROUND_HALF
                      : ALPI_GROUND_HALF * (2.0f * (float)i / (float)cells - 1.0f);
}

alp_result alpi_terrain_make_ground(alp_context *context, uint32_t cells, alpi_ground **ground)
{
    *ground = ALPI_NEW(context, alpi_ground, 1);
    if (*ground == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    size_t side = (size_t)cells + 1;
    (*ground)->cells = cells;
    ALPI_TRY_NEW(context, (*ground)->heights, side * side);
    for (uint32_t j = 0; j <= cells; j++) {
        ALP_TRY(alpi_tick(context, "scene", j, cells));
        for (uint32_t i = 0; i <= cells; i++) {
            (*ground)->heights[j * side + i] =
                (float)height_at((double)line_at(i, cells), (double)line_at(j, cells));
        }
    }
    return ALP_OK;
}

void alpi_terrain_destroy_ground(alp_context *context, alpi_ground *ground)
{
    if (ground != NULL) {
        alpi_release(context, ground->heights);
        alpi_release(context, ground);
    }
}

static float vertex_height(const alpi_ground *ground, uint32_t i, uint32_t j)
{
    return ground->heights[(size_t)j * (ground->cells + 1) + i];
}

static void top_at(const void *shape, uint32_t i, uint32_t row, vec3 *position, vec3 *normal)
{
    const alpi_ground *g = shape;
    uint32_t n = g->cells, j = n - row; // x then −z: the top looks up
    *position = (vec3){line_at(i, n), vertex_height(g, i, j), line_at(j, n)};
    uint32_t left = i == 0 ? 0 : i - 1, right = i == n ? n : i + 1;
    uint32_t near = j == 0 ? 0 : j - 1, far = j == n ? n : j + 1;
    float across = line_at(right, n) - line_at(left, n), along = line_at(far, n) - line_at(near, n);
    *normal = (vec3){-(vertex_height(g, right, j) - vertex_height(g, left, j)) / across, 1.0f,
                     -(vertex_height(g, i, far) - vertex_height(g, i, near)) / along};
}

/// Vertex i on the way round the square, counter-clockwise seen from above (z is down there).
static vec3 border_point(const alpi_ground *ground, uint32_t i)
{
    uint32_t n = ground->cells, k = i % n;
    const uint32_t x[4] = {k, n, n - k, 0}, z[4] = {n, n - k, 0, k};
    uint32_t side = i / n % 4;
    return (vec3){line_at(x[side], n), vertex_height(ground, x[side], z[side]),
                  line_at(z[side], n)};
}

static void build_border(alpi_shaper *shaper, const alpi_ground *ground, uint32_t cells)
{
    if (shaper->counting) {
        shaper->triangle_count += 12 * (uint64_t)cells;
        return;
    }
    const vec3 middle = {0.0f, ALPI_GROUND_BOTTOM, 0.0f};
    for (uint32_t i = 0; i < 4 * cells; i++) {
        vec3 here = border_point(ground, i), next = border_point(ground, i + 1);
        vec3 below = {here.x, ALPI_GROUND_BOTTOM, here.z};
        vec3 below_next = {next.x, ALPI_GROUND_BOTTOM, next.z};
        alpi_shape_quad(shaper, (const vec3[4]){below, below_next, next, here});
        alpi_shape_triangle(shaper, middle, below_next, below);
    }
}

void alpi_terrain_build_ground(alpi_shaper *shaper, const alpi_ground *ground, uint32_t cells)
{
    alpi_shape_patch(
        shaper, &(alpi_patch){.u_count = cells, .v_count = cells, .at = top_at, .shape = ground});
    build_border(shaper, ground, cells);
}

float alpi_terrain_height(const alpi_ground *ground, float x, float z)
{
    float n = (float)ground->cells, size = 2.0f * ALPI_GROUND_HALF;
    float u = (x + ALPI_GROUND_HALF) / size * n, v = (z + ALPI_GROUND_HALF) / size * n;
    float column = fminf(fmaxf(floorf(u), 0.0f), n - 1.0f);
    float row = fminf(fmaxf(floorf(v), 0.0f), n - 1.0f);
    uint32_t i = (uint32_t)column, j = (uint32_t)row;
    float s = u - column, t = v - row;
    // Cells are cut from (i, j + 1) to (i + 1, j).
    float low = vertex_height(ground, i, j + 1), high = vertex_height(ground, i + 1, j);
    if (s + t > 1.0f) {
        float corner = vertex_height(ground, i + 1, j + 1);
        return corner + (1.0f - s) * (low - corner) + (1.0f - t) * (high - corner);
    }
    float corner = vertex_height(ground, i, j);
    return corner + s * (high - corner) + t * (low - corner);
}

static bool may_grow(float x, float z)
{
    for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
        if (hypotf(x - HOUSES[i].x, z - HOUSES[i].z) < 10.0f) {
            return false;
        }
    }
    return height_at((double)x, (double)z) > 0.7;
}

vec3 alpi_terrain_tree(const alpi_ground *ground, uint32_t tree)
{
    enum { ATTEMPTS = 64 }; // three in four places will do
    float x = 0.0f, z = 0.0f;
    for (uint32_t attempt = 0; attempt < ATTEMPTS; attempt++) {
        vec2 random = {alpi_unit_float(alpi_random_key(tree, attempt, 1)),
                       alpi_unit_float(alpi_random_key(tree, attempt, 2))};
        x = (2.0f * random.x - 1.0f) * (ALPI_GROUND_HALF - 4.0f);
        z = (2.0f * random.y - 1.0f) * (ALPI_GROUND_HALF - 4.0f);
        // Woods and clearings; a few trees stand alone.
        bool wood = noise((double)x / 38.0, (double)z / 38.0, 77) > 0.5 || attempt % 4 == 3;
        if (wood && may_grow(x, z)) {
            break;
        }
    }
    return (vec3){x, alpi_terrain_height(ground, x, z), z};
}
