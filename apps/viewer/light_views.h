// SPDX-License-Identifier: MIT
// Views of shadow maps: what a light sees. Maps are square, and hold three texels more than is seen
// at each border, for filters and for points that are moved before they are compared.
#ifndef VIEWER_LIGHT_VIEWS_H
#define VIEWER_LIGHT_VIEWS_H

#include "camera_view.h"

enum { LIGHT_FACES = 6 };

/// A parallel view of the whole scene.
/// @param direction unit, along which the light travels   @param side of the map, texels
camera_view light_view_of_sun(const alp_scene_info *info, const float direction[3], uint32_t side);

/// The part of the scene that a lamp lights lies in a cone about `axis`.
typedef struct light_cone {
    double axis[3]; // unit
    double outer;   // radians from it; pi: all around
} light_cone;
/// The narrower one of a spot light's own cone and of the cone that holds the scene.
light_cone light_cone_of(const alp_scene_info *info, const alp_light_info *lamp);
/// @param cone its outer angle is below pi / 2
camera_view light_view_of_cone(const alp_scene_info *info, const float position[3],
                               const light_cone *cone, uint32_t side);

/// A sixth of all directions. @param face 0 to 5: towards +x, -x, +y, -y, +z, -z
camera_view light_view_of_face(const alp_scene_info *info, const float position[3], int face,
                               uint32_t side);

#endif
