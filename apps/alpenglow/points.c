// SPDX-License-Identifier: MIT
#include "points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 6, POINT_LIMIT = 1 << 26, MESSAGE_SIZE = 400 };

int points_numbers(const char *line, double *numbers, int wanted, const char **end)
{
    const char *at = line;
    int count = 0;
    *end = line;
    while (count < wanted) {
        char *behind = NULL;
        at += strspn(at, " \t");
        at += count > 0 && (*at == ',' || *at == ';') ? 1 : 0; // an empty column is no number
        numbers[count] = strtod(at, &behind);
        if (behind == at || (*behind != '\0' && strchr(",; \t\r\n", *behind) == NULL)) {
            break;
        }
        *end = at = behind;
        count++;
    }
    return count;
}

bool points_are_names(const char *line)
{
    double number;
    const char *end;
    return points_numbers(line, &number, 1, &end) == 0 && strpbrk(line, "xX") != NULL;
}

int points_refuse(const char *path, unsigned long line, const char *text)
{
    char fault[MESSAGE_SIZE];
    snprintf(fault, sizeof fault, "%s:%lu: %s", path, line, text);
    return failure(fault);
}

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

static void grow(point_list *p, bool normals, uint32_t *room)
{
    if (p->count < *room) {
        return;
    }
    *room = *room > 0 ? 2 * *room : 256;
    p->positions = allocate_or_exit(p->positions, *room * sizeof *p->positions);
    p->texts = allocate_or_exit(p->texts, *room * sizeof *p->texts);
    if (normals) {
        p->normals = allocate_or_exit(p->normals, *room * sizeof *p->normals);
    }
}

static void keep(point_list *p, const double *numbers, const double origin[3], const char *line,
                 const char *end)
{
    const uint32_t i = p->count;
    double length = 1.0;
    if (p->normals != NULL) {
        length = sqrt(numbers[3] * numbers[3] + numbers[4] * numbers[4] + numbers[5] * numbers[5]);
    }
    for (int k = 0; k < 3; k++) {
        p->positions[i][k] = (float)(numbers[k] - origin[k]);
        if (p->normals != NULL) {
            p->normals[i][k] = (float)(numbers[3 + k] / length);
        }
    }
    const size_t size = (size_t)(end - line);
    p->texts[i] = allocate_or_exit(NULL, size + 1);
    memcpy(p->texts[i], line, size);
    p->texts[i][size] = '\0';
    p->count++;
}

static int read_lines(FILE *file, const char *path, bool normals, const double origin[3],
                      point_list *points)
{
    const int wanted = normals ? COLUMNS : 3;
    char *line = NULL;
    size_t size = 0;
    uint32_t room = 0;
    int code = EXIT_DONE;
    for (unsigned long number = 1; code == EXIT_DONE && getline(&line, &size, file) >= 0;
         number++) {
        double numbers[COLUMNS] = {0.0};
        const char *start = line + strspn(line, " \t\r\n"), *end = start;
        if (*start == '\0' || *start == '#' || (points->count == 0 && points_are_names(start))) {
            continue;
        }
        const int count = points_numbers(start, numbers, wanted, &end);
        const char *fault = fault_of(numbers, count, wanted);
        if (fault == NULL && points->count == POINT_LIMIT) {
            fault = "too many points; split the file";
        }
        if (fault == NULL) {
            grow(points, normals, &room);
            keep(points, numbers, origin, start, end);
        }
        code = fault != NULL ? points_refuse(path, number, fault) : EXIT_DONE;
    }
    free(line);
    return code;
}

int points_read(const char *path, bool normals, const double origin[3], point_list *points)
{
    char fault[MESSAGE_SIZE];
    const bool input = strcmp(path, "-") == 0;
    *points = (point_list){0};
    FILE *file = input ? stdin : fopen(path, "r");
    if (file == NULL) {
        snprintf(fault, sizeof fault, "%s: cannot be read", path);
        return failure(fault);
    }
    int code = read_lines(file, path, normals, origin, points);
    if (!input) {
        fclose(file);
    }
    if (code == EXIT_DONE && points->count == 0) {
        snprintf(fault, sizeof fault, "%s: holds no points; give a line of %s for each", path,
                 normals ? "x,y,z,nx,ny,nz" : "x,y,z");
        code = failure(fault);
    }
    return code;
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
