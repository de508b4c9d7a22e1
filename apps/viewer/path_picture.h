// SPDX-License-Identifier: MIT
// The picture of --with reference: batches of paths, averaged.
#ifndef VIEWER_PATH_PICTURE_H
#define VIEWER_PATH_PICTURE_H

#include "gl/gl_targets.h"

#include <alpenglow/render.h>

typedef struct path_picture {
    alp_render_options options; // of all batches, but for camera, samples and seed
    uint32_t samples;           // paths a pixel and frame
    uint64_t batches;           // so far: each has a seed of its own
} path_picture;

/// Traces the paths of a frame, and writes their mean into the light of the targets, which have the
/// size of the options. @return as alp_render
alp_result path_picture_draw(path_picture *p, const alp_scene *scene, const alp_camera *camera,
                             const gl_targets *targets);

#endif
