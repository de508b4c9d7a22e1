// SPDX-License-Identifier: MIT
// Projection on a plane, in double.
#include "atlas/stages.h"

#include <math.h>

alpi_plane alpi_plane_make(vec3 normal, vec3 origin)
{
    double n[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
    // t is across the axis that the normal is farthest from, so a floor or a wall has its sides
    // along the axes of the page before it is turned.
    int axis = fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0
               : fabs(n[1]) <= fabs(n[2])                           ? 1
                                                                    : 2;
    int next = (axis + 1) % 3, last = (axis + 2) % 3;
    double length = sqrt(n[next] * n[next] + n[last] * n[last]);
    alpi_plane plane = {
        .origin = {(double)origin.x, (double)origin.y, (double)origin.z},
    };
    plane.t[next] = n[last] / length; // (axis unit vector × n), turned round
    plane.t[last] = -n[next] / length;
    for (int k = 0; k < 3; k++) { // b = n × t, so that t × b = n
        int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        plane.b[k] = n[k1] * plane.t[k2] - n[k2] * plane.t[k1];
    }
    return plane;
}

void alpi_plane_project(const alpi_plane *plane, vec3 point, double *x, double *y)
{
    const double d[3] = {(double)point.x - plane->origin[0], (double)point.y - plane->origin[1],
                         (double)point.z - plane->origin[2]};
    *x = d[0] * plane->t[0] + d[1] * plane->t[1] + d[2] * plane->t[2];
    *y = d[0] * plane->b[0] + d[1] * plane->b[1] + d[2] * plane->b[2];
}
