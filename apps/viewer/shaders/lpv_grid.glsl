// Grids of a light propagation volume: three-dimensional textures, in which the grids of all
// cascades lie one behind the other along z. A cell holds an intensity, I(w) = p.x + p.yzw . w, in
// a texture for each channel.
#include "lpv_bindings.h"
#include "shared_constants.h"

layout(location = UNIFORM_LPV_SIZE) uniform ivec3 grid_size; // cells of a grid

/// How light is read at faces and given on, by the mode.
layout(location = UNIFORM_LPV_READ) uniform vec3 lpv_read; // far: length; a side: along, aside
layout(location = UNIFORM_LPV_GIVE) uniform vec2 lpv_give; // along, aside
layout(location = UNIFORM_LPV_OPACITY) uniform float lpv_opacity;
layout(location = UNIFORM_LPV_BY_ANGLE) uniform bool lpv_by_angle;

/// Axes of a side face: the one of travel, and the two others.
ivec3 axes_of(int axis)
{
    return ivec3(axis, (axis + 1) % 3, (axis + 2) % 3);
}

/// Light towards the five faces of a neighbour, per solid angle: the far one, then those at + and -
/// of the other two axes.
void read_faces(vec4 p, ivec3 axes, float way, out float faces[5])
{
    float along = way * p[1 + axes.x];
    float beside = p.x + lpv_read.y * along;
    float b = lpv_read.z * p[1 + axes.y], c = lpv_read.z * p[1 + axes.z];
    faces[0] = max(p.x + lpv_read.x * along, 0.0);
    faces[1] = max(beside + b, 0.0);
    faces[2] = max(beside - b, 0.0);
    faces[3] = max(beside + c, 0.0);
    faces[4] = max(beside - c, 0.0);
}

/// Clamping at 0 adds light behind lobes. This scale makes the fluxes to all 30 faces 4 pi p.x.
vec4 scale_light(vec4 p)
{
    float sum = 0.0, faces[5];
    for (int d = 0; d < 6; d++) {
        read_faces(p, axes_of(d / 2), d % 2 == 0 ? 1.0 : -1.0, faces);
        sum += ALP_LPV_FAR * faces[0] +
               ALP_LPV_SIDE * (faces[1] + faces[2] + faces[3] + faces[4]);
    }
    return p * (12.56637061 * p.x / max(sum, 1e-30));
}
