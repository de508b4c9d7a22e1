// SPDX-License-Identifier: MIT
// The camera of a picture: the same rays through the middles of pixels as those of render. Shadow
// maps are pictures that lights see.
#ifndef VIEWER_CAMERA_VIEW_H
#define VIEWER_CAMERA_VIEW_H

#include <alpenglow/scene.h>

#include <stdbool.h>

/// Diagonal of the scene's bounds, metres.
double scene_diagonal(const alp_scene_info *info);

/// A pinhole and its picture. Through pixels x, y from the upper left corner goes the direction
/// forward + (2 x / width − 1) right + (1 − 2 y / height) up. Depth is near_plane / distance.
/// In a parallel view that sum is the offset of the ray's origin instead, with right and up in
/// metres; its depth is 1 - distance / far_plane.
typedef struct camera_view {
    float origin[3];  // metres
    float forward[3]; // unit
    float right[3];   // half the width of the picture at distance 1
    float up[3];      // half its height
    float near_plane; // metres; nothing nearer is drawn
    bool parallel;
    float far_plane; // metres; of a parallel view
    uint32_t width, height;
} camera_view;

/// @param camera its position and target differ, and up is not along the view
/// @param info   of the scene, for the near plane
camera_view camera_view_of(const alp_camera *camera, uint32_t width, uint32_t height,
                           const alp_scene_info *info);
/// Sets the uniforms of shaders/camera.glsl in the current program.
void camera_view_bind(const camera_view *view);

#endif
