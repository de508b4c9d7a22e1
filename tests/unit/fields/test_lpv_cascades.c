// SPDX-License-Identifier: MIT
// Grids inside grids: which map lights which, no seams in space, and no jumps in time while the
// camera moves.
#include "field_scenes.h"
#include "lpv_volumes.h"

#include "base/random.h"

TEST_CONTEXT(2);

static alp_lpv *open_volume(uint32_t side, double cell, uint32_t cascades, bool blockers)
{
    alp_lpv_options o = lpv_cube(side, cell);
    o.cascades = cascades;
    o.iterations = 8;
    o.blockers = blockers;
    return lpv_open(context, o);
}

static double flux_in(const alp_lpv *lpv, uint32_t cascade)
{
    return lpv_flux(&lpv->grids[cascade], lpv->grids[cascade].injected);
}

// --- a floor under a sun -------------------------------------------------------------------------

enum { MOST = 1 << 17 };
static struct {
    float positions[MOST][3], normals[MOST][3], flux[MOST][3], areas[MOST], albedo[MOST][3];
    uint32_t count;
} map;

static alp_lpv_surfels map_view(void)
{
    return (alp_lpv_surfels){.count = map.count,
                             .positions = (const float(*)[3])map.positions,
                             .normals = (const float(*)[3])map.normals,
                             .flux = (const float(*)[3])map.flux,
                             .areas = map.areas,
                             .albedo = (const float(*)[3])map.albedo};
}

/// The map of a cascade: surfels of a floor at y = 0, `dense` along each side of a cell, each at a
/// place of its own in the world. Tiles of 1 m have one of two albedos.
static void make_map(const alp_lpv *lpv, uint32_t cascade, int dense, bool even)
{
    const alpi_lpv_grid *g = &lpv->grids[cascade];
    const double step = g->cell / dense;
    const int64_t x0 = g->corner[0] * dense, z0 = g->corner[2] * dense;
    const int64_t nx = (int64_t)g->size[0] * dense, nz = (int64_t)g->size[2] * dense;
    map.count = 0;
    for (int64_t i = 0; i < nx * nz; i++) {
        const int64_t x = x0 + i % nx, z = z0 + i / nx;
        const uint32_t noise =
            alpi_hash32((uint32_t)x * 9781u ^ alpi_hash32((uint32_t)z + cascade));
        const double px = step * ((double)x + (even ? 0.5 : (double)(noise & 0xffff) / 65536.0));
        const double pz = step * ((double)z + (even ? 0.5 : (double)(noise >> 16) / 65536.0));
        const bool light = (((int64_t)floor(px) + (int64_t)floor(pz)) & 1) != 0;
        const float albedo = even ? 0.5f : light ? 0.8f : 0.2f;
        assert_true(map.count < MOST);
        const float position[3] = {(float)px, 0.0f, (float)pz}, up[3] = {0.0f, 1.0f, 0.0f};
        memcpy(map.positions[map.count], position, sizeof position);
        memcpy(map.normals[map.count], up, sizeof up);
        map.areas[map.count] = (float)(step * step);
        for (int k = 0; k < 3; k++) {
            map.albedo[map.count][k] = albedo;
            map.flux[map.count][k] = albedo * (float)(step * step);
        }
        map.count++;
    }
}

static void light_floor(alp_lpv *lpv, int dense)
{
    alp_lpv_begin(lpv);
    for (uint32_t c = 0; c < lpv->options.cascades; c++) {
        make_map(lpv, c, dense, false);
        const alp_lpv_surfels s = map_view();
        ASSERT_OK(context, alp_lpv_add_light(lpv, c, &s));
        if (lpv->options.blockers) {
            ASSERT_OK(context, alp_lpv_add_blockers(lpv, c, &s));
        }
    }
    ASSERT_OK(context, alp_lpv_propagate(lpv));
}

// --- which map lights which grid -----------------------------------------------------------------

/// Flux of the coarsest grid of 8 × 8 cells on an even floor: all but what fades in its last cell,
/// by a fine sum.
static double expected_flux(const alp_lpv *lpv)
{
    enum { FINE = 32 };
    const alpi_lpv_grid *g = &lpv->grids[2];
    double centre[3], sum = 0.0;
    alpi_lpv_ideal_centre(lpv, 2, centre);
    for (int i = 0; i < 64 * FINE * FINE; i++) {
        const double x = (i % (8 * FINE) + 0.5) / FINE, z = (i / (8 * FINE) + 0.5) / FINE;
        const double away = fmax(fabs(x + (double)g->corner[0] - centre[0] / g->cell),
                                 fabs(z + (double)g->corner[2] - centre[2] / g->cell));
        sum += fmin(fmax(3.5 - away, 0.0), 1.0);
    }
    return 0.5 * sum / (FINE * FINE) * g->cell * g->cell;
}

/// Maps share the light of each place, so that the coarsest grid has the flux of one map. A map
/// gives all grids that are as coarse the same flux, and finer ones none.
TEST(each_place_is_lit_once)
{
    const double nowhere[3] = {0.0, 0.0, 0.0}, ahead[3] = {1.0, 0.0, 0.5};
    for (int i = 0; i < 6; i++) {
        alp_lpv *lpv = open_volume(8, 0.5, 3, false);
        const double eye[3] = {0.7 * i, 0.4, -0.3 * i};
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, i % 2 == 0 ? nowhere : ahead));
        double parts[3][3], sums[3] = {0.0, 0.0, 0.0};
        for (uint32_t m = 0; m < 3; m++) {
            alp_lpv_begin(lpv);
            make_map(lpv, m, 32 >> (2 - m), true);
            const alp_lpv_surfels s = map_view();
            ASSERT_OK(context, alp_lpv_add_light(lpv, m, &s));
            for (uint32_t c = 0; c < 3; c++) {
                parts[m][c] = flux_in(lpv, c);
                sums[c] += parts[m][c];
            }
            assert_true(parts[m][m] > 0.0);
            for (uint32_t c = 0; c < 3; c++) {
                ASSERT_NEAR(parts[m][c], c >= m ? parts[m][m] : 0.0, 1e-5 * parts[m][m]);
            }
        }
        ASSERT_NEAR(sums[2] / expected_flux(lpv), 1.0, 1e-3);
        // A map of all light gives each grid what maps of cascades give it together.
        alp_lpv_begin(lpv);
        make_map(lpv, 2, 32, true);
        const alp_lpv_surfels s = map_view();
        ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
        for (uint32_t c = 0; c < 3; c++) {
            ASSERT_NEAR(flux_in(lpv, c) / sums[c], 1.0, 1e-3);
        }
        alp_lpv_destroy(lpv);
    }
}

static double opacity_in(const alp_lpv *lpv, uint32_t cascade)
{
    const alpi_lpv_grid *g = &lpv->grids[cascade];
    double sum = 0.0;
    for (size_t i = 0; i < alpi_lpv_nodes(g->size); i++) {
        sum += (double)g->nodes[i * ALPI_LPV_NODE_TERMS];
    }
    return sum;
}

/// A view of a grid blocks light there alone, and a view of all grids in each.
TEST(views_block_where_they_belong)
{
    for (uint32_t view = 0; view < 4; view++) {
        alp_lpv *lpv = open_volume(8, 0.5, 3, true);
        make_map(lpv, view < 3 ? view : 0, 4, true);
        const alp_lpv_surfels s = map_view();
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, view < 3 ? view : ALP_LPV_ALL_CASCADES, &s));
        for (uint32_t c = 0; c < 3; c++) {
            const bool blocks = view == c || view == 3;
            assert_true((opacity_in(lpv, c) > 0.0) == blocks);
        }
        alp_lpv_destroy(lpv);
    }
}

/// A single grid has all light to its border.
TEST(a_single_grid_takes_all_light)
{
    alp_lpv *lpv = open_volume(8, 0.5, 1, false);
    make_map(lpv, 0, 4, true);
    const alp_lpv_surfels s = map_view();
    ASSERT_OK(context, alp_lpv_add_light(lpv, 0, &s));
    ASSERT_NEAR(flux_in(lpv, 0), 0.5 * 16.0, 1e-4);
    alp_lpv_destroy(lpv);
}

/// Options for a view: the coarsest grid holds the scene from any place inside, and no more than it
/// needs. A viewer outside counts as at the nearest place inside.
TEST(grids_of_a_view_hold_the_scene)
{
    static const double eyes[4][3] = {
        {0.3, 0.3, 0.3}, {0.0, 0.0, 0.0}, {0.5, 0.1, 0.4}, {9.0, -9.0, 0.2}};
    static const double ways[4][3] = {
        {0.0, 0.0, 0.0}, {0.0, 0.0, -7.0}, {1e200, 1e200, 1e200}, {-0.2, 0.5, 0.1}};
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_scene_info info = alp_scene_get_info(scene);
    for (int i = 0; i < 48; i++) {
        const uint32_t cascades = 1 + (uint32_t)i / 16;
        const double *way = ways[i % 4];
        const alp_lpv_options o =
            alp_lpv_options_for_view(scene, 20, cascades, eyes[i / 4 % 4], way);
        alp_lpv *lpv = lpv_open(context, o);
        double least = 1e30; // cells between the bounds and the grid's
        ASSERT_OK(context, alp_lpv_follow(lpv, o.centre, way));
        const alpi_lpv_grid *g = &lpv->grids[cascades - 1];
        for (int k = 0; k < 3; k++) {
            assert_true(o.centre[k] >= (double)info.bounds_min[k] &&
                        o.centre[k] <= (double)info.bounds_max[k]);
            const double low = (double)info.bounds_min[k] / g->cell - (double)g->corner[k];
            const double high = (double)info.bounds_max[k] / g->cell - (double)g->corner[k];
            least = fmin(least, fmin(low, 20.0 - high));
        }
        assert_true(least >= 1.0 - 1e-6 && least <= 2.0 + 1e-6);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

// --- space ---------------------------------------------------------------------------------------

/// E near a light in the finest of three grids, and in that grid alone. It is the same within 3 of
/// the 16 cells to the border, where the next grid begins to be blended in.
TEST(coarser_grids_matter_little_near_a_light)
{
    static const double reach[2] = {0.55, 1.0}, tolerance[2] = {1e-6, 0.02}; // metres; of the most
    for (int r = 0; r < 2; r++) {
        float e[2][100][3];
        for (int i = 0; i < 2; i++) {
            alp_lpv *lpv = open_volume(32, 0.25, i == 0 ? 1 : 3, false);
            const float p[1][3] = {{0.1f, -0.2f, 0.3f}}, n[1][3] = {{0.0f, 1.0f, 0.0f}};
            const float flux[1][3] = {{1.0f, 2.0f, 3.0f}};
            const alp_lpv_surfels s = {.count = 1, .positions = p, .normals = n, .flux = flux};
            ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
            ASSERT_OK(context, alp_lpv_propagate(lpv));
            alp_field *field = NULL;
            ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
            const float step = (float)reach[r] / 10.0f;
            for (int k = 0; k < 100; k++) {
                const float at[1][3] = {{step * (float)(k % 10 - 5) * 1.8f, step * (float)(k / 10),
                                         step * (float)(k % 7 - 3) * 3.0f}};
                const float down[1][3] = {{0.0f, -1.0f, 0.0f}};
                alp_field_irradiance(field, 1, at, down, &e[i][k]);
            }
            alp_field_destroy(field);
            alp_lpv_destroy(lpv);
        }
        double largest = 0.0, apart = 0.0;
        for (int k = 0; k < 300; k++) {
            const double alone = (double)e[0][k / 3][k % 3];
            largest = fmax(largest, alone);
            apart = fmax(apart, fabs((double)e[1][k / 3][k % 3] - alone));
        }
        assert_true(largest > 0.0);
        print_message("within %.2f m: apart by %.2g of the largest E\n", reach[r], apart / largest);
        ASSERT_NEAR(apart / largest, 0.0, tolerance[r]);
    }
}

/// Steps of 1 mm through all borders of cells and grids: the largest change, over the mean.
TEST(light_is_continuous_in_space)
{
    enum { STEPS = 12000 };
    static float p[STEPS][3], n[STEPS][3], values[STEPS][3];
    alp_lpv *lpv = open_volume(16, 0.5, 3, true);
    const double eye[3] = {0.3, 1.6, 0.2}, ahead[3] = {0.8, 0.0, 0.6};
    ASSERT_OK(context, alp_lpv_follow(lpv, eye, ahead));
    light_floor(lpv, 4);
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    static const float ways[4][3] = {
        {1, 0, 0}, {0, 0, 1}, {-0.6f, 0.1f, 0.79f}, {0.1f, 0.99f, 0.1f}};
    static const float start[3] = {0.3f, 1.6f, 0.2f};
    double most[3] = {0.0, 0.0, 0.0}, mean[3] = {0.0, 0.0, 0.0};
    for (int way = 0; way < 4; way++) {
        const vec3 down = {0.0f, -1.0f, 0.0f};
        const vec3 side = vec3_normalize_or((vec3){0.5f, -0.7f, 0.3f * (float)way}, down);
        for (int i = 0; i < STEPS; i++) {
            for (int k = 0; k < 3; k++) {
                p[i][k] = start[k] + 0.001f * (float)i * ways[way][k];
            }
            vec3_store(n[i], side);
        }
        for (int kind = 0; kind < 3; kind++) {
            const float(*at)[3] = (const float(*)[3])p, (*d)[3] = (const float(*)[3])n;
            if (kind == 0) {
                alp_field_irradiance(field, STEPS, at, d, values);
            } else if (kind == 1) {
                alp_lpv_radiance(lpv, STEPS, at, d, values);
            } else {
                alp_lpv_fluence(lpv, STEPS, at, values);
            }
            for (int i = 0; i < STEPS; i++) {
                const double last = (double)values[i > 0 ? i - 1 : 0][0];
                mean[kind] += way < 3 ? (double)values[i][0] / (3 * STEPS) : 0.0; // the fourth: up
                most[kind] = fmax(most[kind], fabs((double)values[i][0] - last));
            }
        }
    }
    print_message("steps of 1 mm: E %.3f %%, radiance %.3f %%, fluence %.3f %%\n",
                  100.0 * most[0] / mean[0], 100.0 * most[1] / mean[1], 100.0 * most[2] / mean[2]);
    ASSERT_NEAR(most[0] / mean[0], 0.0, 0.001);
    ASSERT_NEAR(most[1] / mean[1], 0.0, 0.003);
    ASSERT_NEAR(most[2] / mean[2], 0.0, 0.001);
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

// --- time ----------------------------------------------------------------------------------------

enum { POINTS = 1000, FRAMES_MOST = 600 };

/// Changes of E from frame to frame at fixed points, over the mean of E.
typedef struct changes {
    float positions[POINTS][3], normals[POINTS][3], last[POINTS][3];
    float all[FRAMES_MOST * POINTS];
    uint32_t frames;
} changes;

static void place_points(changes *c, const double low[3], const double high[3])
{
    uint32_t state = 5;
    memset(c->last, 0, sizeof c->last);
    c->frames = 0;
    for (int i = 0; i < POINTS; i++) {
        float u[5];
        for (int k = 0; k < 5; k++) {
            state = alpi_hash32(state + 0x9e3779b9u);
            u[k] = alpi_unit_float(state);
        }
        for (int k = 0; k < 3; k++) {
            c->positions[i][k] = (float)(low[k] + (high[k] - low[k]) * (double)u[k]);
        }
        vec3_store(c->normals[i],
                   field_tilted(acos(1.0 - 2.0 * (double)u[3]), 2.0 * FIELD_PI * (double)u[4]));
    }
}

static void add_frame(changes *c, const alp_field *field)
{
    static float now[POINTS][3];
    double mean = 0.0;
    alp_field_irradiance(field, POINTS, (const float(*)[3])c->positions,
                         (const float(*)[3])c->normals, now);
    for (int i = 0; i < POINTS; i++) {
        mean += (double)now[i][0] / POINTS;
    }
    assert_true(mean > 0.0);
    for (int i = 0; i < POINTS && c->frames > 0; i++) {
        c->all[(c->frames - 1) * POINTS + (uint32_t)i] =
            (float)(fabs((double)now[i][0] - (double)c->last[i][0]) / mean);
    }
    memcpy(c->last, now, sizeof now);
    c->frames++;
}

static int by_size(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/// Share of changes that are smaller.
static double quantile(changes *c, double share)
{
    const size_t count = (size_t)(c->frames - 1) * POINTS;
    qsort(c->all, count, sizeof *c->all, by_size);
    return (double)c->all[(size_t)((double)(count - 1) * share)];
}

/// 99.9 % of the changes and the largest are below bounds, in % of the mean.
static void expect_steady(changes *c, const char *what, double usual, double most)
{
    const double half = 100.0 * quantile(c, 0.5), p999 = 100.0 * quantile(c, 0.999);
    const double largest = 100.0 * quantile(c, 1.0);
    print_message("%s, %u frames: 50 %% of changes are below %.3f %%, 99.9 %% below %.3f %%, all "
                  "below %.3f %%\n",
                  what, c->frames, half, p999, largest);
    assert_true(p999 <= usual);
    assert_true(largest <= most);
}

static changes steps; // of one walk at a time

/// The camera moves 1 cm a frame over a floor whose light does not change.
static void walk(uint32_t side, double cell, bool blockers, uint32_t frames)
{
    const double low[3] = {2.0, 0.2, -6.0}, high[3] = {12.0, 3.0, 6.0}, ahead[3] = {1.0, 0.0, 0.0};
    place_points(&steps, low, high);
    alp_lpv *lpv = open_volume(side, cell, 3, blockers);
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    for (uint32_t i = 0; i < frames; i++) {
        const double eye[3] = {0.01 * i, 1.6, 0.0};
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, ahead));
        light_floor(lpv, 4);
        add_frame(&steps, field);
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

TEST(light_is_steady_while_the_camera_moves)
{
    walk(16, 0.5, true, 60);
    expect_steady(&steps, "floor", 0.7, 1.2);
}

TEST_SLOW(light_is_steady_on_a_long_walk)
{
    walk(16, 0.5, true, 300);
    expect_steady(&steps, "floor", 0.8, 1.2);
}

/// A scene with maps by rays. The camera moves by `step` metres a frame and the sun turns by `turn`
/// degrees. All points are in the two finest grids.
static void light_frames(const char *name, uint32_t frames, uint32_t map_size, double step,
                         double turn)
{
    alp_scene *scene = test_load(context, name);
    const alp_scene_info info = alp_scene_get_info(scene);
    alp_lpv *lpv = open_volume(32, 0.25, 3, true);
    alp_field *field = NULL;
    float eye[3], middle[3];
    for (int k = 0; k < 3; k++) {
        eye[k] = middle[k] = 0.5f * (info.bounds_min[k] + info.bounds_max[k]);
    }
    middle[0] += 4.0f; // of the second grid
    ASSERT_OK(context, alp_scene_free_points_near(scene, middle, 6.0f, 3, POINTS, steps.positions,
                                                  steps.normals));
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    steps.frames = 0;
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    o.map_size = map_size;
    o.lighting.sun.illuminance = 10.0f;
    o.lighting.sun.elevation = 0.9f;
    for (uint32_t i = 0; i < frames; i++) {
        const double along = step * i - 0.28, ahead[3] = {1.0, 0.0, 0.0}; // grids move at once
        const double at[3] = {(double)eye[0] + along, (double)eye[1], (double)eye[2]};
        o.lighting.sun.azimuth = (float)(0.3 + turn * i * FIELD_PI / 180.0);
        ASSERT_OK(context, alp_lpv_follow(lpv, at, ahead));
        ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, &o, NULL));
        add_frame(&steps, field);
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// Texels lie at the same places of the world in each frame.
TEST_SLOW(a_scene_is_steady_while_the_camera_moves)
{
    light_frames("builtin:atrium", 12, 256, 0.01, 0.0);
    expect_steady(&steps, "atrium, camera", 2.5, 4.0);
}

/// Texels at the edges of shadows are lit or dark as a whole, and larger maps have smaller texels.
/// The light itself changes by 3.2 % and 3.6 %, which maps of 4096 texels show.
TEST_SLOW(a_scene_flickers_less_with_larger_maps)
{
    light_frames("builtin:atrium", 8, 256, 0.0, 0.1);
    expect_steady(&steps, "atrium, sun", 40.0, 60.0);
    light_frames("builtin:atrium", 5, 1024, 0.0, 0.1);
    expect_steady(&steps, "atrium, sun, large maps", 10.0, 20.0);
}
