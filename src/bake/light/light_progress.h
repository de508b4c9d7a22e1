// SPDX-License-Identifier: MIT
// Progress of light, and the clock that ends it. Light is made of parts, and parts of loops; each
// loop reports progress from 0 to 1. The user sees one progress of all of them.
#ifndef ALPI_BAKE_LIGHT_PROGRESS_H
#define ALPI_BAKE_LIGHT_PROGRESS_H

#include "bake/job.h"

typedef struct alpi_light_clock {
    alp_progress_fn *callback; // of the user, or NULL
    void *user;
    const char *stage;
    double deadline;     // in alpi_seconds(); HUGE_VAL: none
    bool until_deadline; // light uses all the time
    bool may_go_on;      // the error decides whether another round follows
    bool refused;        // by the user
    bool ended;          // no callback and no deadline any more
    double began, part_began;
    double loop_share;        // of this loop in the rest of the part
    double after;             // time after the part, over its own
    double base, share, loop; // of the part: done before this loop, done; of the loop: done
    double reported;          // of all parts
} alpi_light_clock;

alpi_light_clock alpi_light_clock_start(const alpi_bake_job *job,
                                        const alpi_task_progress *progress);
/// Begins a part. @param after time of the parts that follow, over its own
void alpi_light_clock_part(alpi_light_clock *clock, bool one_loop, double after);
/// Begins a loop of the part. @param share in (0, 1]: its time over that of the rest of the part
void alpi_light_clock_loop(alpi_light_clock *clock, double share);
bool alpi_light_clock_is_late(const alpi_light_clock *clock);
/// An alp_progress_fn. @param user the clock
bool alpi_light_clock_goes_on(void *user, const alp_progress *progress);

#endif
