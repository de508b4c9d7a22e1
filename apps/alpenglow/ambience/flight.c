// SPDX-License-Identifier: MIT
#include "ambience/flight.h"

#include "ambience/flight_terrain.h"
#include "printing/messages.h"
#include "setup/number_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 8, NEEDED = 7, PLACE_COLUMNS = 4, POINT_LIMIT = 1 << 20 };

static const double DEFAULT_VFOV = 60.0; // degrees

static const char *fault_of_numbers(const number_line *line)
{
    for (int k = 0; k < line->count; k++) {
        if (!isfinite(line->numbers[k]) || fabs(line->numbers[k]) > (k == 0 ? 1e9 : 1e15)) {
            return k == 0 ? "the time is not finite, or beyond 1e9 s; give seconds"
                          : "a number is not finite, or beyond 1e15; give metres";
        }
    }
    return NULL;
}

static bool has_rest(const number_line *line)
{
    return line->rest[strspn(line->rest, ",; \t\r\n")] != '\0';
}

static const char *fault_of_view(const number_line *line)
{
    const double *n = line->numbers;
    if (line->count < NEEDED) {
        return "need seven numbers: t,px,py,pz,tx,ty,tz, and vfov if wanted";
    }
    if (has_rest(line)) {
        return "something follows the numbers; give t,px,py,pz,tx,ty,tz, and vfov if wanted";
    }
    const char *fault = fault_of_numbers(line);
    if (fault != NULL) {
        return fault;
    }
    if (!(flight_distance(n + 1, n + 4) > 0.0)) {
        return "the target is the position; give another point to look at";
    }
    if (line->count == COLUMNS && !(n[7] >= 1e-3 && n[7] <= 179.0)) {
        return "vfov is out of range; give 0.001 to 179 degrees";
    }
    return NULL;
}

static const char *fault_of_place(const number_line *line)
{
    if (line->count < PLACE_COLUMNS || has_rest(line)) {
        return "need four numbers: t,px,py,pz";
    }
    return fault_of_numbers(line);
}

/// @param n    t,px,py,pz,tx,ty,tz
/// @param vfov degrees
static flight_point make_point(const double n[NEEDED], double vfov, const double origin[3])
{
    flight_point p = {.time = n[0], .vfov = vfov * (M_PI / 180.0)};
    for (int k = 0; k < 3; k++) {
        p.position[k] = n[1 + k] - origin[k];
        p.target[k] = n[4 + k] - origin[k];
    }
    return p;
}

typedef struct reading {
    flight *flight;
    double origin[3];
    bool places; // lines have no target
    uint32_t room;
} reading;

/// A number_line_fn; `user` is a reading.
static const char *keep(void *user, const number_line *line)
{
    reading *r = user;
    flight *f = r->flight;
    const char *fault = r->places ? fault_of_place(line) : fault_of_view(line);
    if (fault != NULL) {
        return fault;
    }
    if (f->count > 0 && !(line->numbers[0] > f->points[f->count - 1].time)) {
        return "the time is not after that of the line before; give times that rise";
    }
    if (f->count == POINT_LIMIT) {
        return "too many lines, need 1048576 or fewer; leave some out";
    }
    if (f->count == r->room) {
        r->room = r->room > 0 ? 2 * r->room : 64;
        f->points = allocate_or_exit(f->points, r->room * sizeof *f->points);
    }
    const double vfov = line->count == COLUMNS ? line->numbers[7] : DEFAULT_VFOV;
    f->points[f->count++] = make_point(line->numbers, vfov, r->origin);
    return NULL;
}

int flight_read(const char *path, const double origin[3], flight *f)
{
    reading r = {.flight = f, .origin = {origin[0], origin[1], origin[2]}};
    *f = (flight){0};
    return number_lines_read(path, COLUMNS,
                             "holds no flight; give lines of t,px,py,pz,tx,ty,tz[,vfov]", keep, &r);
}

int flight_read_places(const char *path, const double origin[3], flight *f)
{
    reading r = {.flight = f, .origin = {origin[0], origin[1], origin[2]}, .places = true};
    *f = (flight){0};
    return number_lines_read(path, PLACE_COLUMNS, "holds no path; give lines of t,px,py,pz", keep,
                             &r);
}

void flight_terrain(flight *f)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    f->count = flight_terrain_count;
    f->points = allocate_or_exit(NULL, f->count * sizeof *f->points);
    for (uint32_t i = 0; i < f->count; i++) {
        f->points[i] = make_point(flight_terrain_lines[i], DEFAULT_VFOV, origin);
    }
}

void flight_clear(flight *f)
{
    free(f->points);
    *f = (flight){0};
}

double flight_start(const flight *f)
{
    return f->points[0].time;
}

double flight_end(const flight *f)
{
    return f->points[f->count - 1].time + (f->count == 1 ? FLIGHT_STAND : 0);
}

/// Index of the last point at or before a time inside the flight.
static uint32_t find_leg(const flight *f, double time)
{
    uint32_t low = 0, high = f->count - 1;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (f->points[middle].time <= time) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static flight_camera stand(const flight_point *p)
{
    flight_camera c = {.vfov = p->vfov};
    memcpy(c.position, p->position, sizeof c.position);
    memcpy(c.target, p->target, sizeof c.target);
    return c;
}

double flight_distance(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

flight_camera flight_at(const flight *f, double time)
{
    const flight_point *last = &f->points[f->count - 1];
    if (time < f->points[0].time) {
        return stand(&f->points[0]);
    }
    if (time >= last->time) {
        return stand(last);
    }
    const flight_point *a = &f->points[find_leg(f, time)], *b = a + 1;
    const double length = b->time - a->time, t = (time - a->time) / length;
    flight_camera c = {.vfov = a->vfov + t * (b->vfov - a->vfov)};
    for (int k = 0; k < 3; k++) {
        c.position[k] = a->position[k] + t * (b->position[k] - a->position[k]);
        c.target[k] = a->target[k] + t * (b->target[k] - a->target[k]);
        c.velocity[k] = (b->position[k] - a->position[k]) / length;
    }
    if (!(flight_distance(c.position, c.target) > 0.0)) { // between lines that look at each other
        memcpy(c.target, b->target, sizeof c.target);
    }
    return c;
}

alp_camera flight_view(const flight_camera *c)
{
    alp_camera view = {.vertical_fov = (float)c->vfov};
    // Looking straight up or down, +Y cannot be up.
    const double length = flight_distance(c->position, c->target);
    const bool vertical = fabs(c->target[1] - c->position[1]) > 0.9999 * length;
    for (int k = 0; k < 3; k++) {
        view.position[k] = (float)c->position[k];
        view.target[k] = (float)c->target[k];
    }
    view.up[1] = vertical ? 0.0f : 1.0f;
    view.up[2] = vertical ? -1.0f : 0.0f;
    return view;
}
