// SPDX-License-Identifier: MIT
// Points spread over the scene, and rays from their sides: what the doctor's looks at backs and at
// both sides of surfaces have in common.
#ifndef ALPI_DOCTOR_DOCTOR_RAYS_H
#define ALPI_DOCTOR_DOCTOR_RAYS_H

#include "doctor/doctor.h"

#include "scene/area_points.h"
#include "trace/trace.h"

enum { ALPI_DOCTOR_RAYS = 2 * ALPI_PACKET }; // of a side of a point

typedef struct alpi_doctor_points {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    uint32_t count;
    alpi_area_point *points; // [count] each stands for the same area
} alpi_doctor_points;

/// What a ray met.
typedef struct alpi_doctor_hit {
    uint32_t triangle; // ALPI_NONE = nothing
    float distance;    // metres, of what was met
    bool back;         // of a single-sided surface, from behind
} alpi_doctor_hit;

/// Where rays begin, off the surface.
typedef struct alpi_doctor_eye {
    vec3 start, normal; // metres; unit
    uint32_t key;       // of random numbers
    bool backs;         // count where fronts lie in their place: they are the walls of a solid
} alpi_doctor_eye;

/// A packet of rays from a point, spread about a unit normal by the cosine.
/// @param first of the rays of this eye
void alpi_doctor_look(const alp_scene *scene, const alpi_tracer *tracer, const alpi_doctor_eye *eye,
                      uint32_t first, alpi_doctor_hit hits[ALPI_PACKET]);

/// A packet of rays from a side of a point, spread by the cosine.
/// @param sign   1 = the front, −1 = the back
/// @param stream of random numbers
/// @param first  of the rays of this side
void alpi_doctor_look_from(const alpi_doctor_points *points, uint32_t point, float sign,
                           uint32_t stream, uint32_t first, alpi_doctor_hit hits[ALPI_PACKET]);

/// Marks the finding that was added last at a point.
void alpi_doctor_mark_point(alp_diagnosis *diagnosis, const alpi_area_point *point);

/// Who looks from all points, and then tells.
typedef struct alpi_doctor_survey {
    uint32_t point_count, points_per_range;
    size_t size; // bytes that are kept of each point, zero at first
    /// Looks from one point; called by many threads at once.
    void (*look)(const alpi_doctor_points *points, uint32_t point, void *kept);
    /// @param kept [point_count] of all points
    alp_result (*tell)(alp_diagnosis *diagnosis, const alpi_doctor_points *points,
                       const void *kept);
} alpi_doctor_survey;
/// Does all of it; nothing where there is no area.
alp_result alpi_doctor_take_survey(alp_diagnosis *diagnosis, const alpi_doctor_survey *survey);

#endif
