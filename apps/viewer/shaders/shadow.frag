#version 450 core
// Depth as a light sees it. Panes that let half the light through or more cast no shadow, and other
// panes a whole one.
#include "surface.glsl"

void main()
{
    material m = materials[material_index];
    if (m.alpha_mode == ALPHA_OPAQUE && m.transmission <= 0.0) {
        return;
    }
    vec3 through = read_surface(true).through;
    if (through.r + through.g + through.b >= 1.5) {
        discard;
    }
}
