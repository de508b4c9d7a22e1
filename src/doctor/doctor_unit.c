// SPDX-License-Identifier: MIT
// The doctor's guess at the unit of a scene, by its size.
#include "doctor/doctor.h"

#include <math.h>

/// Longest sides of rooms, and of what stands in them.
static const double SMALLEST_ROOM = 0.5, LARGEST_ROOM = 20.0;
/// Within these a unit that the file states is believed: from a cup to a house.
static const double SMALLEST_BELIEVED = 0.05, LARGEST_BELIEVED = 30.0;

double alpi_doctor_longest_side(const alp_scene *scene)
{
    const vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    return (double)fmaxf(fmaxf(size.x, size.y), size.z);
}

uint32_t alp_scene_guess_unit(const alp_scene *scene, alp_unit_guess guesses[ALP_UNIT_LIMIT])
{
    // Tens and hundreds of metres are no units: they are metres that were divided once too often.
    static const alp_unit_guess units[ALP_UNIT_LIMIT] = {
        {"1 mm", 0.001, 0.0}, {"1 cm", 0.01, 0.0},     {"1 inch", 0.0254, 0.0},
        {"1 dm", 0.1, 0.0},   {"1 foot", 0.3048, 0.0}, {"1 m", 1.0, 0.0},
        {"10 m", 10.0, 0.0},  {"100 m", 100.0, 0.0},   {"1 km", 1000.0, 0.0}};
    if (scene == NULL) {
        return 0;
    }
    const double side = alpi_doctor_longest_side(scene);
    uint32_t count = 0;
    if (!(side > 0.0) ||
        (!scene->unit_assumed && side >= SMALLEST_BELIEVED && side <= LARGEST_BELIEVED)) {
        return 0;
    }
    for (int i = 0; i < ALP_UNIT_LIMIT; i++) {
        const double ratio = units[i].metres / scene->unit_metres;
        const bool taken = fabs(ratio - 1.0) < 1e-6; // files have six digits
        if (!taken && side * ratio >= SMALLEST_ROOM && side * ratio <= LARGEST_ROOM) {
            guesses[count] = units[i];
            guesses[count++].longest_side = side * ratio;
        }
    }
    return count;
}
