// A map of surfels, and where they go in the grids: as lpv_places.c of the library.
#include "lpv_cascades.glsl"

layout(binding = 0) uniform sampler2D map_positions; // metres; a: radius of the object, 0 any
layout(binding = 1) uniform sampler2D map_normals;   // unit; a: area, 0 where there is no surfel
layout(binding = 2) uniform sampler2D map_flux;      // W
layout(binding = 3) uniform sampler2D map_albedos;

layout(location = UNIFORM_LPV_MAP) uniform int map_cascade; // whose map it is, -1: of all

/// A place among the eight cells, or nodes, from `low` on.
struct grid_place {
    ivec3 low;
    vec3 part; // of the upper ones
};

/// Share that the coarsest of several grids takes: its last cell fades.
float last_share(vec3 position)
{
    vec3 half_size = 0.5 * vec3(grid_size) - 1.0;
    vec3 left = half_size + 0.5 - abs(position - centres[cascades - 1]) / cell_of(cascades - 1);
    left = mix(left, vec3(1.0), lessThan(half_size, vec3(1.0)));
    return cascades == 1 ? 1.0 : clamp(min(left.x, min(left.y, left.z)), 0.0, 1.0);
}

/// Share of a surfel's light that a grid takes. Maps of cascades are blended as the grids are.
float light_share(int cascade, vec3 position)
{
    int map = map_cascade < 0 ? cascade : map_cascade;
    float finer = 1.0; // what finer maps leave
    for (int c = 0; c < map; c++) {
        finer *= 1.0 - share_of(c, position, ALP_LPV_INJECTION_BORDER);
    }
    float own = map + 1 == cascades ? last_share(position)
                                    : share_of(map, position, ALP_LPV_INJECTION_BORDER);
    return map_cascade < 0 ? 1.0 - finer * (1.0 - own) : finer * own;
}

/// Share of the upper of two cells. Along its normal a surfel lies in one cell, or light would get
/// behind its surface. Aside it is shared by distance, or light would jump as it moves.
vec3 upper_part(vec3 part, vec3 normal)
{
    vec3 wide = 1.0 - normal * normal, from = part - 0.5 * (1.0 - wide);
    return mix(clamp(from / max(wide, 1e-9), 0.0, 1.0), vec3(0.0), lessThanEqual(from, vec3(0.0)));
}

/// @param blocks into nodes, which lie at the corners of cells; else into cells
/// @return false outside of the grid
bool find_place(int cascade, vec3 position, vec3 normal, bool blocks, out grid_place p)
{
    vec3 beyond = ALP_LPV_BEYOND * normal;
    vec3 at = position / cell_of(cascade) - corners[cascade] +
              (blocks ? beyond : ALP_LPV_ABOVE * normal + beyond - 0.5);
    vec3 last = vec3(grid_size) - (blocks ? 0.0 : 1.0);
    float reach = blocks ? 1.0 : 0.5; // beyond the first and the last
    if (any(lessThan(at, vec3(-reach))) || any(greaterThanEqual(at, last + reach))) {
        return false;
    }
    p.low = ivec3(floor(at));
    p.part = upper_part(at - floor(at), normal);
    if (!blocks) { // all light of a cell at the end of a grid stays in it
        bvec3 ends = bvec3(uvec3(lessThan(p.low, ivec3(0))) |
                           uvec3(greaterThanEqual(p.low, ivec3(last))));
        p.low = max(p.low, ivec3(0));
        p.part = mix(p.part, vec3(0.0), ends);
    }
    return true;
}

/// Corner `number` of a place, and the share of the surfel that goes there.
ivec3 corner_of(grid_place p, int number, out float share)
{
    ivec3 upper = ivec3(number, number >> 1, number >> 2) & 1;
    vec3 shares = mix(1.0 - p.part, p.part, equal(upper, ivec3(1)));
    share = shares.x * shares.y * shares.z;
    return p.low + upper;
}
