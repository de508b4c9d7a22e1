// SPDX-License-Identifier: MIT
// Light propagation against the truth, in free air and on surfaces, with probes beside it. Two
// references: the first reflection alone, and all bounces. Neither has a sky.
#include "bench.h"

#include "fields/propagation/lpv.h"
#include "scene/area_points.h"

#include <alpenglow/probes.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 1000, PATHS = 512, STREAM = 9, PLACES = 2, DEPTHS = 2 };

typedef struct truth_scene {
    const char *name, *title, *light;
    bool sun, shared, more, steps; // a sun; below ALPENGLOW_SHARED; further rows and tables
    float spacing;                 // metres of probes
} truth_scene;
static const truth_scene scenes[] = {
    {"builtin:cornell", "cornell", "its own", false, false, false, true, 0.035f},
    {"builtin:teapot-room", "teapot-room", "its own", false, false, false, false, 0.5f},
    {"builtin:atrium", "atrium", "a sun", true, false, true, false, 1.0f},
    {"scenes/architecture/zdm2.glb", "zdm2", "a sun", true, true, false, false, 4.0f},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/// Points in free air, then on fronts of surfaces, and the truth of them.
typedef struct truth_case {
    const truth_scene *what;
    bool quick;
    bench_scene scene;
    alp_lighting_options light;
    uint32_t count; // of each place
    float (*positions)[3], (*normals)[3], (*values)[3];
    float (*truth[DEPTHS])[3]; // by depth: one reflection, all bounces
    bench_table table;
} truth_case;

// --- points --------------------------------------------------------------------------------------

/// Points spread over fronts of surfaces by area, a little above them.
static void place_on_surfaces(const truth_case *c, float (*positions)[3], float (*normals)[3])
{
    const alp_scene *s = c->scene.scene;
    const float lift = 1e-4f * vec3_length(vec3_sub(s->bounds_max, s->bounds_min));
    alpi_area_point *points = bench_allocate(c->count, sizeof *points);
    (void)alpi_area_points(s, c->count, points); // a scene of the bench has area
    for (uint32_t i = 0; i < c->count; i++) {
        const float b1 = points[i].b1, b2 = points[i].b2;
        vec3 k[3];
        alpi_triangle_corners(s, points[i].triangle, k);
        const vec3 n = vec3_triangle_normal(k[0], k[1], k[2], (vec3){0.0f, 1.0f, 0.0f});
        const vec3 p = vec3_mad(vec3_scale(k[0], 1.0f - b1 - b2), b1, k[1]);
        vec3_store(positions[i], vec3_mad(vec3_mad(p, b2, k[2]), lift, n));
        vec3_store(normals[i], n);
    }
    free(points);
}

static alp_result find_truth(truth_case *c)
{
    static const uint32_t depths[DEPTHS] = {1, ALP_BOUNCES_CONVERGE};
    ALP_TRY(alp_scene_free_points(c->scene.scene, STREAM, c->count, c->positions, c->normals));
    place_on_surfaces(c, c->positions + c->count, c->normals + c->count);
    for (int d = 0; d < DEPTHS; d++) {
        alp_reference_options o = alp_reference_options_default();
        o.lighting = c->light;
        o.samples = c->quick ? 16 : PATHS;
        o.bounces = depths[d];
        ALP_TRY(alp_reference_irradiance(c->scene.scene, &o, PLACES * c->count,
                                         (const float(*)[3])c->positions,
                                         (const float(*)[3])c->normals, c->truth[d], NULL));
    }
    return ALP_OK;
}

// --- rows ----------------------------------------------------------------------------------------

/// Whether any light reaches a point. Faces inside of solids are never seen.
static bool is_lit(const truth_case *c, uint32_t i)
{
    const float *e = c->truth[DEPTHS - 1][i];
    return e[0] + e[1] + e[2] > 0.0f;
}

/// 100 Σ|E − truth| / Σ truth, and 100 Σ(E − truth) / Σ truth.
static void judge(const truth_case *c, int place, int depth, double *error, double *bias)
{
    double apart = 0.0, more = 0.0, all = 0.0;
    for (uint32_t i = (uint32_t)place * c->count; i < (uint32_t)(place + 1) * c->count; i++) {
        for (int k = 0; k < 3 && is_lit(c, i); k++) {
            const double d = (double)c->values[i][k] - (double)c->truth[depth][i][k];
            apart += fabs(d);
            more += d;
            all += (double)c->truth[depth][i][k];
        }
    }
    *error = 100.0 * apart / all;
    *bias = 100.0 * more / all;
}

/// Reads a field at all points, and judges it by place.
static void read_field(truth_case *c, const alp_field *field, int depth, double error[PLACES],
                       double bias[PLACES])
{
    alp_field_irradiance(field, PLACES * c->count, (const float(*)[3])c->positions,
                         (const float(*)[3])c->normals, c->values);
    for (int p = 0; p < PLACES; p++) {
        judge(c, p, depth, &error[p], &bias[p]);
    }
}

static void add_row(truth_case *c, const char *model, const char *grid, const char *blockers,
                    const alp_field *field, int depth)
{
    double error[PLACES], bias[PLACES];
    read_field(c, field, depth, error, bias);
    bench_table_add(&c->table, "%s|%s|%s|%s|%.0f|%+.0f|%.0f|%+.0f", model, grid, blockers,
                    depth == 0 ? "one" : "all", error[0], bias[0], error[1], bias[1]);
}

typedef enum lpv_blockers { OFF, POINTS_BLOCK, VIEWS_BLOCK } lpv_blockers;

typedef struct lpv_row {
    alp_lpv_mode mode;
    uint32_t grid, iterations; // cells; steps, 0: the default
    lpv_blockers blockers;
    int depth;
} lpv_row;

/// Lights a volume as `alpenglow lpv` does, and makes its field.
static alp_result light_volume(const truth_case *c, const lpv_row *row, alp_lpv **lpv,
                               alp_field **field)
{
    alp_lpv_options o = alp_lpv_options_for_scene(c->scene.scene, row->grid, 1);
    alp_lpv_scene_options so = alp_lpv_scene_options_default();
    const alp_camera camera = alp_scene_get_camera(c->scene.scene, 0);
    o.mode = row->mode;
    o.iterations = row->iterations;
    o.blockers = row->blockers != OFF;
    o.bounces = row->depth == 0 ? 1 : ALP_BOUNCES_CONVERGE;
    so.lighting = c->light;
    so.map_size = c->quick ? 16 : so.map_size;
    so.points = row->blockers == VIEWS_BLOCK ? 0 : c->quick ? 1024 : so.points;
    so.camera = &camera;
    ALP_TRY(alp_lpv_create(c->scene.context, &o, lpv));
    ALP_TRY(alp_lpv_light_scene(*lpv, c->scene.scene, &so, NULL));
    return alp_field_create_lpv(*lpv, field);
}

static alp_result measure_lpv(truth_case *c, const lpv_row *row)
{
    static const char *const names[] = {"accurate", "conformance", "transfer"};
    static const char *const blockers[] = {"off", "points", "views"};
    char size[16];
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    snprintf(size, sizeof size, "%u³", row->grid);
    const alp_result result = light_volume(c, row, &lpv, &field);
    if (result == ALP_OK) {
        add_row(c, names[row->mode], size, blockers[row->blockers], field, row->depth);
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    return result;
}

static alp_result measure_probes(truth_case *c)
{
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    o.lighting = c->light;
    o.spacing = c->what->spacing;
    o.rays = c->quick ? 384 : o.rays;
    ALP_TRY(alp_probes_bake(c->scene.scene, &o, &probes));
    alp_result result =
        alp_field_create_probes(probes, ALP_LOOKUP_OURS, c->scene.scene->origin, NULL, &field);
    if (result == ALP_OK) {
        add_row(c, "probes", "–", "–", field, 1);
    }
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    return result;
}

static alp_result measure_scene(truth_case *c)
{
    static const uint32_t grids[3] = {16, 32, 64};
    ALP_TRY(find_truth(c));
    for (int g = 0; g < (c->quick ? 1 : 3); g++) {
        for (int mode = 0; mode < 2; mode++) {
            lpv_row row = {.mode = (alp_lpv_mode)mode, .grid = grids[g]};
            ALP_TRY(measure_lpv(c, &row));
            row.blockers = POINTS_BLOCK;
            ALP_TRY(measure_lpv(c, &row));
            row.depth = 1;
            ALP_TRY(measure_lpv(c, &row));
        }
    }
    for (int i = 0; i < 3 && c->what->more; i++) {
        static const lpv_row more[3] = {{ALP_LPV_TRANSFER, 32, 0, POINTS_BLOCK, 1},
                                        {ALP_LPV_ACCURATE, 32, 0, VIEWS_BLOCK, 1},
                                        {ALP_LPV_CONFORMANCE, 32, 0, VIEWS_BLOCK, 1}};
        ALP_TRY(measure_lpv(c, &more[i]));
    }
    return c->quick ? ALP_OK : measure_probes(c);
}

// --- numbers of steps ----------------------------------------------------------------------------

/// Sum of E at points of the floor over that of the truth.
static double find_floor_share(const truth_case *c)
{
    const float low = c->scene.scene->bounds_min.y, high = c->scene.scene->bounds_max.y;
    double sum = 0.0, truth = 0.0;
    for (uint32_t i = c->count; i < PLACES * c->count; i++) {
        const bool on_floor =
            c->normals[i][1] > 0.99f && c->positions[i][1] < low + 0.01f * (high - low);
        for (int k = 0; k < 3 && on_floor; k++) {
            sum += (double)c->values[i][k];
            truth += (double)c->truth[1][i][k];
        }
    }
    return truth > 0.0 ? sum / truth : 0.0;
}

/// Rows of more steps than the default, at 32³ with points and all bounces.
static alp_result measure_numbers_of_steps(truth_case *c, const bench_options *options)
{
    bench_table table;
    bench_table_start(&table, "cornell by the number of steps",
                      "At 32³, points block, all bounces. Floor: E on it over the truth.",
                      "mode|steps|error in air, %|bias, %|error on surfaces, %|bias, %|floor");
    for (int i = 0; i < (c->quick ? 1 : 6); i++) {
        lpv_row row = {(alp_lpv_mode)(i / 3), c->quick ? 8 : 32, 32u << i % 3, POINTS_BLOCK, 1};
        alp_lpv *lpv = NULL;
        alp_field *field = NULL;
        const alp_result result = light_volume(c, &row, &lpv, &field);
        if (result == ALP_OK) {
            double error[PLACES], bias[PLACES];
            read_field(c, field, 1, error, bias);
            bench_table_add(&table, "%s|%u|%.0f|%+.0f|%.0f|%+.0f|%.2f",
                            row.mode == ALP_LPV_ACCURATE ? "accurate" : "conformance",
                            row.iterations, error[0], bias[0], error[1], bias[1],
                            find_floor_share(c));
        }
        alp_field_destroy(field);
        alp_lpv_destroy(lpv);
        ALP_TRY(result);
    }
    bench_table_print(&table, options);
    return ALP_OK;
}

static bool run_scene(const truth_scene *what, const bench_options *options)
{
    static char note[256];
    truth_case c = {.what = what, .quick = options->quick};
    const char *name = what->shared ? bench_shared(what->name, NULL) : what->name;
    snprintf(note, sizeof note, "Light: %s.", what->light);
    bench_table_start(
        &c.table, what->title, note,
        "model|grid|blockers|bounces|error in air, %|bias, %|error on surfaces, %|bias, %");
    if (name == NULL) {
        c.table.note = "Skipped: not below ALPENGLOW_SHARED.";
        bench_table_print(&c.table, options);
        return true;
    }
    if (!bench_scene_load(name, 0, &c.scene)) {
        return false;
    }
    c.count = options->quick ? 32 : POINTS;
    c.light = alp_lighting_options_default();
    if (what->sun) {
        c.light.sun = (alp_sun_options){
            .azimuth = 0.7f, .elevation = 0.9f, .illuminance = 100.0f, .color = {1.0f, 1.0f, 1.0f}};
    }
    const uint32_t all = PLACES * c.count;
    c.positions = bench_allocate(all, sizeof *c.positions);
    c.normals = bench_allocate(all, sizeof *c.normals);
    c.values = bench_allocate(all, sizeof *c.values);
    for (int d = 0; d < DEPTHS; d++) {
        c.truth[d] = bench_allocate(all, sizeof *c.truth[d]);
    }
    bool good = bench_good(&c.scene, measure_scene(&c));
    bench_table_print(&c.table, options);
    if (good && what->steps) {
        good = bench_good(&c.scene, measure_numbers_of_steps(&c, options));
    }
    free(c.positions);
    free(c.normals);
    free(c.values);
    for (int d = 0; d < DEPTHS; d++) {
        free(c.truth[d]);
    }
    bench_scene_close(&c.scene);
    return good;
}

int bench_lpv_truth(const bench_options *options)
{
    for (int i = 0; i < (options->quick ? 1 : SCENES); i++) {
        if (!run_scene(&scenes[i], options)) {
            return 1;
        }
    }
    return 0;
}
