// SPDX-License-Identifier: MIT
// The Cornell box as measured: Cornell University Program of Computer Graphics, "Cornell Box Data".
// Positions in the room's own millimetres. The camera looks along +z, so +x is on the left of the
// picture and the red wall stands there. The ceiling is cut round the lamp; blocks have no bottom,
// as in the data.
#include "scene/builtin/builtin.h"

/// Reflectance spectra, 400 to 700 nm, under D65, as linear Rec.709 (CIE 1931, 2°).
static const vec3 WHITE = {0.73826f, 0.73598f, 0.73868f};
static const vec3 GREEN = {0.06842f, 0.39846f, 0.08657f};
static const vec3 RED = {0.49389f, 0.04887f, 0.05116f};
/// The lamp's own reflectance, as usually taken, and its emission spectrum as linear Rec.709, not
/// adapted, over the integral of ȳ.
static const vec3 LAMP = {0.78f, 0.78f, 0.78f};
static const vec3 LAMP_EMISSION = {20.717f, 10.855f, 2.771f};
static const vec3 NO_EMISSION = {0.0f, 0.0f, 0.0f};

/// 35 mm of focal length, 25 mm of film: 2 atan(12.5 / 35).
static const float FIELD_OF_VIEW = 0.6860479f;

typedef struct wall {
    const char *name;
    float corners[4][3]; // mm, counter-clockwise from inside the room
} wall;

static const wall FLOOR = {"floor",
                           {{552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}}};
static const wall BACK = {
    "back wall", {{549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}}};
static const wall RIGHT = {"green wall",
                           {{0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}}};
static const wall LEFT = {
    "red wall", {{552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}}};
static const float CEILING[4][3] = {
    {556, 548.8f, 0}, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {0, 548.8f, 0}};
static const float LIGHT[4][3] = {
    {343, 548.8f, 227}, {343, 548.8f, 332}, {213, 548.8f, 332}, {213, 548.8f, 227}};

/// Corners (x, z) of the tops of the blocks.
static const float SHORT_BLOCK[4][2] = {{130, 65}, {82, 225}, {240, 272}, {290, 114}};
static const float TALL_BLOCK[4][2] = {{423, 247}, {265, 296}, {314, 456}, {472, 406}};
static const float SHORT_HEIGHT = 165, TALL_HEIGHT = 330;

static vec3 metres(float x, float y, float z)
{
    return (vec3){x / 1000.0f, y / 1000.0f, z / 1000.0f};
}

static vec3 load_metres(const float p[3])
{
    return metres(p[0], p[1], p[2]);
}

static void build_quad(alpi_builder *builder, const float corners[4][3])
{
    const vec3 quad[4] = {load_metres(corners[0]), load_metres(corners[1]), load_metres(corners[2]),
                          load_metres(corners[3])};
    alpi_builder_quad(builder, quad);
}

static void build_wall(alpi_builder *builder, const wall *w, uint32_t material)
{
    alpi_builder_surface(builder, w->name, material);
    build_quad(builder, w->corners);
}

/// Four trapezoids between the outer edges and the lamp's.
static void build_ceiling(alpi_builder *builder, uint32_t material)
{
    alpi_builder_surface(builder, "ceiling", material);
    for (int i = 0; i < 4; i++) {
        int next = (i + 1) % 4;
        const vec3 quad[4] = {load_metres(CEILING[i]), load_metres(CEILING[next]),
                              load_metres(LIGHT[next]), load_metres(LIGHT[i])};
        alpi_builder_quad(builder, quad);
    }
}

static void build_block(alpi_builder *builder, const float top[4][2], float height)
{
    vec3 upper[4], lower[4];
    for (int i = 0; i < 4; i++) {
        upper[i] = metres(top[i][0], height, top[i][1]);
        lower[i] = metres(top[i][0], 0.0f, top[i][1]);
    }
    alpi_builder_quad(builder, upper);
    for (int i = 0; i < 4; i++) {
        int next = (i + 1) % 4;
        const vec3 side[4] = {upper[next], upper[i], lower[i], lower[next]};
        alpi_builder_quad(builder, side);
    }
}

void alpi_builtin_cornell(alpi_builder *builder)
{
    uint32_t white = alpi_builder_material(builder, "white", WHITE, NO_EMISSION);
    uint32_t green = alpi_builder_material(builder, "green", GREEN, NO_EMISSION);
    uint32_t red = alpi_builder_material(builder, "red", RED, NO_EMISSION);
    uint32_t lamp = alpi_builder_material(builder, "lamp", LAMP, LAMP_EMISSION);
    build_wall(builder, &FLOOR, white);
    build_ceiling(builder, white);
    build_wall(builder, &BACK, white);
    build_wall(builder, &RIGHT, green);
    build_wall(builder, &LEFT, red);
    alpi_builder_surface(builder, "short block", white);
    build_block(builder, SHORT_BLOCK, SHORT_HEIGHT);
    alpi_builder_surface(builder, "tall block", white);
    build_block(builder, TALL_BLOCK, TALL_HEIGHT);
    alpi_builder_surface(builder, "lamp", lamp);
    build_quad(builder, LIGHT);
    alpi_builder_camera(builder, metres(278, 273, -800), metres(278, 273, 279.6f), FIELD_OF_VIEW);
}
