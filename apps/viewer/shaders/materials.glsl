// Materials as alp_scene_get_material states them.
#include "bindings.h"

struct material {
    vec4 base_color;
    vec4 emission;     // rgb; a: alpha cutoff
    float metallic, transmission;
    uint alpha_mode;   // ALPHA_...
    uint flags;        // MATERIAL_...
    float normal_scale;
    uint slots[TEXTURE_USES]; // of TEXTURE_...: slot in use, or NO_SLOT
    uint unused[2];
    vec4 rows[2 * TEXTURE_USES]; // of TEXTURE_...: u' = dot(row.xyz, (u, v, 1)), then v'
};

layout(std430, binding = BUFFER_MATERIALS) readonly buffer material_list {
    material materials[];
};

layout(location = UNIFORM_MATERIAL) uniform uint material_index;
layout(location = UNIFORM_SURFACE) uniform uint surface_index;
