// SPDX-License-Identifier: MIT
// An analytic world for tests of the ambience volume: light that changes smoothly in space, and a
// ground that is solid.
#ifndef AMBIENCE_WORLD_H
#define AMBIENCE_WORLD_H

#include "test_support.h"

#include "fields/ambience/ambience.h"

#include <math.h>
#include <stdlib.h>

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
