// SPDX-License-Identifier: MIT
#include "field_objects.h"

#include "field_points.h"
#include "printing/messages.h"

#include <alpenglow/geometry.h>
#include <alpenglow/shared_constants.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 12 };

/// (0, ±1, ±φ) and its turns, of length 1.
static void make_corners(float corners[CORNERS][3])
{
    const double golden = 0.5 * (1.0 + sqrt(5.0)), length = sqrt(1.0 + golden * golden);
    for (int i = 0; i < CORNERS; i++) {
        const int axis = i / 4;
        corners[i][axis] = 0.0f;
        corners[i][(axis + 1) % 3] = (float)((i % 2 == 0 ? 1.0 : -1.0) / length);
        corners[i][(axis + 2) % 3] = (float)((i / 2 % 2 == 0 ? golden : -golden) / length);
    }
}

/// Y_lm(n), in the order of alp_sh9.
static void find_harmonics(const float n[3], double y[FIELD_OBJECT_COEFFICIENTS])
{
    const double a = (double)n[0], b = (double)n[1], c = (double)n[2];
    y[0] = ALP_SH_Y0;
    y[1] = ALP_SH_Y1 * b;
    y[2] = ALP_SH_Y1 * c;
    y[3] = ALP_SH_Y1 * a;
    y[4] = ALP_SH_Y2 * a * b;
    y[5] = ALP_SH_Y2 * b * c;
    y[6] = ALP_SH_Y20 * (3.0 * c * c - 1.0);
    y[7] = ALP_SH_Y2 * a * c;
    y[8] = ALP_SH_Y22 * (a * a - b * b);
}

// --- objects -------------------------------------------------------------------------------------

/// One past the last surface of the object that begins with `first`.
static uint32_t find_end(const alp_scene *scene, uint32_t first, uint32_t count)
{
    const char *name = alp_scene_get_surface(scene, first).name;
    uint32_t end = first + 1;
    while (end < count && name[0] != '\0' &&
           strcmp(name, alp_scene_get_surface(scene, end).name) == 0) {
        end++;
    }
    return end;
}

static void find_middle(const alp_scene *scene, const alp_geometry *g, uint32_t first, uint32_t end,
                        float middle[3])
{
    const double most = (double)INFINITY;
    double low[3] = {most, most, most}, high[3] = {-most, -most, -most};
    for (uint32_t i = first; i < end; i++) {
        const alp_surface_info s = alp_scene_get_surface(scene, i);
        for (uint32_t c = 0; c < 3 * s.triangle_count; c++) {
            const float *p = g->positions[g->triangles[s.first_triangle + c / 3][c % 3]];
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], (double)p[k]);
                high[k] = fmax(high[k], (double)p[k]);
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        middle[k] = low[k] <= high[k] ? (float)(0.5 * (low[k] + high[k])) : 0.0f;
    }
}

/// Numbers the objects. @param objects [surfaces] out   @param middles [surfaces][3] out
/// @return their number
static uint32_t find_objects(const alp_scene *scene, uint32_t surfaces, uint32_t *objects,
                             float (*middles)[3])
{
    const alp_geometry geometry = alp_scene_get_geometry(scene);
    uint32_t count = 0;
    for (uint32_t first = 0; first < surfaces; count++) {
        const uint32_t end = find_end(scene, first, surfaces);
        find_middle(scene, &geometry, first, end, middles[count]);
        for (; first < end; first++) {
            objects[first] = count;
        }
    }
    return count;
}

// --- light ---------------------------------------------------------------------------------------

static void project(float corners[CORNERS][3], const float (*irradiance)[3],
                    float coefficients[FIELD_OBJECT_COEFFICIENTS][4])
{
    memset(coefficients, 0, sizeof *coefficients * FIELD_OBJECT_COEFFICIENTS);
    for (int i = 0; i < CORNERS; i++) {
        double y[FIELD_OBJECT_COEFFICIENTS];
        find_harmonics(corners[i], y);
        for (int l = 0; l < FIELD_OBJECT_COEFFICIENTS; l++) {
            const double weight = 4.0 * ALP_SH_A0 / CORNERS * y[l];
            for (int k = 0; k < 3; k++) {
                coefficients[l][k] += (float)(weight * (double)irradiance[i][k]);
            }
        }
    }
}

void field_objects_read(const alp_field *field, uint32_t workers, const alp_scene *scene,
                        float (*coefficients)[FIELD_OBJECT_COEFFICIENTS][4])
{
    const uint32_t surfaces = alp_scene_get_info(scene).surfaces;
    uint32_t *objects = allocate_or_exit(NULL, surfaces * sizeof *objects + 1);
    float(*middles)[3] = allocate_or_exit(NULL, surfaces * sizeof *middles + 1);
    const uint32_t count = find_objects(scene, surfaces, objects, middles);
    const size_t points = (size_t)count * CORNERS;
    float(*positions)[3] = allocate_or_exit(NULL, points * sizeof *positions + 1);
    float(*normals)[3] = allocate_or_exit(NULL, points * sizeof *normals + 1);
    float(*irradiance)[3] = allocate_or_exit(NULL, points * sizeof *irradiance + 1);
    float corners[CORNERS][3];
    make_corners(corners);
    for (size_t i = 0; i < points; i++) {
        memcpy(positions[i], middles[i / CORNERS], sizeof *positions);
        memcpy(normals[i], corners[i % CORNERS], sizeof *normals);
    }
    field_points_read(field, workers, (uint32_t)points, (const float(*)[3])positions,
                      (const float(*)[3])normals, irradiance);
    for (uint32_t i = 0; i < surfaces; i++) {
        project(corners, (const float(*)[3])irradiance + (size_t)objects[i] * CORNERS,
                coefficients[i]);
    }
    free(irradiance);
    free(normals);
    free(positions);
    free(middles);
    free(objects);
}
