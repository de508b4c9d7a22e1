// Places of the grids of a light propagation volume, and how each gives way to the next one.
#include "lpv_grid.glsl"

layout(location = UNIFORM_LPV_CELL) uniform float finest_cell; // metres
layout(location = UNIFORM_LPV_CORNERS) uniform vec3 corners[LPV_CASCADES_MOST]; // cells
layout(location = UNIFORM_LPV_CENTRES) uniform vec3 centres[LPV_CASCADES_MOST]; // metres

float cell_of(int cascade)
{
    return finest_cell * float(1 << cascade);
}

/// Share that a grid keeps at a point: 1 inside, and 0 a cell before its border.
/// @param border share of half a grid over which it fades
float share_of(int cascade, vec3 position, float border)
{
    vec3 half_size = 0.5 * vec3(grid_size) - 1.0;
    vec3 away = abs(position - centres[cascade]) / cell_of(cascade);
    vec3 share = (half_size - away) / (border * max(half_size, 0.5));
    return clamp(min(share.x, min(share.y, share.z)), 0.0, 1.0);
}
