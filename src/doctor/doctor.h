// SPDX-License-Identifier: MIT
// What the parts of the doctor share: a list of findings, and who looks for what.
#ifndef ALPI_DOCTOR_DOCTOR_H
#define ALPI_DOCTOR_DOCTOR_H

#include "scene/scene.h"

#include <alpenglow/doctor.h>

enum {
    ALPI_DOCTOR_PAGE = 1024, // side of the page that UV sets are measured on, texels
    ALPI_DOCTOR_SPOTS = 8,   // pictures of spots in the scene
    ALPI_DOCTOR_SURFACES =
        16,           // of a kind of finding, where there is one for each surface: the worst
    ALPI_KEPT_SET = 1 // what ALP_ATLAS_KEEP looks at
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
    uint32_t (*neighbours)[3]; // of triangles, while it is looked; NULL where none can be used
    uint32_t spots[ALPI_DOCTOR_SPOTS]; // findings: the first of its kind each
    uint32_t spot_count;
    char spot_names[ALPI_DOCTOR_SPOTS][32];
};

/// What is said of every finding of a kind.
typedef struct alpi_finding_words {
    alp_finding_kind kind;
    alp_severity severity;
    const char *code, *seen, *todo;
} alpi_finding_words;
const alpi_finding_words *alpi_finding_words_of(alp_finding_kind kind);
/// Words of the message with this code; those of ALP_FINDING_MESSAGE where there are none.
const alpi_finding_words *alpi_finding_words_by_code(const char *code);

/// Where, how many, how much.
typedef struct alpi_finding_facts {
    alp_finding_kind kind;
    alp_finding_place place;
    uint32_t index;
    uint64_t count;
    double value;
} alpi_finding_facts;
/// Adds a finding with what is wrong.
alp_result alpi_diagnosis_add(alp_diagnosis *diagnosis, alpi_finding_facts facts,
                              const char *format, ...) ALP_PRINTF(3, 4);
/// Says where the finding that was added last is worst: a triangle of the scene, and a point of it.
/// @param uv of a finding of a UV set, else NULL
void alpi_diagnosis_mark(alp_diagnosis *diagnosis, uint32_t triangle, vec3 at, const float uv[2]);
/// The same at the middle of the triangle.
void alpi_diagnosis_mark_triangle(alp_diagnosis *diagnosis, uint32_t triangle);
/// Whether the kind has been found.
bool alpi_diagnosis_has(const alp_diagnosis *diagnosis, alp_finding_kind kind);

// Each in the file of its name.
alp_result alpi_doctor_look_at_mesh(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_uvs(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_materials(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_lights(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_backs(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_junctions(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_overlaps(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_sides(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_scale(alp_diagnosis *diagnosis);

/// What a surface is called in a finding: its name, and its material where the one beside it in the
/// file has that name too, as parts of one mesh have. Cut to what fits.
typedef struct alpi_surface_label {
    char text[128];
} alpi_surface_label;
alpi_surface_label alpi_doctor_label(const alp_scene *scene, uint32_t surface);

/// What to tell of many surfaces: the worst, at most ALPI_DOCTOR_SURFACES of them.
/// @param measure [surface_count] > 0: worth a word; the worst are the largest
/// @param worst   out: surfaces, worst first; equal ones in their order
/// @param all     out: how many are worth a word
/// @return how many of `worst`
uint32_t alpi_doctor_choose_worst(const alp_scene *scene, const double *measure,
                                  uint32_t worst[ALPI_DOCTOR_SURFACES], uint32_t *all);

// doctor_pictures.c, doctor_layout.c. On failure *image is NULL.
/// @param spot NULL = the scene from where most of it is seen
alp_result alpi_doctor_draw_scene(const alp_scene *scene, const alp_finding_spot *spot,
                                  alp_image **image);
alp_result alpi_doctor_draw_uv_set(const alp_diagnosis *diagnosis, uint32_t set, alp_image **image);

// doctor_unit.c: metres.
double alpi_doctor_longest_side(const alp_scene *scene);

/// "s" unless there is one.
static inline const char *alpi_plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}

#endif
