// SPDX-License-Identifier: MIT
// Light that a red floor reflects, from the host's own reflective shadow map. No scene, no rays.
//
//     cc 08_lpv.c -o lpv $(pkg-config --cflags --libs alpenglow) -lm
//
// A host on a GPU reads the map back, or draws it in software. Each texel of it holds the position,
// the normal and the flux of the surface that the sun meets first.
#include <alpenglow/alpenglow.h>

#include <math.h>
#include <stdio.h>

enum { SIDE = 64, TEXELS = SIDE * SIDE };
static const float FLOOR = 4.0f,
                   LUX = 50000.0f; // metres of a side; E of a surface that faces the sun
static const float ALBEDO[3] = {0.8f, 0.2f, 0.1f};

static float positions[TEXELS][3], normals[TEXELS][3], flux[TEXELS][3], albedo[TEXELS][3];
static float areas[TEXELS];

/// Fills the map of a sun at a height in radians: a parallel view of the floor along its light.
static alp_lpv_surfels draw_map(float height)
{
    const float area = FLOOR * FLOOR / TEXELS; // of the floor, in a texel
    const float across = area * sinf(height);  // of the map itself
    for (int i = 0; i < TEXELS; i++) {
        const int column = i % SIDE, row = i / SIDE;
        positions[i][0] = FLOOR * (((float)column + 0.5f) / SIDE - 0.5f);
        positions[i][1] = 0.0f;
        positions[i][2] = FLOOR * (((float)row + 0.5f) / SIDE - 0.5f);
        normals[i][1] = 1.0f;
        areas[i] = area;
        for (int k = 0; k < 3; k++) {
            albedo[i][k] = ALBEDO[k];
            flux[i][k] = ALBEDO[k] * LUX * across;
        }
    }
    return (alp_lpv_surfels){.count = TEXELS,
                             .positions = (const float(*)[3])positions,
                             .normals = (const float(*)[3])normals,
                             .flux = (const float(*)[3])flux,
                             .areas = areas,
                             .albedo = (const float(*)[3])albedo};
}

/// The work of a host in each frame.
static alp_result light_frame(alp_lpv *lpv, float height)
{
    const alp_lpv_surfels map = draw_map(height);
    alp_lpv_begin(lpv);
    alp_result result = alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &map);
    result = result ? result : alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &map);
    return result ? result : alp_lpv_propagate(lpv);
}

/// E that the floor's reflection gives a ceiling 1 m above its centre, for red: by the volume, and
/// albedo x E x the form factor of a square.
static void print_ceiling(const alp_field *field, float height)
{
    const float position[1][3] = {{0.0f, 1.0f, 0.0f}}, down[1][3] = {{0.0f, -1.0f, 0.0f}};
    const float half = 0.5f * FLOOR, slant = sqrtf(1.0f + half * half);
    const float factor = 4.0f / 3.14159265f * half / slant * atanf(half / slant);
    float e[1][3];
    alp_field_irradiance(field, 1, position, down, e);
    printf("sun at %2.0f degrees: ceiling lit by %.0f lux of red, closed form %.0f\n",
           (double)(height * 57.2957795f), (double)e[0][0],
           (double)(ALBEDO[0] * LUX * sinf(height) * factor));
}

int main(void)
{
    alp_context *context = NULL;
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    alp_lpv_options options = alp_lpv_options_default(); // 32 x 32 x 32 cells
    options.cell = 0.25;
    options.centre[1] = 2.0;
    alp_result result = alp_context_create(NULL, &context);
    result = result ? result : alp_lpv_create(context, &options, &lpv);
    result = result ? result : alp_field_create_lpv(lpv, &field);
    for (float height = 0.5f; height < 1.6f && result == ALP_OK; height += 0.5f) {
        result = light_frame(lpv, height);
        print_ceiling(field, height);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(context));
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
