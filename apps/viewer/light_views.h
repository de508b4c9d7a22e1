// SPDX-License-Identifier: MIT
// Views of shadow maps: what a light sees. Maps are square, and hold three texels more than is seen
// at each border, for filters and for points that are moved before they are compared.
#ifndef VIEWER_LIGHT_VIEWS_H
#define VIEWER_LIGHT_VIEWS_H

#include "camera_view.h"

#include <alpenglow/light.h>

enum { LIGHT_FACES = 6 };

/// Unit, from the scene to the sun.
void sun_toward(const alp_sun_options *sun, double toward[3]);

/// A parallel view of the whole scene.
/// @param direction unit, along which the light travels   @param side of the map, texels
camera_view light_view_of_sun(const alp_scene_info *info, const float direction[3], uint32_t side);

/// A parallel view of a box, without a border. Its texels stay where they are in the world when the
/// box moves. The box is covered wherever its centre lies within a texel.
camera_view light_view_of_box(const alp_scene_info *info, const float direction[3],
                              const double low[3], const double high[3], uint32_t side);

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

/// A square view without a border. @param tangent of half the angle that is seen
camera_view light_view_of_lamp(const alp_scene_info *info, const float position[3],
                               const double forward[3], double tangent, uint32_t side);

/// A sixth of all directions. @param face 0 to 5: towards +x, -x, +y, -y, +z, -z
camera_view light_view_of_face(const alp_scene_info *info, const float position[3], int face,
                               uint32_t side);

#endif
