// SPDX-License-Identifier: MIT
// Light of objects that are larger than a cell, and of patches of terrain.
#include "fields/ambience/ambience_snapshot.h"

#include <math.h>
#include <string.h>

enum { SIDES = 6, CORNERS = 4 };

void alp_ambience_object_cube(const alp_ambience_snapshot *snapshot, const double box_min[3],
                              const double box_max[3], float cube[6][3])
{
    if (cube == NULL) {
        return;
    }
    memset(cube, 0, SIDES * sizeof *cube);
    if (snapshot == NULL || box_min == NULL || box_max == NULL) {
        return;
    }
    double places[SIDES][3];
    float normals[SIDES][3] = {{0.0f}};
    for (int i = 0; i < SIDES; i++) {
        const int axis = i / 2;
        for (int k = 0; k < 3; k++) {
            places[i][k] = 0.5 * (box_min[k] + box_max[k]);
        }
        places[i][axis] = i % 2 == 0 ? box_max[axis] : box_min[axis];
        normals[i][axis] = i % 2 == 0 ? 1.0f : -1.0f;
    }
    alp_ambience_irradiance(snapshot, SIDES, (const double(*)[3])places, (const float(*)[3])normals,
                            cube);
}

void alp_ambience_patch(const alp_ambience_snapshot *snapshot, const double corners[4][3],
                        const float normals[4][3], float irradiance[4][3])
{
    if (irradiance == NULL) {
        return;
    }
    memset(irradiance, 0, CORNERS * sizeof *irradiance);
    if (snapshot != NULL && corners != NULL && normals != NULL) {
        alp_ambience_irradiance(snapshot, CORNERS, corners, normals, irradiance);
    }
}

void alp_ambience_patch_irradiance(const float irradiance[4][3], float u, float v, float e[3])
{
    if (irradiance == NULL || e == NULL) {
        return;
    }
    u = fminf(fmaxf(u, 0.0f), 1.0f); // NaN: 0
    v = fminf(fmaxf(v, 0.0f), 1.0f);
    // Weights of 0 and 1 are exact, so a border depends on its own two corners alone.
    for (int k = 0; k < 3; k++) {
        const float low = (1.0f - u) * irradiance[0][k] + u * irradiance[1][k];
        const float high = (1.0f - u) * irradiance[2][k] + u * irradiance[3][k];
        e[k] = (1.0f - v) * low + v * high;
    }
}
