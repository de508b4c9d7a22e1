// SPDX-License-Identifier: MIT
// The path tracer: its camera rays against the raw call on the same rays, and how much of its time
// is not Embree's.
#include "bench.h"

#include "embree_clock.h"
#include "raw_embree.h"

#include "base/random.h"
#include "base/tasks.h"
#include "render/camera_rays.h"
#include "transport/paths/reference.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 480, HEIGHT = 270, PIXELS = WIDTH * HEIGHT, PACKETS_PER_PIXEL = 2, ROUNDS = 7 };

static const char *const names[] = {"builtin:cornell", "builtin:teapot-room", "builtin:atrium",
                                    "builtin:atrium,triangles=1000000"};
enum { NAMES = sizeof names / sizeof *names };

/// The scene's own camera.
static bool view_of(const bench_scene *scene, uint32_t width, uint32_t height, alpi_view *view)
{
    const alp_camera camera = alp_scene_get_camera(scene->scene, 0);
    return bench_good(scene, alpi_view_place(scene->context, &camera, width, height, view));
}

// --- camera rays ---------------------------------------------------------------------------------

/// What both renderers do for each packet. @return something that hangs on every hit
static uint32_t look(const bench_scene *scene, const alpi_view *view, uint32_t pixels,
                     alpi_rays *record)
{
    alpi_rays rays;
    alpi_hits hits;
    uint32_t sum = 0;
    alpi_rays_clear(&rays);
    for (uint32_t pixel = 0; pixel < pixels; pixel++) {
        const uint32_t key = alpi_random_key(0, pixel, 1);
        for (uint32_t k = 0; k < PACKETS_PER_PIXEL; k++) {
            view->loops->packet(view, pixel, key, k * ALPI_PACKET, &rays);
            if (record != NULL) {
                record[(size_t)pixel * PACKETS_PER_PIXEL + k] = rays;
                continue;
            }
            alpi_trace_nearest_coherent(scene->tracer, &rays, 0xffu, (alpi_trace_filter){0}, &hits);
            for (int i = 0; i < ALPI_PACKET; i++) {
                sum += hits.triangle[i];
            }
        }
    }
    return sum;
}

static bool run_camera(const bench_scene *scene, const bench_options *options, bench_table *table)
{
    const uint32_t pixels = options->quick ? 1024 : PIXELS, count = pixels * PACKETS_PER_PIXEL;
    alpi_view view;
    raw_embree *raw =
        view_of(scene, WIDTH, HEIGHT, &view) ? raw_embree_create(scene->scene, true) : NULL;
    if (raw == NULL) {
        return false;
    }
    alpi_rays *record = aligned_alloc(64, count * sizeof *record);
    double ours[ROUNDS], limits[ROUNDS], ratios[ROUNDS];
    const int rounds = options->quick ? 1 : ROUNDS;
    volatile uint32_t kept = record != NULL ? look(scene, &view, pixels, record) : 0;
    for (int i = 0; i < rounds && record != NULL; i++) {
        const double started = bench_thread_seconds();
        kept = look(scene, &view, pixels, NULL);
        ours[i] = bench_thread_seconds() - started;
        limits[i] = raw_embree_time_nearest(raw, record, count, true, bench_thread_seconds);
        ratios[i] = limits[i] / ours[i];
    }
    (void)kept;
    const double rays = 1e-6 * count * ALPI_PACKET;
    if (record != NULL) {
        bench_table_add(table, "%s|%u|%.1f|%.1f|%.2f", scene->name,
                        alpi_tracer_triangle_count(scene->tracer),
                        rays / bench_median(limits, rounds), rays / bench_median(ours, rounds),
                        bench_median(ratios, rounds));
    }
    free(record);
    raw_embree_destroy(raw);
    return true;
}

// --- what is not Embree's ------------------------------------------------------------------------

static bool time_paths(const bench_scene *scene, const alpi_reference *r, const alpi_view *view,
                       uint32_t pixels, double *seconds, double *outside)
{
    alpi_reference_value *values = bench_allocate(pixels, sizeof *values);
    float *covered = bench_allocate(pixels, sizeof *covered);
    embree_clock_start();
    const double started = alpi_seconds();
    const bool good = bench_good(
        scene, alpi_reference_pixels(r, alpi_view_rays, view, 0, pixels, values, covered));
    *seconds = alpi_seconds() - started;
    uint64_t calls = 0;
    const double inside = embree_clock_stop(&calls);
    const double reading = (double)calls * embree_clock_reading(); // one a call inside, one outside
    *seconds -= 2.0 * reading;
    *outside = 1.0 - (inside - reading) / *seconds;
    free(values);
    free(covered);
    return good;
}

/// A picture of 160 × 90, 8 bounces, a sky and a sun beside the scene's own light.
static bool run_paths(const bench_scene *scene, alp_sky_kind sky, const bench_options *options,
                      bench_table *table)
{
    alpi_view view;
    const uint32_t pixels = options->quick ? 64 : 160 * 90;
    alp_lighting_options light = alp_lighting_options_default();
    light.sky.kind = sky;
    light.sun.illuminance = 1e5f;
    alpi_lighting *lighting = NULL;
    if (!view_of(scene, 160, 90, &view) ||
        !bench_good(scene, alpi_lighting_create(scene->scene, &light, &lighting))) {
        return false;
    }
    const alpi_reference r = {.context = scene->context,
                              .scene = scene->scene,
                              .tracer = scene->tracer,
                              .lighting = lighting,
                              .bounces = 8,
                              .samples = 16,
                              .next_event = true};
    double seconds[ROUNDS], outside[ROUNDS];
    const int rounds = options->quick ? 1 : ROUNDS;
    bool good = true;
    for (int i = 0; i < rounds && good; i++) {
        good = time_paths(scene, &r, &view, pixels, &seconds[i], &outside[i]);
    }
    if (good) {
        bench_table_add(table, "%s|%u|%s|%.2f|%.0f %%", scene->name,
                        alpi_tracer_triangle_count(scene->tracer),
                        sky == ALP_SKY_CLEAR ? "clear" : "even",
                        1e-6 * pixels * r.samples / bench_median(seconds, rounds),
                        100.0 * bench_median(outside, rounds));
    }
    alpi_lighting_destroy(scene->context, lighting);
    return good;
}

int bench_path_tracer(const bench_options *options)
{
    bench_table camera, paths;
    bench_table_start(&camera, "Camera rays, one worker, Mrays/s",
                      "Limit: `rtcIntersect8`, coherent, on the same packets, recorded. Ours draws "
                      "the points of the pixel, aims, traces, and looks up the triangle. Ratio: "
                      "limit's seconds over ours.",
                      "scene|triangles|limit|ours|ratio");
    bench_table_start(&paths, "Paths of the reference, one worker",
                      "A picture of the scene's camera, 16 paths a pixel, at most 8 bounces, a "
                      "sky and a sun beside its own light. Outside: share of the time that is "
                      "not spent in Embree's calls; what reading the clock took is off both.",
                      "scene|triangles|sky|Mpaths/s|outside Embree");
    bool good = true;
    const size_t count = options->quick || options->scene != NULL ? 1 : NAMES;
    for (size_t i = 0; i < count && good; i++) {
        bench_scene scene;
        good = bench_scene_open(options->scene != NULL ? options->scene : names[i], 1, &scene);
        if (good) {
            good = run_camera(&scene, options, &camera) &&
                   run_paths(&scene, ALP_SKY_CONSTANT, options, &paths) &&
                   run_paths(&scene, ALP_SKY_CLEAR, options, &paths);
            bench_scene_close(&scene);
        }
    }
    if (good) {
        bench_table_print(&camera, options);
        bench_table_print(&paths, options);
    }
    return good ? 0 : 1;
}
