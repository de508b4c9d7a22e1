// SPDX-License-Identifier: MIT
// A frame of light propagation on the graphics card: maps of all lights, blockers, propagation. As
// alp_lpv_light_scene.
#ifndef VIEWER_LPV_FRAME_H
#define VIEWER_LPV_FRAME_H

#include "passes/pass_maps.h"

#include <alpenglow/geometry.h>

typedef struct lpv_frame {
    gl_lpv volume;
    pass_maps maps, faces;       // of suns, spot lights and cameras; of a point light's faces
    gl_lpv_map emitters, points; // surfels that stay; width 0 without any
    float emitted[3];            // W that `emitters` holds
    uint32_t side;               // of maps
    uint32_t point_count;        // to collect
    uint64_t seed;               // of surfels
    bool views;                  // maps are the views of blockers, not `points`
} lpv_frame;

/// Makes the volume, and collects the surfels that stay.
/// @param options of the volume
/// @param frame   map_size, points (0: views) and seed; the rest is not read
/// @return ALP_OK, or the library's code; *code = EXIT_DONE, or EXIT_FAILED after a message
alp_result lpv_frame_create(const alp_scene *scene, const alp_lpv_options *options,
                            const alp_lpv_scene_options *frame, int *code, lpv_frame *f);
void lpv_frame_destroy(lpv_frame *f);
/// Collects the surfels that stay again, of a scene that has moved. @return as alp_lpv_collect
alp_result lpv_frame_collect(const alp_scene *scene, lpv_frame *f);

/// The parts of a frame.
typedef struct lpv_frame_scene {
    const alp_scene *scene;
    const gl_scene *drawn;
    const gl_scene *object; // beside it in all maps, or NULL
    const gl_lights *lights;
    const camera_view *camera; // a view of blockers, or NULL
    double eye[3], forward[3]; // that the grids follow; forward unit, or 0
    bool metals_black;
} lpv_frame_scene;
void lpv_frame_light(lpv_frame *f, const lpv_frame_scene *in);

#endif
