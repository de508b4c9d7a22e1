// SPDX-License-Identifier: MIT
// Progress of long work, on standard error.
#include "printing/progress.h"

#include <jansson.h>

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

progress_display progress_start(progress_mode mode)
{
    bool terminal = mode == PROGRESS_AUTO && isatty(STDERR_FILENO);
    progress_display p = {.mode = mode, .terminal = terminal, .last = clock_seconds()};
    p.interval = terminal ? 0.1 : mode == PROGRESS_JSON ? 0.5 : 5.0;
    return p;
}

/// "12 s left", "1:05 min left", "2:05 h left", or nothing while unknown.
static void format_time_left(double seconds, char *text, size_t size)
{
    if (!(seconds >= 0.0) || seconds > 1e7) {
        text[0] = '\0';
        return;
    }
    unsigned long whole = (unsigned long)(seconds + 0.5);
    if (whole < 60) {
        snprintf(text, size, ", %lu s left", whole);
    } else if (whole < 3600) {
        snprintf(text, size, ", %lu:%02lu min left", whole / 60, whole % 60);
    } else {
        snprintf(text, size, ", %lu:%02lu h left", whole / 3600, whole / 60 % 60);
    }
}

static void format_line(const alp_progress *state, char *text, size_t size)
{
    char speed[32] = "", left[32] = "";
    if (state->rays_per_second > 0.0) {
        snprintf(speed, sizeof speed, ", %.3g Mrays/s", state->rays_per_second * 1e-6);
    }
    format_time_left(state->seconds_left, left, sizeof left);
    if (state->total > 0) {
        // Rounded down, so that 100 % is printed only at the end.
        double share = (double)state->done / (double)state->total;
        unsigned percent = share >= 1.0 ? 100 : (unsigned)(100.0 * share);
        snprintf(text, size, "%s %3u %%%s%s", state->stage, percent, speed, left);
    } else {
        snprintf(text, size, "%s%s%s", state->stage, speed, left);
    }
}

static void show_json(const alp_progress *state)
{
    json_t *left = state->seconds_left >= 0.0 ? json_real(state->seconds_left) : json_null();
    json_t *line = json_pack("{s:s, s:I, s:I, s:f, s:o}", "stage", state->stage, "done",
                             (json_int_t)state->done, "total", (json_int_t)state->total,
                             "rays_per_second", state->rays_per_second, "seconds_left", left);
    if (line != NULL) {
        json_dumpf(line, stderr, JSON_COMPACT | JSON_REAL_PRECISION(6));
        fputc('\n', stderr);
        json_decref(line);
    }
}

void progress_show(progress_display *p, const alp_progress *state)
{
    if (p->mode == PROGRESS_OFF) {
        return;
    }
    double now = clock_seconds();
    bool new_stage = strncmp(p->stage, state->stage, sizeof p->stage - 1) != 0;
    if (now - p->last < p->interval && !(new_stage && p->mode != PROGRESS_AUTO)) {
        return;
    }
    p->last = now;
    snprintf(p->stage, sizeof p->stage, "%s", state->stage);
    char line[128];
    format_line(state, line, sizeof line);
    if (p->mode == PROGRESS_JSON) {
        show_json(state);
    } else if (p->terminal) {
        fprintf(stderr, "\r%.78s\033[K", line);
        p->line_open = true;
    } else {
        fprintf(stderr, "%s\n", line);
    }
    fflush(stderr);
}

void progress_clear(progress_display *p)
{
    if (p->line_open) {
        fputs("\r\033[K", stderr);
        p->line_open = false;
    }
}
