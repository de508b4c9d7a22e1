// SPDX-License-Identifier: MIT
// World of the benches of the ambience volume: a scene under sun and sky, camera flights and fixed
// places in builtin:terrain. Sets of free points have known irradiance.
#ifndef AMBIENCE_WORLD_BENCH_H
#define AMBIENCE_WORLD_BENCH_H

#include "bench.h"

#include "fields/ambience/ambience.h"
#include "scene/builtin/builtin_terrain.h"
#include "scene/lights/lighting.h"

#define WORLD_STANDS 2.0  // seconds at the start of a flight
#define WORLD_FLIES 6.0   // seconds of a flight
#define WORLD_RESTS 5.0   // seconds at its end
#define WORLD_SPEED 30.0  // metres per second, seen from above
#define WORLD_REACH 20.0  // metres from the camera to the points
#define WORLD_FRAMES 60.0 // a second
enum { WORLD_FLIGHTS = 3, WORLD_PLACES = 4, WORLD_SAMPLES = 100 /* a frame */ };

typedef struct ambience_world {
    bench_scene scene;
    alp_lighting_options light; // a sun of 60,000 lx and a clear sky
    alpi_lighting *lighting;
    alpi_ground *ground; // of builtin:terrain
    bool quick;
} ambience_world;
/// @return false after a message; nothing is left to close then
bool ambience_world_open(const char *name, uint32_t workers, bool quick, ambience_world *world);
void ambience_world_close(ambience_world *world);

/// The camera of a flight, at a time of the run: WORLD_STANDS seconds at its start, WORLD_FLIES in
/// flight, then at its end.
void ambience_world_fly(const ambience_world *world, int flight, double time,
                        alp_ambience_camera *camera);

typedef struct ambience_place {
    const char *name;
    double position[3];
} ambience_place;
/// A fixed place of the terrain that is hard to light.
ambience_place ambience_world_place(const ambience_world *world, int place);

/// A random number in [0, 1).
double ambience_world_draw(uint64_t *state);

/// Points with normals, and E there.
typedef struct ambience_points {
    uint32_t count;
    double (*positions)[3];
    float (*normals)[3], (*truth)[3], (*values)[3]; // values: scratch of those who judge
    double mean;                                    // of the truth
    double own; // mean of the truth's standard errors, over its mean
} ambience_points;
/// Draws free points in a ball, and finds the truth by `paths` paths each.
bool ambience_points_open(const ambience_world *world, const double centre[3], double reach,
                          uint32_t seed, uint32_t paths, ambience_points *points);
void ambience_points_close(ambience_points *points);

/// 100 Σ|E − truth| / Σ truth, and 100 Σ(E − truth) / Σ truth, over points and channels.
typedef struct ambience_verdict {
    double error, bias;
} ambience_verdict;
ambience_verdict ambience_points_judge(const ambience_points *points);

/// How an ambience volume is read.
typedef enum ambience_view { VIEW_OURS, VIEW_BLIND, VIEW_CONFORMANCE, VIEW_COUNT } ambience_view;
/// E of a snapshot at points. BLIND: without visibility.
void ambience_view_read(const alp_ambience_snapshot *snapshot, ambience_view view, uint32_t count,
                        const double (*positions)[3], const float (*normals)[3],
                        float (*values)[3]);

/// A volume that follows a camera.
typedef struct ambience_run {
    alp_ambience *ambience;
    alp_ambience_sampler *sampler;
    uint64_t samples; // so far
    double seconds;   // in updates and samples
} ambience_run;
bool ambience_run_open(const ambience_world *world, const alp_ambience_options *options,
                       ambience_run *run);
/// One frame. @param samples at most
bool ambience_run_step(const ambience_world *world, ambience_run *run, double time,
                       const alp_ambience_camera *camera, uint32_t samples);
void ambience_run_close(ambience_run *run);

/// Light at points by rays through 6 × 16² pixels, with light that bounced from a snapshot.
/// @param lights [count] out   @param solid [count] out, or NULL
bool ambience_world_sample(const ambience_world *world, const alp_ambience_snapshot *bounced,
                           uint32_t count, const double (*positions)[3], alpi_sh9 *lights,
                           bool *solid);

#endif
