// SPDX-License-Identifier: MIT
// The parts of the doctor. Each one lies in the file of its name and adds its findings to the list.
#ifndef ALPI_DOCTOR_DOCTOR_H
#define ALPI_DOCTOR_DOCTOR_H

#include "doctor/diagnosis.h"

enum {
    ALPI_DOCTOR_PAGE = 1024, // side of the page that UV sets are measured on, texels
    ALPI_KEPT_SET = 1        // the set that ALP_ATLAS_KEEP keeps
};

alp_result alpi_doctor_look_at_mesh(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_uvs(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_materials(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_lights(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_backs(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_junctions(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_overlaps(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_sides(alp_diagnosis *diagnosis);
alp_result alpi_doctor_look_at_scale(alp_diagnosis *diagnosis);

/// Adds a message of an earlier stage as a finding (doctor_messages.c).
/// @param light whether light will be baked: then a scene without any is a warning
alp_result alpi_doctor_add_message(alp_diagnosis *diagnosis, const alp_report_finding *message,
                                   bool light);

// doctor_pictures.c, doctor_layout.c. On failure *image is NULL.
/// @param spot NULL = the scene from where most of it is seen
alp_result alpi_doctor_draw_scene(const alp_scene *scene, const alp_finding_spot *spot,
                                  alp_image **image);
alp_result alpi_doctor_draw_uv_set(const alp_diagnosis *diagnosis, uint32_t set, alp_image **image);

/// Longest side of the scene's bounding box, metres (doctor_unit.c).
double alpi_doctor_longest_side(const alp_scene *scene);

#endif
