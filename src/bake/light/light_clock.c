// SPDX-License-Identifier: MIT
// Who is asked while light is gathered: the user, and the clock; and how far all of it is, over
// loops that each begin at nothing.
#include "bake/light/light.h"

#include "base/tasks.h"

#include <math.h>
#include <string.h>

// What a loop may be of what is left of its part, where a part is made of loops one after another
// and nobody knows how many.
static const double LOOP_SHARE = 0.5;
// Nobody knows before a round whether it is the last.
static const double MOST_TOLD = 0.99;
/// Seconds that are left at least while the error decides whether another round follows.
static const double LEAST_LEFT = 1.0;

alpi_light_clock alpi_light_clock_start(const alpi_bake_job *job,
                                        const alpi_task_progress *progress)
{
    const alp_sampling_options *s = &job->options.sampling;
    const double now = alpi_seconds();
    return (alpi_light_clock){
        .callback = progress->callback,
        .user = progress->user,
        .stage = progress->stage,
        .deadline = s->time_limit > 0.0 ? job->gathering.began + s->time_limit : HUGE_VAL,
        .may_go_on = job->options.light.error > 0.0f,
        .until_deadline = s->time_limit > 0.0 && !(job->options.light.error > 0.0f),
        .began = now,
        .part_began = now,
    };
}

void alpi_light_clock_part(alpi_light_clock *c, bool one_loop, double after)
{
    c->part_began = alpi_seconds();
    c->one_loop = one_loop;
    c->after = after;
    c->base = c->share = c->loop = 0.0;
}

bool alpi_light_clock_is_late(const alpi_light_clock *c)
{
    return alpi_seconds() >= c->deadline;
}

/// Takes how far the loop is that runs; one that is less far than it was is the next one.
static void follow(alpi_light_clock *c, double loop)
{
    if (loop < c->loop) {
        c->base = c->share;
    }
    c->loop = loop;
    const double room = (1.0 - c->base) * (c->one_loop ? 1.0 : LOOP_SHARE);
    c->share = fmax(c->share, c->base + room * loop);
}

bool alpi_light_clock_goes_on(void *user, const alp_progress *progress)
{
    enum { UNITS = 1000 };
    alpi_light_clock *c = user;
    if (c->ended) {
        return true;
    }
    alp_progress told = *progress;
    if (strcmp(told.stage, c->stage) == 0) {
        if (told.done > 0 && told.total > 0) {
            follow(c, fmin((double)told.done / (double)told.total, 1.0));
        }
        const double now = alpi_seconds(), elapsed = now - c->part_began;
        double left =
            c->share > 0.0 ? elapsed * ((1.0 - c->share) / c->share + c->after / c->share) : -1.0;
        if (left >= 0.0 && c->may_go_on) { // another round may follow, and nobody knows
            left = fmax(left, LEAST_LEFT);
        }
        if (c->until_deadline || left > c->deadline - now) {
            left = fmax(c->deadline - now, 0.0);
        }
        const double all = now - c->began + left;
        const double share = left >= 0.0 && all > 0.0 ? (now - c->began) / all : 0.0;
        c->told = fmax(c->told, fmin(share, MOST_TOLD));
        told.done = (uint64_t)(c->told * UNITS);
        told.total = UNITS;
        told.seconds_left = left;
    }
    if (c->callback != NULL && !c->callback(c->user, &told)) {
        c->refused = true;
    }
    return !c->refused && !alpi_light_clock_is_late(c);
}
