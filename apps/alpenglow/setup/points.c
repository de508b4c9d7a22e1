// SPDX-License-Identifier: MIT
#include "setup/points.h"

#include "setup/number_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 6, POINT_LIMIT = 1 << 26 };

/// @param numbers [3 or 6]
static const char *fault_of(const double *numbers, int count, int wanted)
{
    if (count < wanted) {
        return wanted == COLUMNS ? "need six numbers: x,y,z,nx,ny,nz" : "need three numbers: x,y,z";
    }
    for (int k = 0; k < wanted; k++) {
        if (!isfinite(numbers[k]) || fabs(numbers[k]) > 1e15) {
            return "a number is not finite, or beyond 1e15";
        }
    }
    const double *n = numbers + 3;
    if (wanted == COLUMNS && !(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 1e-24)) {
        return "the normal has no length";
    }
    return NULL;
}

typedef struct reading {
    point_list *points;
    double origin[3];
    bool normals;
    uint32_t room;
} reading;

static void grow(reading *r)
{
    point_list *p = r->points;
    if (p->count < r->room) {
        return;
    }
    r->room = r->room > 0 ? 2 * r->room : 256;
    p->positions = allocate_or_exit(p->positions, r->room * sizeof *p->positions);
    p->texts = allocate_or_exit(p->texts, r->room * sizeof *p->texts);
    if (r->normals) {
        p->normals = allocate_or_exit(p->normals, r->room * sizeof *p->normals);
    }
}

static void add(point_list *p, const double origin[3], const number_line *line)
{
    const uint32_t i = p->count;
    const double *n = line->numbers;
    double length = 1.0;
    if (p->normals != NULL) {
        length = sqrt(n[3] * n[3] + n[4] * n[4] + n[5] * n[5]);
    }
    for (int k = 0; k < 3; k++) {
        p->positions[i][k] = (float)(n[k] - origin[k]);
        if (p->normals != NULL) {
            p->normals[i][k] = (float)(n[3 + k] / length);
        }
    }
    const size_t size = (size_t)(line->rest - line->text);
    p->texts[i] = allocate_or_exit(NULL, size + 1);
    memcpy(p->texts[i], line->text, size);
    p->texts[i][size] = '\0';
    p->count++;
}

/// A number_line_fn; `user` is a reading.
static const char *keep(void *user, const number_line *line)
{
    reading *r = user;
    const char *fault = fault_of(line->numbers, line->count, r->normals ? COLUMNS : 3);
    if (fault != NULL) {
        return fault;
    }
    if (r->points->count == POINT_LIMIT) {
        return "too many points; split the file";
    }
    grow(r);
    add(r->points, r->origin, line);
    return NULL;
}

int points_read(const char *path, bool normals, const double origin[3], point_list *points)
{
    reading r = {.points = points, .normals = normals, .origin = {origin[0], origin[1], origin[2]}};
    *points = (point_list){0};
    return number_lines_read(path, normals ? COLUMNS : 3,
                             normals ? "holds no points; give a line of x,y,z,nx,ny,nz for each"
                                     : "holds no points; give a line of x,y,z for each",
                             keep, &r);
}

void points_clear(point_list *points)
{
    for (uint32_t i = 0; i < points->count; i++) {
        free(points->texts[i]);
    }
    free(points->texts);
    free(points->positions);
    free(points->normals);
    *points = (point_list){0};
}
