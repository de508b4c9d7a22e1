// SPDX-License-Identifier: MIT
// An analytic world for tests of the ambience volume: light that changes smoothly in space, and a
// ground that is solid.
#ifndef AMBIENCE_WORLD_H
#define AMBIENCE_WORLD_H

#include "test_support.h"

#include "base/octahedral.h"
#include "fields/ambience/ambience.h"

#include <math.h>
#include <stdlib.h>

/// Metres along x of a wall without thickness.
static const double WORLD_WALL = 2.9;

static inline double world_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/// Radiance coefficients at a place: mean 1, changes of 30 % over some 20 m, brighter from above.
static inline alp_sh9 world_light(const double p[3], double time)
{
    alp_sh9 light = {0};
    const double wave = 0.3 * sin(0.3 * p[0] + 0.5 * time) * cos(0.25 * p[2]);
    for (int k = 0; k < 3; k++) {
        light.c[0][k] = (float)(1.0 + wave * (1.0 - 0.2 * k));
        light.c[1][k] = (float)(0.3 + 0.1 * wave + 0.002 * k);
        light.c[3][k] = (float)(0.1 * cos(0.2 * p[1]));
        light.c[8][k] = (float)(0.05 * wave);
    }
    return light;
}

/// Answers up to `count` requests. Below `ground` [m] there is a solid.
static inline uint32_t world_answer(alp_ambience *ambience, const alp_ambience_camera *camera,
                                    uint32_t count, double ground, double time)
{
    alp_context *context = ambience->context;
    uint32_t done = 0;
    while (done < count) {
        alp_ambience_request request;
        ASSERT_OK(context, alp_ambience_next(ambience, camera, &request));
        if (request.id == 0) {
            break;
        }
        const alp_sh9 light = world_light(request.position, time);
        if (request.position[1] < ground) {
            ASSERT_OK(context, alp_ambience_submit_solid(ambience, request.id));
        } else {
            ASSERT_OK(context, alp_ambience_submit(ambience, request.id, &light));
        }
        done++;
    }
    return done;
}

/// Mean distances, and of their squares, to the ground and to the wall: of 4 × 4 directions of each
/// texel.
static inline void world_distances(const double p[3], double ground, double reach,
                                   float moments[ALPI_AMBIENCE_MOMENTS][2])
{
    memset(moments, 0, ALPI_AMBIENCE_MOMENTS * sizeof *moments);
    for (int i = 0; i < 32 * 32; i++) {
        const vec3 d = alpi_octahedral_decode(
            (vec2){((float)(i % 32) + 0.5f) / 32.0f, ((float)(i / 32) + 0.5f) / 32.0f});
        const double down = (ground - p[1]) / (double)d.y;
        const double across = (WORLD_WALL - p[0]) / (double)d.x;
        double nearest = down > 0.0 ? fmin(down, reach) : reach;
        nearest = across > 0.0 ? fmin(across, nearest) : nearest;
        float *texel = moments[i / 32 / 4 * 8 + i % 32 / 4];
        texel[0] += (float)(nearest / 16.0);
        texel[1] += (float)(nearest * nearest / 16.0);
    }
}

/// As world_answer, with distances. Light behind the wall is half as bright.
static inline uint32_t world_answer_seen(alp_ambience *ambience, const alp_ambience_camera *camera,
                                         uint32_t count, double ground)
{
    alp_context *context = ambience->context;
    uint32_t done = 0, anchor;
    for (; done < count; done++) {
        double place[3];
        float moments[ALPI_AMBIENCE_MOMENTS][2];
        alpi_sh9 light;
        ASSERT_OK(context, alpi_ambience_choose(ambience, camera, &anchor));
        if (anchor == ALPI_NO_ANCHOR) {
            break;
        }
        alpi_anchor_place(ambience, &ambience->anchors[anchor], place);
        const alp_sh9 all = world_light(place, 0.0);
        for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
            light.c[i / 3][i % 3] = all.c[i / 3][i % 3] * (place[0] > WORLD_WALL ? 0.5f : 1.0f);
        }
        const double cell = alpi_ambience_cell(ambience, ambience->anchors[anchor].level);
        world_distances(place, ground, 2.0 * cell, moments);
        if (place[1] < ground) {
            alpi_anchor_solid(ambience, anchor, 0.0f, ambience->stale_serial);
        } else {
            ASSERT_OK(context,
                      alpi_anchor_light(ambience, anchor, &light, (const float(*)[2])moments,
                                        ambience->stale_serial));
        }
    }
    return done;
}

static inline alp_ambience *world_open(alp_context *context, const alp_ambience_options *options)
{
    alp_ambience *ambience = NULL;
    ASSERT_OK(context, alp_ambience_create(context, options, &ambience));
    return ambience;
}

/// Fills the volume round a camera that stands still, before time moves.
static inline void world_warm(alp_ambience *ambience, const alp_ambience_camera *camera,
                              double ground)
{
    ASSERT_OK(ambience->context, alp_ambience_update(ambience, 0.0));
    for (int i = 0; i < 40 && world_answer(ambience, camera, 200, ground, 0.0) > 0; i++) {
        ASSERT_OK(ambience->context, alp_ambience_update(ambience, 0.0));
    }
}

#endif
