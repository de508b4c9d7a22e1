// SPDX-License-Identifier: MIT
// In the atrium's court: a fountain in the middle and a tree in a pot in each corner.
#include "base/random.h"
#include "scene/builtin/builtin_atrium.h"

#include <math.h>

static const float COURT = -0.36f; // height of its paving
static const vec3 ORIGIN = {0.0f, 0.0f, 0.0f};

static const alpi_profile_point BASIN[] = {
    {0.0f, 0.0f, 0.0f},   {1.75f, 0.0f, 0.0f},  {1.75f, 0.1f, 0.0f},  {1.6f, 0.12f, -0.15f},
    {1.62f, 0.42f, 0.0f}, {1.72f, 0.45f, 0.5f}, {1.72f, 0.55f, 0.0f}, {1.48f, 0.55f, 0.0f},
    {1.45f, 0.2f, 0.1f},  {0.0f, 0.2f, 0.0f},
};
static const alpi_profile_point STEM[] = {
    {0.0f, 0.15f, 0.0f},   {0.3f, 0.15f, 0.0f},  {0.3f, 0.5f, -0.2f},  {0.12f, 0.7f, 0.15f},
    {0.1f, 1.1f, -0.15f},  {0.3f, 1.28f, 0.2f},  {0.72f, 1.42f, 0.5f}, {0.72f, 1.48f, 0.0f},
    {0.66f, 1.48f, 0.15f}, {0.12f, 1.34f, 0.0f}, {0.08f, 1.5f, 0.3f},  {0.05f, 1.75f, 0.55f},
    {0.0f, 1.87f, 0.0f},
};
/// Water in the basin and in the bowl: flat discs whose rims lie inside the stone.
static const alpi_profile_point LOW_WATER[] = {
    {0.0f, 0.3f, 0.0f}, {1.5f, 0.3f, 0.0f}, {1.5f, 0.42f, 0.0f}, {0.0f, 0.42f, 0.0f}};
static const alpi_profile_point HIGH_WATER[] = {
    {0.0f, 1.41f, 0.0f}, {0.6f, 1.41f, 0.0f}, {0.6f, 1.45f, 0.0f}, {0.0f, 1.45f, 0.0f}};

static const alpi_profile_point POT[] = {
    {0.0f, 0.0f, 0.0f},    {0.26f, 0.0f, 0.0f},  {0.26f, 0.05f, 0.0f}, {0.24f, 0.06f, 0.1f},
    {0.38f, 0.55f, 0.0f},  {0.42f, 0.56f, 0.4f}, {0.42f, 0.64f, 0.0f}, {0.36f, 0.64f, 0.0f},
    {0.34f, 0.56f, 0.06f}, {0.0f, 0.58f, 0.0f}};
static const alpi_profile_point TRUNK[] = {
    {0.0f, 0.5f, 0.0f}, {0.07f, 0.5f, -0.02f}, {0.045f, 2.1f, 0.0f}, {0.0f, 2.3f, 0.0f}};

#define COUNT(points) ((uint32_t)(sizeof(points) / sizeof *(points)))

static void build_fountain(alpi_shaper *shaper, const alpi_atrium_materials *materials)
{
    alpi_shaper_place(shaper, (vec3){0.0f, COURT, 0.0f}, 0.0);
    alpi_shaper_surface(shaper, "fountain", materials->stone);
    alpi_shape_turned(shaper, BASIN, COUNT(BASIN), 28.0);
    alpi_shape_turned(shaper, STEM, COUNT(STEM), 20.0);
    alpi_shaper_surface(shaper, "water", materials->water);
    alpi_shape_turned(shaper, LOW_WATER, COUNT(LOW_WATER), 28.0);
    alpi_shape_turned(shaper, HIGH_WATER, COUNT(HIGH_WATER), 20.0);
}

static void place_tree(alpi_shaper *shaper, int tree)
{
    float x = ALPI_ATRIUM_HALF_X - 2.2f, z = ALPI_ATRIUM_HALF_Z - 2.2f;
    alpi_shaper_place(shaper, (vec3){tree & 1 ? x : -x, COURT, tree & 2 ? z : -z}, 0.0);
}

/// Three numbers in (−1, 1) that belong to a leaf.
static vec3 random_vector(int tree, uint32_t leaf, uint32_t stream)
{
    float v[3];
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t key = alpi_random_key((uint64_t)tree, leaf, 4 * stream + k);
        v[k] = 2.0f * alpi_unit_float(key) - 1.0f;
    }
    return vec3_load(v);
}

/// A leaf near the surface of the crown, turned outwards more or less; smaller where they are many.
static void build_leaf(alpi_shaper *shaper, int tree, uint32_t leaf, float size)
{
    if (shaper->counting) { // the place does not matter
        alpi_shape_leaf(shaper, ORIGIN, ORIGIN, ORIGIN, 0.0f);
        return;
    }
    vec3 up = {0.0f, 1.0f, 0.0f};
    vec3 out = vec3_normalize_or(random_vector(tree, leaf, 0), up);
    vec3 spread = random_vector(tree, leaf, 1);
    vec3 normal = vec3_normalize_or(vec3_mad(out, 0.6f, spread), up);
    vec3 along, across;
    vec3_frame(normal, &along, &across);
    double angle = ALPI_PI * (double)random_vector(tree, leaf, 2).x;
    float c = (float)cos(angle), s = (float)sin(angle);
    vec3 tip = vec3_add(vec3_scale(along, c), vec3_scale(across, s));
    vec3 middle = vec3_scale(out, 0.62f + 0.14f * spread.y);
    middle.y = 2.55f + 1.1f * middle.y;
    alpi_shape_leaf(shaper, middle, vec3_scale(tip, size),
                    vec3_scale(vec3_cross(normal, tip), 0.45f * size), 0.1f * size);
}

static void build_trees(alpi_shaper *shaper, const alpi_atrium_materials *materials)
{
    alpi_shaper_surface(shaper, "pots", materials->clay);
    for (int tree = 0; tree < 4; tree++) {
        place_tree(shaper, tree);
        alpi_shape_turned(shaper, POT, COUNT(POT), 18.0);
    }
    alpi_shaper_surface(shaper, "trunks", materials->wood);
    for (int tree = 0; tree < 4; tree++) {
        place_tree(shaper, tree);
        alpi_shape_turned(shaper, TRUNK, COUNT(TRUNK), 10.0);
    }
    alpi_shaper_surface(shaper, "leaves", materials->leaf);
    uint32_t leaves = (uint32_t)(130.0 * pow(shaper->fineness, 1.8)) + 20;
    float size = fminf(0.16f, 2.0f / sqrtf((float)leaves));
    for (int tree = 0; tree < 4; tree++) {
        place_tree(shaper, tree);
        for (uint32_t leaf = 0; leaf < leaves; leaf++) {
            build_leaf(shaper, tree, leaf, size);
        }
    }
    alpi_shaper_place(shaper, ORIGIN, 0.0);
}

void alpi_atrium_build_garden(alpi_shaper *shaper, const alpi_atrium_materials *materials)
{
    build_fountain(shaper, materials);
    build_trees(shaper, materials);
}
