// Grids of a light propagation volume: three-dimensional textures. The grids of all cascades lie one
// behind the other along z, first those of red. A cell holds an intensity, I(w) = p.x + p.yzw . w.
#include "lpv_bindings.h"
#include "shared_constants.h"

layout(location = UNIFORM_LPV_SIZE) uniform ivec3 grid_size; // cells of a grid
layout(location = UNIFORM_LPV_CASCADES) uniform int cascades;

/// How light is read at faces and given on, by the mode.
layout(location = UNIFORM_LPV_READ) uniform vec3 lpv_read; // far: length; a side: along, aside
layout(location = UNIFORM_LPV_GIVE) uniform vec2 lpv_give; // along, aside
layout(location = UNIFORM_LPV_OPACITY) uniform float lpv_opacity;
layout(location = UNIFORM_LPV_BY_ANGLE) uniform bool lpv_by_angle;

/// Components along an axis and along the two after it.
vec3 turn(vec3 v, int axis)
{
    return axis == 0 ? v : axis == 1 ? v.yzx : v.zxy;
}

vec3 turn_back(vec3 v, int axis)
{
    return axis == 0 ? v : axis == 1 ? v.zxy : v.yzx;
}

ivec3 unit_of(int axis)
{
    return ivec3(axis == 0, axis == 1, axis == 2);
}

/// From a channel to the next one.
ivec3 channel_step()
{
    return ivec3(0, 0, cascades * grid_size.z);
}

/// From the low faces across an axis to those across the next one.
ivec3 axis_step()
{
    return ivec3(0, 0, cascades * (grid_size.z + 1));
}

/// Light towards the five faces of a neighbour, per solid angle: the far one, then those at + and -
/// of the other two axes.
void read_faces(vec4 p, int axis, float way, out float light[5])
{
    vec3 v = turn(p.yzw, axis);
    float beside = p.x + way * lpv_read.y * v.x;
    vec2 aside = lpv_read.z * v.yz;
    light[0] = max(p.x + way * lpv_read.x * v.x, 0.0);
    light[1] = max(beside + aside.x, 0.0);
    light[2] = max(beside - aside.x, 0.0);
    light[3] = max(beside + aside.y, 0.0);
    light[4] = max(beside - aside.y, 0.0);
}

/// Clamping at 0 adds light behind lobes. This scale makes the fluxes to all 30 faces 4 pi p.x.
vec4 scale_light(vec4 p)
{
    float sum = 0.0, f[5];
    for (int d = 0; d < 6; d++) {
        read_faces(p, d / 2, d % 2 == 0 ? 1.0 : -1.0, f);
        sum += ALP_LPV_FAR * f[0] + ALP_LPV_SIDE * (f[1] + f[2] + f[3] + f[4]);
    }
    return p * (12.56637061 * p.x / max(sum, 1e-30));
}
