// SPDX-License-Identifier: MIT
#include "bake/light/light_progress.h"

#include "base/tasks.h"

#include <math.h>
#include <string.h>

/// Share of the rest of its part that a loop takes: a guess if the number of loops is unknown.
static const double LOOP_SHARE = 0.5;
/// The most progress before the end: the number of rounds is unknown.
static const double MOST_REPORTED = 0.99;
/// Seconds left, at least, while the error decides whether another round follows.
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
    c->loop_share = one_loop ? 1.0 : LOOP_SHARE;
    c->after = after;
    c->base = c->share = c->loop = 0.0;
}

void alpi_light_clock_loop(alpi_light_clock *c, double share)
{
    c->base = c->share;
    c->loop = 0.0;
    c->loop_share = share;
}

bool alpi_light_clock_is_late(const alpi_light_clock *c)
{
    return alpi_seconds() >= c->deadline;
}

/// Notes the progress of the loop. A loop whose progress falls is the next one.
static void follow(alpi_light_clock *c, double loop)
{
    if (loop < c->loop) {
        c->base = c->share;
    }
    c->loop = loop;
    c->share = fmax(c->share, c->base + (1.0 - c->base) * c->loop_share * loop);
}

bool alpi_light_clock_goes_on(void *user, const alp_progress *progress)
{
    enum { UNITS = 1000 };
    alpi_light_clock *c = user;
    if (c->ended) {
        return true;
    }
    alp_progress all = *progress;
    if (strcmp(all.stage, c->stage) == 0) {
        if (all.done > 0 && all.total > 0) {
            follow(c, fmin((double)all.done / (double)all.total, 1.0));
        }
        const double now = alpi_seconds(), elapsed = now - c->part_began;
        double left =
            c->share > 0.0 ? elapsed * ((1.0 - c->share) / c->share + c->after / c->share) : -1.0;
        if (left >= 0.0 && c->may_go_on) {
            left = fmax(left, LEAST_LEFT);
        }
        if (c->until_deadline || left > c->deadline - now) {
            left = fmax(c->deadline - now, 0.0);
        }
        const double whole = now - c->began + left;
        const double share = left >= 0.0 && whole > 0.0 ? (now - c->began) / whole : 0.0;
        c->reported = fmax(c->reported, fmin(share, MOST_REPORTED));
        all.done = (uint64_t)(c->reported * UNITS);
        all.total = UNITS;
        all.seconds_left = left;
    }
    if (c->callback != NULL && !c->callback(c->user, &all)) {
        c->refused = true;
    }
    return !c->refused && !alpi_light_clock_is_late(c);
}
