// SPDX-License-Identifier: MIT
// The list of findings that the doctor's parts add to.
#ifndef ALPI_DOCTOR_DIAGNOSIS_H
#define ALPI_DOCTOR_DIAGNOSIS_H

#include "base/plural.h"
#include "scene/scene.h"

#include <alpenglow/doctor.h>

enum {
    ALPI_DOCTOR_SPOTS = 8,    // pictures of spots in the scene
    ALPI_DOCTOR_SURFACES = 16 // surfaces that are listed for one kind of finding, the worst first
};

/// A finding with the texts that it owns.
typedef struct alpi_finding {
    alp_finding view;
    char *name, *what;
    char *code, *todo; // of messages; NULL: the words of the kind
} alpi_finding;

struct alp_diagnosis {
    alp_context *context;
    const alp_scene *scene;
    alpi_finding *findings; // [count]
    size_t count, capacity;
    alp_uv_set_info uv_sets[ALPI_UV_SET_LIMIT];
    char *reasons[ALPI_UV_SET_LIMIT];
    uint32_t uv_set_count;
    uint32_t page_size;
    uint32_t (*neighbours)[3]; // of triangles, while the parts run; NULL where none can be used
    uint32_t spots[ALPI_DOCTOR_SPOTS]; // findings: the first of its kind each
    uint32_t spot_count;
    char spot_names[ALPI_DOCTOR_SPOTS][32];
};

/// The place, the number of cases and the measure of a finding.
typedef struct alpi_finding_facts {
    alp_finding_kind kind;
    alp_finding_place place;
    uint32_t index;
    uint64_t count;
    double value;
} alpi_finding_facts;
/// Adds a finding; the format says what is wrong.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_diagnosis_add(alp_diagnosis *diagnosis, alpi_finding_facts facts,
                              const char *format, ...) ALP_PRINTF(3, 4);
/// Adds a finding and owns its texts from then on, also after a failure.
/// @return ALP_OK; OUT_OF_MEMORY: also where its name or text is NULL
alp_result alpi_diagnosis_append(alp_diagnosis *diagnosis, alpi_finding *finding);
/// Releases the texts of a finding that is in no list.
void alpi_finding_release(alp_context *context, alpi_finding *finding);
/// Marks where the last finding is worst: a triangle of the scene, and a point of it.
/// @param uv of a finding of a UV set, else NULL
void alpi_diagnosis_mark(alp_diagnosis *diagnosis, uint32_t triangle, vec3 at, const float uv[2]);
/// The same at the middle of the triangle.
void alpi_diagnosis_mark_triangle(alp_diagnosis *diagnosis, uint32_t triangle);
/// Sorts the findings: errors first, then by kind. Equal ones keep their order.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_diagnosis_sort(alp_diagnosis *diagnosis);

/// The name of a surface in a finding. The name of its material follows where the surface beside it
/// in the file has the same name, as parts of one mesh have. Both are cut to what fits.
typedef struct alpi_surface_label {
    char text[128];
} alpi_surface_label;
alpi_surface_label alpi_doctor_label(const alp_scene *scene, uint32_t surface);

/// Chooses the worst surfaces, at most ALPI_DOCTOR_SURFACES of them.
/// @param measure [surface_count] > 0: the surface counts; the largest are the worst
/// @param worst   out: surfaces, worst first; equal ones in their order
/// @param all     out: number of surfaces that count
/// @return number of surfaces in `worst`
uint32_t alpi_doctor_choose_worst(const alp_scene *scene, const double *measure,
                                  uint32_t worst[ALPI_DOCTOR_SURFACES], uint32_t *all);

#endif
