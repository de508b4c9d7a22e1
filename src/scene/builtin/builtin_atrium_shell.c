// SPDX-License-Identifier: MIT
// The atrium's walls, floors, and what runs along their edges.
#include "scene/builtin/builtin_atrium.h"

#include <math.h>

static const float EDGE = 1.6f; // of flat cells, metres

// --- walls ---------------------------------------------------------------------------------------

/// Cells of a wall along one axis: outer face, back of the niches, inner face, then two planes a
/// bay (the sides of its opening), and the same backwards.
enum { BAYS_LIMIT = ALPI_ATRIUM_X_BAYS + 2, CUTS_LIMIT = 2 * BAYS_LIMIT + 6 };

typedef struct ring {
    uint32_t x_count, z_count; // of cuts
    bool windows;
} ring;

static uint32_t cut_wall(float *cuts, float half, uint32_t bays)
{
    uint32_t count = 0;
    const float outside[3] = {half + ALPI_ATRIUM_OUTER_WALL, half + 0.25f, half};
    for (int i = 0; i < 3; i++) {
        cuts[count++] = -outside[i];
    }
    for (uint32_t i = 0; i < bays; i++) {
        float middle = ALPI_ATRIUM_BAY * ((float)i + 0.5f - 0.5f * (float)bays);
        cuts[count++] = middle - 0.65f;
        cuts[count++] = middle + 0.65f;
    }
    for (int i = 2; i >= 0; i--) {
        cuts[count++] = outside[i];
    }
    return count;
}

/// Whether cell i along a wall is an opening: every other one between the inner faces.
static bool is_opening(uint32_t i, uint32_t count)
{
    return i >= 3 && i + 4 < count && i % 2 == 1;
}

/// How deep a cell is in the wall: 0 = not, 1 = next to the gallery, 2 = outside.
static int depth_in_wall(uint32_t i, uint32_t count)
{
    uint32_t from_end = i < count - 2 - i ? i : count - 2 - i;
    return from_end == 0 ? 2 : from_end == 1 ? 1 : 0;
}

static bool ring_is_solid(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    const ring *r = user;
    int in_x = depth_in_wall(x, r->x_count), in_z = depth_in_wall(z, r->z_count);
    if (in_x == 0 && in_z == 0) {
        return false;
    }
    bool opening = (in_x > 0 && in_z == 0 && is_opening(z, r->z_count)) ||
                   (in_z > 0 && in_x == 0 && is_opening(x, r->x_count));
    if (!opening) {
        return true;
    }
    int depth = in_x > in_z ? in_x : in_z;
    if (r->windows) {
        return y != 1;
    }
    bool door = in_x > 0 && 2 * z + 2 == r->z_count; // in the middle of the short sides
    return y == 2 || (!door && (y == 0 || depth == 2));
}

void alpi_atrium_build_walls(alpi_shaper *shaper, float low, float high, bool windows)
{
    float x[CUTS_LIMIT], z[CUTS_LIMIT];
    const float y[4] = {low, low + 0.9f, low + 3.0f, high};
    ring r = {.windows = windows};
    r.x_count = cut_wall(x, ALPI_ATRIUM_HALF_X + ALPI_ATRIUM_GALLERY, ALPI_ATRIUM_X_BAYS + 2);
    r.z_count = cut_wall(z, ALPI_ATRIUM_HALF_Z + ALPI_ATRIUM_GALLERY, ALPI_ATRIUM_Z_BAYS + 2);
    alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {x, y, z},
                                             .counts = {r.x_count, 4, r.z_count},
                                             .solid = ring_is_solid,
                                             .user = &r,
                                             .edge = EDGE});
}

// --- floors --------------------------------------------------------------------------------------

static bool is_not_middle(const void *user, uint32_t x, uint32_t y, uint32_t z)
{
    (void)user;
    (void)y;
    return x != 1 || z != 1;
}

/// A slab with the court left out, `inset` metres inside the columns' axes.
static void build_slab(alpi_shaper *shaper, float low, float high, float inset, float beyond)
{
    float outer_x = ALPI_ATRIUM_HALF_X + ALPI_ATRIUM_GALLERY + beyond;
    float outer_z = ALPI_ATRIUM_HALF_Z + ALPI_ATRIUM_GALLERY + beyond;
    float inner_x = ALPI_ATRIUM_HALF_X - inset, inner_z = ALPI_ATRIUM_HALF_Z - inset;
    const float x[4] = {-outer_x, -inner_x, inner_x, outer_x};
    const float y[2] = {low, high};
    const float z[4] = {-outer_z, -inner_z, inner_z, outer_z};
    alpi_shape_blocks(
        shaper, &(alpi_blocks){
                    .cuts = {x, y, z}, .counts = {4, 2, 4}, .solid = is_not_middle, .edge = EDGE});
}

void alpi_atrium_build_floors(alpi_shaper *shaper, const alpi_atrium_materials *materials)
{
    const float half_x = ALPI_ATRIUM_HALF_X - ALPI_ATRIUM_COURT;
    const float half_z = ALPI_ATRIUM_HALF_Z - ALPI_ATRIUM_COURT;
    const float x[2] = {-half_x, half_x}, y[2] = {-0.6f, -0.36f}, z[2] = {-half_z, half_z};
    alpi_shaper_surface(shaper, "court", materials->paving);
    alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {x, y, z}, .counts = {2, 2, 2}, .edge = 0.8f});
    alpi_shaper_surface(shaper, "gallery floor", materials->paving);
    build_slab(shaper, -0.6f, 0.0f, ALPI_ATRIUM_COURT, 0.5f);
    // Two steps all round, the upper one on the lower.
    for (int i = 0; i < 2; i++) {
        float inner = 0.35f * (float)(2 - i), top = -0.36f + 0.12f * (float)(i + 1);
        const float ring_x[4] = {-half_x, -half_x + inner, half_x - inner, half_x};
        const float ring_y[2] = {top - 0.12f, top};
        const float ring_z[4] = {-half_z, -half_z + inner, half_z - inner, half_z};
        alpi_shaper_surface(shaper, i == 0 ? "lower step" : "upper step", materials->stone);
        alpi_shape_blocks(shaper, &(alpi_blocks){.cuts = {ring_x, ring_y, ring_z},
                                                 .counts = {4, 2, 4},
                                                 .solid = is_not_middle,
                                                 .edge = EDGE});
    }
    alpi_shaper_surface(shaper, "upper floor", materials->paving);
    build_slab(shaper, ALPI_ATRIUM_CEILING, ALPI_ATRIUM_UPPER, 0.42f, 0.5f);
    alpi_shaper_surface(shaper, "roof", materials->clay);
    build_slab(shaper, ALPI_ATRIUM_EAVES, ALPI_ATRIUM_ROOF, 0.42f, 0.7f);
}

// --- along the edges -----------------------------------------------------------------------------

/// Under a slab's edge, reaching into the wall and the slab; `out` is towards the court.
static const alpi_profile_point CORNICE[] = {
    {0.15f, -0.42f, 0.0f}, {0.28f, -0.42f, 0.0f}, {0.28f, -0.36f, -0.25f}, {0.36f, -0.22f, 0.0f},
    {0.39f, -0.22f, 0.0f}, {0.39f, -0.16f, 0.3f}, {0.47f, -0.05f, 0.0f},   {0.5f, -0.05f, 0.0f},
    {0.5f, 0.08f, 0.0f},   {0.15f, 0.08f, 0.0f},
};

static void build_dentils(alpi_shaper *shaper, float height)
{
    for (int side = 0; side < 4; side++) {
        bool at_x = side % 2 == 1;
        float length = 2.0f * ((at_x ? ALPI_ATRIUM_HALF_Z : ALPI_ATRIUM_HALF_X) - 0.4f);
        float away = at_x ? ALPI_ATRIUM_HALF_X : ALPI_ATRIUM_HALF_Z;
        uint32_t count = alpi_shaper_cells(shaper, (double)length, 0.36);
        uint32_t most = (uint32_t)(length / 0.16f);
        count = count < most ? count : most;
        float distance = length / (float)count, half = fminf(0.25f * distance, 0.07f);
        static const float SINES[4] = {0.0f, 1.0f, 0.0f, -1.0f};
        static const float COSINES[4] = {1.0f, 0.0f, -1.0f, 0.0f};
        alpi_shaper_place(shaper, (vec3){-away * SINES[side], height, -away * COSINES[side]},
                          0.5 * ALPI_PI * side);
        for (uint32_t i = 0; i < count; i++) {
            float middle = distance * ((float)i + 0.5f) - 0.5f * length;
            alpi_shape_box(shaper, (vec3){middle - half, -0.35f, 0.2f},
                           (vec3){middle + half, -0.2f, 0.365f});
        }
    }
    alpi_shaper_place(shaper, (vec3){0.0f, 0.0f, 0.0f}, 0.0);
}

static void build_cornice(alpi_shaper *shaper, float height)
{
    alpi_shaper_place(shaper, (vec3){0.0f, height, 0.0f}, 0.0);
    alpi_shape_cornice(shaper, CORNICE, sizeof CORNICE / sizeof *CORNICE, ALPI_ATRIUM_HALF_X,
                       ALPI_ATRIUM_HALF_Z);
    build_dentils(shaper, height);
}

static const alpi_profile_point BALUSTER[] = {
    {0.0f, 0.1f, 0.0f},    {0.06f, 0.1f, 0.0f},  {0.06f, 0.16f, 0.0f}, {0.04f, 0.18f, 0.22f},
    {0.035f, 0.5f, -0.1f}, {0.03f, 0.74f, 0.5f}, {0.03f, 0.8f, 0.0f},  {0.055f, 0.83f, 0.0f},
    {0.055f, 0.9f, 0.0f},  {0.0f, 0.9f, 0.0f},
};

/// Between neighbouring supports of the upper storey: a foot, balusters and a rail.
static void build_balustrade(alpi_shaper *shaper)
{
    uint32_t count = (uint32_t)fmin(10.0, fmax(2.0, 8.0 * shaper->fineness));
    for (int side = 0; side < 4; side++) {
        bool at_x = side % 2 == 1;
        uint32_t bays = at_x ? ALPI_ATRIUM_Z_BAYS : ALPI_ATRIUM_X_BAYS;
        float away = at_x ? ALPI_ATRIUM_HALF_X : ALPI_ATRIUM_HALF_Z;
        for (uint32_t bay = 0; bay < bays; bay++) {
            float along = ALPI_ATRIUM_BAY * ((float)bay + 0.5f - 0.5f * (float)bays);
            const vec3 middles[4] = {{along, ALPI_ATRIUM_UPPER, -away},
                                     {-away, ALPI_ATRIUM_UPPER, -along},
                                     {-along, ALPI_ATRIUM_UPPER, away},
                                     {away, ALPI_ATRIUM_UPPER, along}};
            double yaw = 0.5 * ALPI_PI * side;
            alpi_shaper_place(shaper, middles[side], yaw);
            const float half = 0.5f * ALPI_ATRIUM_BAY - 0.21f; // reaches into the shafts
            alpi_shape_bevelled_box(shaper, (vec3){-half, 0.0f, -0.1f}, (vec3){half, 0.1f, 0.1f},
                                    0.01f);
            alpi_shape_bevelled_box(shaper, (vec3){-half, 0.9f, -0.11f}, (vec3){half, 1.0f, 0.11f},
                                    0.025f);
            for (uint32_t i = 0; i < count; i++) {
                float at = 2.3f * (((float)i + 0.5f) / (float)count - 0.5f);
                vec3 foot = middles[side];
                foot.x += side % 2 == 0 ? at : 0.0f;
                foot.z += side % 2 == 1 ? at : 0.0f;
                alpi_shaper_place(shaper, foot, yaw);
                alpi_shape_turned(shaper, BALUSTER, sizeof BALUSTER / sizeof *BALUSTER, 6.0);
            }
        }
    }
    alpi_shaper_place(shaper, (vec3){0.0f, 0.0f, 0.0f}, 0.0);
}

/// A low wall round the court on the roof, with a coping.
static void build_parapet(alpi_shaper *shaper)
{
    static const alpi_profile_point SECTION[] = {
        {-0.1f, 0.0f, 0.0f},   {0.15f, 0.0f, 0.0f},    {0.15f, 0.5f, 0.0f},   {0.22f, 0.55f, 0.35f},
        {0.22f, 0.65f, 0.15f}, {-0.17f, 0.65f, 0.35f}, {-0.17f, 0.55f, 0.0f}, {-0.1f, 0.5f, 0.0f}};
    alpi_shaper_place(shaper, (vec3){0.0f, ALPI_ATRIUM_ROOF, 0.0f}, 0.0);
    alpi_shape_cornice(shaper, SECTION, sizeof SECTION / sizeof *SECTION, ALPI_ATRIUM_HALF_X,
                       ALPI_ATRIUM_HALF_Z);
    alpi_shaper_place(shaper, (vec3){0.0f, 0.0f, 0.0f}, 0.0);
}

void alpi_atrium_build_ornaments(alpi_shaper *shaper, const alpi_atrium_materials *materials)
{
    alpi_shaper_surface(shaper, "cornices", materials->stone);
    build_cornice(shaper, ALPI_ATRIUM_CEILING);
    build_cornice(shaper, ALPI_ATRIUM_EAVES);
    alpi_shaper_surface(shaper, "balustrade", materials->marble);
    build_balustrade(shaper);
    alpi_shaper_surface(shaper, "parapet", materials->plaster);
    build_parapet(shaper);
}
