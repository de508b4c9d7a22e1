// SPDX-License-Identifier: MIT
// Direct light against closed forms: lamps, suns, spots, penumbrae, emitters of every shape, skies.
#include "test_direct_stage.h"

#include "base/image.h"
#include "scene/lights/polygon_light.h"

#include <math.h>

static const vec3 UP = {0, 1, 0}, DARK = {0, 0, 0}, GREY = {0.5f, 0.5f, 0.5f};
TEST_CONTEXT(1);

/// A floor of 20 m, and a quad besides where `quad` is one: emission of that alone.
static alp_scene *make_floor(const vec3 *quad, float emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "grey", GREY, DARK));
    alpi_builder_quad(&b, (const vec3[4]){{-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}});
    if (quad != NULL) {
        const vec3 e = {emission, emission, emission};
        alpi_builder_surface(&b, "quad", alpi_builder_material(&b, "quad", GREY, e));
        alpi_builder_quad(&b, quad);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

// --- lamps and suns ------------------------------------------------------------------------------

/// I cosθ / r², without noise and by one ray; 0 behind a quad, and on the side that looks away.
TEST(a_lamp)
{
    const vec3 shade[4] = {{1, 1, 1}, {3, 1, 1}, {3, 1, -1}, {1, 1, -1}};
    const alpi_light lamp = test_lamp((vec3){0, 3, 4}, 100.0f);
    test_stage s = test_stage_open(context, make_floor(shade, 0.0f), &lamp, 1, NULL);
    uint64_t rays;
    test_patch p = test_point(DARK, UP);
    const alpi_reference_value v = test_stage_direct(&s, &p, 64, 1, &rays);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(v.mean[k], ldexp(100.0 * 0.6 / 25.0, -k), 1e-6 * 2.4);
        assert_true(v.variance[k] == 0.0f);
    }
    assert_int_equal(rays, 1);
    p.normal = (vec3){0, -1, 0};
    assert_true(test_stage_direct(&s, &p, 64, 1, &rays).mean[0] == 0.0f && rays == 0);
    // The ray from (4, 0, −3) passes y = 1 at (2.67, 1, −.67).
    p = test_point((vec3){4, 0, -3}, UP);
    assert_true(test_stage_direct(&s, &p, 64, 1, NULL).mean[0] == 0.0f);
    test_stage_close(&s);
}

/// ∫ I cosθ/r² dA = I Ω: the mean over a rectangle is I Ω / A, also of a part that is lit.
TEST(a_lamp_over_a_patch)
{
    // The shade reaches from x = 0 outwards at half the lamp's height: floor beyond x = 0 is dark.
    const vec3 shade[4] = {{0, 1, 9}, {9, 1, 9}, {9, 1, -9}, {0, 1, -9}};
    const alpi_light lamp = test_lamp((vec3){0, 2, 0}, 50.0f);
    const double a = 0.75, b = 0.5, h = 2.0;
    const double omega = 4.0 * atan(a * b / (h * sqrt(a * a + b * b + h * h)));
    const test_patch p = {{-0.75f, 0, -0.5f}, {1.5f, 0, 0}, {0, 0, 1}, UP};
    for (int k = 0; k < 2; k++) {
        test_stage s =
            test_stage_open(context, make_floor(k == 0 ? NULL : shade, 0.0f), &lamp, 1, NULL);
        uint64_t rays;
        const alpi_reference_value v = test_stage_direct(&s, &p, 4096, 1, &rays);
        assert_int_equal(rays, 4096);
        const double expected = 50.0 * omega / (4.0 * a * b) / (k + 1);
        ASSERT_LIGHT(v, expected);
        // Stratified: 4,096 independent points would be 100 and 20 times as far off.
        assert_true(sqrt((double)v.variance[0]) < (k == 0 ? 1e-5 : 1e-3) * expected);
        test_stage_close(&s);
    }
}

/// KHR_lights_punctual: clamp((cosθ − cos outer) / (cos inner − cos outer))².
TEST(a_spot)
{
    alpi_light spot = test_lamp((vec3){0, 2, 0}, 10.0f);
    spot.kind = ALP_LIGHT_SPOT;
    spot.direction = (vec3){0, -1, 0};
    spot.inner_cone = 0.3f;
    spot.outer_cone = 0.6f;
    test_stage s = test_stage_open(context, make_floor(NULL, 0.0f), &spot, 1, NULL);
    for (int i = 0; i < 16; i++) {
        const double angle = 0.05 * i, x = 2.0 * tan(angle), c = cos(angle);
        const test_patch p = test_point((vec3){(float)x, 0, 0}, UP);
        double ramp = (c - cos(0.6)) / (cos(0.3) - cos(0.6));
        ramp = fmin(fmax(ramp, 0.0), 1.0);
        const double expected = 10.0 * c * c * c / 4.0 * ramp * ramp;
        // The ramp divides rounding of the position by cos .3 − cos .6 = .13.
        ASSERT_NEAR(test_stage_direct(&s, &p, 16, 1, NULL).mean[0], expected, 1e-5);
    }
    test_stage_close(&s);
}

/// E⊥ cosθ, of a sun of any size that is above the horizon.
TEST(a_sun)
{
    static const float sizes[] = {0.0f, 0.0093f, 0.4f};
    for (int k = 0; k < 3; k++) {
        alp_lighting_options o = alp_lighting_options_default();
        o.sun.illuminance = 500.0f;
        o.sun.elevation = 0.7f;
        o.sun.size = sizes[k];
        test_stage s = test_stage_open(context, make_floor(NULL, 0.0f), NULL, 0, &o);
        const test_patch p = test_point((vec3){1, 0, 2}, UP);
        uint64_t rays;
        const alpi_reference_value v = test_stage_direct(&s, &p, 1024, 1, &rays);
        ASSERT_LIGHT(v, 500.0 * sin((double)0.7f));
        assert_true(sqrt((double)v.variance[0]) <= 1e-4 * (double)v.mean[0]);
        assert_int_equal(rays, k == 0 ? 1 : 1024);
        test_stage_close(&s);
    }
}

/// Twice ∫ √(r² − z²) dz from 0 to z.
static double lens(double r, double z)
{
    return z * sqrt(r * r - z * z) + r * r * asin(z / r);
}

/// A sun in the zenith, cut by the edge of a roof at angle b from it: on the unit disk below the
/// hemisphere the edge is half an ellipse of semi-axes sin b and 1, the sun a circle of sin a.
static double visible_share(double a, double b)
{
    const double s = sin(a), e = sin(fabs(b));
    if (e >= s) {
        return b < 0.0 ? 1.0 : 0.0;
    }
    const double z = sqrt((s * s - e * e) / (1.0 - e * e));
    const double beyond = (lens(s, z) - e * lens(1.0, z)) / (ALPI_PI * s * s);
    return b < 0.0 ? 1.0 - beyond : beyond;
}

TEST(a_half_covered_sun)
{
    // The roof covers x < 0, 3 m up; the floor at x sees the edge at atan(x/3) left of the zenith.
    const vec3 roof[4] = {{-9, 3, 9}, {0, 3, 9}, {0, 3, -9}, {-9, 3, -9}};
    alpi_light sun = {.kind = ALP_LIGHT_DIRECTIONAL,
                      .color = {1, 1, 1},
                      .intensity = 100.0f,
                      .direction = {0, -1, 0},
                      .range = INFINITY,
                      .size = 0.2f};
    test_stage s = test_stage_open(context, make_floor(roof, 0.0f), &sun, 1, NULL);
    const double half = 0.5 * (double)sun.size;
    for (int i = -7; i <= 7; i++) {
        const float x = 0.045f * (float)i; // the last is beyond the disk
        const test_patch p = test_point((vec3){x, 0, 0}, UP);
        const alpi_reference_value v = test_stage_direct(&s, &p, 4096, 3, NULL);
        // A point right of the edge (x > 0) sees more than half: the edge is at −atan(x/3).
        const double expected = 100.0 * visible_share(half, -atan((double)x / 3.0));
        ASSERT_LIGHT(v, expected);
        assert_true(sqrt((double)v.variance[0]) < 0.3); // 4096 independent points: .78
    }
    ASSERT_NEAR(visible_share(half, 0.0), 0.5, 1e-15);
    test_stage_close(&s);
}

// --- emitters ------------------------------------------------------------------------------------

/// Oracle 6: a rectangle over its corner, and a wall seen from its foot.
TEST(rectangles)
{
    const vec3 over[4] = {{0, 2, 0}, {1.5f, 2, 0}, {1.5f, 2, 0.7f}, {0, 2, 0.7f}};
    const vec3 wall[4] = {{0, 0, -1}, {1.2f, 0, -1}, {1.2f, 0.8f, -1}, {0, 0.8f, -1}};
    const test_patch p = test_point(DARK, UP);
    const double x = 0.75, y = 0.35, w = 1.2, h = 0.8;
    const double f[2] = {(x / sqrt(1 + x * x) * atan(y / sqrt(1 + x * x)) +
                          y / sqrt(1 + y * y) * atan(x / sqrt(1 + y * y))) /
                             (2 * ALPI_PI),
                         (atan(w) - atan(w / sqrt(1 + h * h)) / sqrt(1 + h * h)) / (2 * ALPI_PI)};
    for (int k = 0; k < 2; k++) {
        test_stage s =
            test_stage_open(context, make_floor(k == 0 ? over : wall, 3.0f), NULL, 0, NULL);
        uint64_t rays;
        const alpi_reference_value v = test_stage_direct(&s, &p, 4096, 1, &rays);
        ASSERT_LIGHT(v, 3.0 * ALPI_PI * f[k]);
        assert_true(sqrt((double)v.variance[0]) < 1e-3 * (double)v.mean[0]);
        assert_true(rays <= 4096); // too small to be met
        const test_patch back = test_point((vec3){0.3f, 5, -5}, UP);
        assert_true(test_stage_direct(&s, &back, 256, 1, NULL).mean[0] == 0.0f);
        test_stage_close(&s);
    }
}

/// Of one surface with this emission, triangles as given by `add`.
typedef void shape_fn(alpi_builder *b);
static alp_scene *make_shape(shape_fn *add, float emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "shape");
    alpi_builder_surface(
        &b, "shape", alpi_builder_material(&b, "glow", GREY, (vec3){emission, emission, emission}));
    add(&b);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// A ceiling over the square of side 4 about the origin.
static void add_tiles_across(alpi_builder *b, int across, float y)
{
    const float side = 4.0f / (float)across;
    for (int i = 0; i < across * across; i++) {
        const float x = (float)(i % across) * side - 2.0f, z = (float)(i / across) * side - 2.0f;
        const vec3 tile[4] = {
            {x, y, z}, {x + side, y, z}, {x + side, y, z + side}, {x, y, z + side}};
        alpi_builder_quad(b, tile);
    }
}

static void add_tiles(alpi_builder *b)
{
    add_tiles_across(b, 4, 1.0f);
}

static void add_many_tiles(alpi_builder *b) // more than are listed
{
    add_tiles_across(b, 24, 1.0f);
}

/// A ceiling of many triangles that fills half of the view is met by cosine-distributed rays too:
/// both together give the closed form (four rectangles over their corners).
TEST(a_near_ceiling)
{
    const double q = sqrt(5.0), f = 4.0 * 2.0 * (2.0 / q * atan(2.0 / q)) / (2.0 * ALPI_PI);
    shape_fn *const shapes[] = {add_tiles, add_many_tiles};
    for (int i = 0; i < 2; i++) {
        test_stage s = test_stage_open(context, make_shape(shapes[i], 1.0f), NULL, 0, NULL);
        const test_patch p = test_point(DARK, UP);
        uint64_t rays;
        const alpi_reference_value v = test_stage_direct(&s, &p, 4096, 1, &rays);
        ASSERT_LIGHT(v, ALPI_PI * f);
        assert_int_equal(rays, 2 * 4096);
        assert_true(sqrt((double)v.variance[0]) < 2e-2 * (double)v.mean[0]);
        test_stage_close(&s);
    }
}

/// π L Σ F over all triangles that look at the point: of a convex body, and where none is hidden.
static double sum_of_triangles(const alp_scene *scene, vec3 point, vec3 normal, double radiance)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        sum += fmax(alpi_polygon_form_factor(point, normal, c, 3), 0.0);
    }
    return ALPI_PI * radiance * sum;
}

static void add_far_tiles(alpi_builder *b) // too small to be met
{
    add_tiles_across(b, 4, 12.0f);
}

/// A row of triangles of which a part is above the horizon, and their middle below it.
TEST(a_ceiling_on_the_horizon)
{
    test_stage s = test_stage_open(context, make_shape(add_far_tiles, 1.0f), NULL, 0, NULL);
    const vec3 normal = vec3_normalize_or((vec3){1.0f, -0.15f, 0.0f}, UP); // from x = 1.8 on
    const test_patch p = test_point(DARK, normal);
    const alpi_reference_value v = test_stage_direct(&s, &p, 1 << 14, 2, NULL);
    const double exact = sum_of_triangles(s.scene, p.corner, normal, 1.0);
    ASSERT_LIGHT(v, exact);
    assert_true(exact > 0.0 && sqrt((double)v.variance[0]) < 2e-2 * exact);
    test_stage_close(&s);
}

enum { CORNERS = 64 };
/// The radius whose polygon of 64 corners has the area of a circle of radius 1; what is left at
/// the rim cancels to 1e-4.
static double even_radius(void)
{
    return 1.0 / sqrt(sin(2.0 * ALPI_PI / CORNERS) / (2.0 * ALPI_PI / CORNERS));
}

static void add_disk(alpi_builder *b)
{
    const vec3 down = {0, -1, 0};
    const uint32_t middle = alpi_builder_vertex(b, (vec3){0, 1.5f, 0}, down);
    uint32_t rim[CORNERS];
    for (uint32_t i = 0; i < CORNERS; i++) {
        double c, s;
        alpi_builder_turn(i, CORNERS, &c, &s);
        rim[i] = alpi_builder_vertex(
            b, (vec3){(float)(even_radius() * c), 1.5f, (float)(even_radius() * s)}, down);
    }
    for (uint32_t i = 0; i < CORNERS; i++) {
        alpi_builder_triangle(b, middle, rim[i], rim[(i + 1) % CORNERS]);
    }
}

/// Oracle 5, coaxial and aside.
TEST(a_disk)
{
    test_stage s = test_stage_open(context, make_shape(add_disk, 2.0f), NULL, 0, NULL);
    for (int k = 0; k < 2; k++) {
        const double h = 1.5, a = k == 0 ? 0.0 : 2.0;
        double f = 1.0 / (1.0 + h * h);
        if (k > 0) {
            const double hh = h / a, p = 1.0 / a, z = 1 + hh * hh + p * p;
            f = (1 - (1 + hh * hh - p * p) / sqrt(z * z - 4 * p * p)) / 2;
        }
        const test_patch p = test_point((vec3){0, 0, (float)a}, UP);
        const alpi_reference_value v = test_stage_direct(&s, &p, 16384, 2, NULL);
        ASSERT_NEAR(v.mean[0], 2.0 * ALPI_PI * f,
                    6.0 * sqrt((double)v.variance[0]) + 1e-4 * 2.0 * ALPI_PI * f);
        ASSERT_LIGHT(v, sum_of_triangles(s.scene, p.corner, UP, 2.0));
        assert_true(sqrt((double)v.variance[0]) < 3e-3 * (double)v.mean[0]);
    }
    test_stage_close(&s);
}

static void add_ball(alpi_builder *b)
{
    const alpi_ball ball = {
        .center = {1, 2, 0.5f}, .radius = 0.6f, .top = 0.6f, .slices = 64, .stacks = 32};
    alpi_builder_ball(b, &ball);
}

/// Oracle 4: F = c (r/d)². The far half of the ball is behind the near one.
TEST(a_ball)
{
    test_stage s = test_stage_open(context, make_shape(add_ball, 1.0f), NULL, 0, NULL);
    const test_patch p = test_point(DARK, UP);
    const alpi_reference_value v = test_stage_direct(&s, &p, 16384, 2, NULL);
    const double d2 = 1 + 4 + 0.25, exact = ALPI_PI * 2.0 / sqrt(d2) * 0.36 / d2;
    ASSERT_LIGHT(v, sum_of_triangles(s.scene, p.corner, UP, 1.0));
    // The outline of the facets is smaller: two thirds of 1 − cos(π/64) at each side of it.
    ASSERT_NEAR(v.mean[0], exact, 6.0 * sqrt((double)v.variance[0]) + 4e-3 * exact);
    assert_true(sqrt((double)v.variance[0]) < 3e-3 * exact);
    test_stage_close(&s);
}

static void add_far_ball(alpi_builder *b)
{
    const alpi_ball ball = {
        .center = {8, 12, 4}, .radius = 0.2f, .top = 0.2f, .slices = 24, .stacks = 12};
    alpi_builder_ball(b, &ball);
}

/// A far ball's triangles are drawn by what each gives: nothing is left to chance but where in each
/// a sample falls: a hundredth of the distance.
TEST(a_far_ball_has_hardly_any_noise)
{
    test_stage s = test_stage_open(context, make_shape(add_far_ball, 1.0f), NULL, 0, NULL);
    const test_patch p = test_point(DARK, UP);
    const alpi_reference_value v = test_stage_direct(&s, &p, 16, 3, NULL);
    const double exact = sum_of_triangles(s.scene, p.corner, UP, 1.0);
    assert_true(sqrt((double)v.variance[0]) < 1e-3 * exact);
    ASSERT_NEAR(v.mean[0], exact, 1e-3 * exact); // replicates of two share what is skewed
    test_stage_close(&s);
}

static vec3 turned(vec3 p, double angle)
{
    const double c = cos(angle), s = sin(angle);
    return (vec3){(float)(c * (double)p.x + s * (double)p.z), p.y,
                  (float)(c * (double)p.z - s * (double)p.x)};
}

/// Oracle 11: a pentagon, partly below the horizon of a tilted receiver, from all azimuths alike.
TEST(a_polygon_from_any_side)
{
    static const vec3 shape[5] = {
        {1, 0.4f, -0.8f}, {1, 1.2f, -0.9f}, {1, 1.6f, 0.1f}, {1, 0.9f, 0.8f}, {1, 0.2f, 0.3f}};
    for (int k = 0; k < 8; k++) {
        const double angle = ALPI_PI / 4 * k + 0.1;
        alpi_builder b;
        alp_scene *scene = NULL;
        vec3 c[5];
        uint32_t v[5];
        const vec3 n = turned((vec3){-1, 0, 0}, angle);
        alpi_builder_start(&b, context, "pentagon");
        alpi_builder_surface(&b, "pentagon",
                             alpi_builder_material(&b, "glow", GREY, (vec3){1, 1, 1}));
        for (int i = 0; i < 5; i++) { // clockwise from the origin is the back: turned round
            c[i] = turned(shape[4 - i], angle);
            v[i] = alpi_builder_vertex(&b, c[i], n);
        }
        for (int i = 1; i + 1 < 5; i++) {
            alpi_builder_triangle(&b, v[0], v[i], v[i + 1]);
        }
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        test_stage s = test_stage_open(context, scene, NULL, 0, NULL);
        const vec3 normals[2] = {UP, turned((vec3){-0.48f, 0.8f, 0.36f}, angle)};
        for (int i = 0; i < 2; i++) {
            const double f = alpi_polygon_form_factor(DARK, normals[i], c, 5);
            assert_true(f > 0.01);
            const test_patch p = test_point(DARK, normals[i]);
            const alpi_reference_value e = test_stage_direct(&s, &p, 4096, 4, NULL);
            ASSERT_LIGHT(e, ALPI_PI * f);
            assert_true(sqrt((double)e.variance[0]) < 5e-3 * ALPI_PI * f);
        }
        test_stage_close(&s);
    }
}

static const vec3 screens[2][4] = {
    {{0, 0.2f, 3}, {0, 0.2f, 2}, {0, 1.2f, 2}, {0, 1.2f, 3}},
    {{-2, 0.2f, -2}, {-2, 0.2f, -3}, {-2, 1.2f, -3}, {-2, 1.2f, -2}}};

static void add_screens(alpi_builder *b)
{
    alpi_builder_quad(b, screens[0]);
    alpi_builder_quad(b, screens[1]);
}

/// Three quarters of a strip are behind the first of two screens, a quarter behind both: what the
/// points see that emitters are chosen by is not what all of them see.
TEST(a_patch_that_is_partly_behind)
{
    enum { CUTS = 20000 };
    test_stage s = test_stage_open(context, make_shape(add_screens, 2.0f), NULL, 0, NULL);
    const test_patch strip = {{-3, 0, 0}, {4, 0, 0}, {0, 0, 1e-3f}, UP};
    double sum = 0.0;
    for (int i = 0; i < CUTS; i++) {
        const vec3 at = {(float)(-3.0 + 4.0 * (i + 0.5) / CUTS), 0, 5e-4f};
        for (int k = 0; k < 2; k++) {
            sum += 2.0 * ALPI_PI * fmax(alpi_polygon_form_factor(at, UP, screens[k], 4), 0.0);
        }
    }
    for (uint64_t seed = 1; seed <= 4; seed++) {
        const alpi_reference_value v = test_stage_direct(&s, &strip, 16384, seed, NULL);
        ASSERT_LIGHT(v, sum / CUTS);
        assert_true(sqrt((double)v.variance[0]) < 1e-2 * sum / CUTS);
    }
    test_stage_close(&s);
}

// --- skies ---------------------------------------------------------------------------------------

static alp_lighting_options sky_of(alp_sky_kind kind)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = kind;
    return o;
}

/// Oracles 1 and 2: πL, and πL (1 + cos t) / 2 of the upper half alone.
TEST(an_even_sky)
{
    alp_lighting_options o = sky_of(ALP_SKY_CONSTANT);
    o.sky.strength = 3.0f;
    test_stage s = test_stage_open(context, make_floor(NULL, 0.0f), NULL, 0, &o);
    const test_patch p = test_point((vec3){1, 0, 2}, UP);
    const alpi_reference_value v = test_stage_direct(&s, &p, 64, 1, NULL);
    ASSERT_NEAR(v.mean[0], 3.0 * ALPI_PI, 1e-5); // every ray brings the same
    test_stage_close(&s);
    o = sky_of(ALP_SKY_HEMISPHERE);
    o.sky.up[0] = o.sky.up[1] = o.sky.up[2] = 1.0f;
    o.sky.down[0] = o.sky.down[1] = o.sky.down[2] = 0.0f;
    s = test_stage_open(context, make_floor(NULL, 0.0f), NULL, 0, &o);
    enum { COPIES = 64 };
    static test_patch copies[COPIES];
    static alpi_reference_value values[COPIES];
    const test_patches all = {.count = COPIES, .patches = copies, .offset = 1e-6f};
    for (int k = 0; k < 8; k++) {
        const double tilt = 0.3 * k, truth = ALPI_PI * (1.0 + cos(tilt)) / 2.0;
        double squares = 0.0;
        for (int i = 0; i < COPIES; i++) {
            copies[i] = test_point((vec3){1, 5, 2}, (vec3){(float)sin(tilt), (float)cos(tilt), 0});
        }
        test_stage_gather(&s, &all, 4096, 1, values);
        for (int i = 0; i < COPIES; i++) {
            ASSERT_LIGHT(values[i], truth);
            squares += pow((double)values[i].mean[0] - truth, 2.0) / COPIES;
        }
        assert_true(sqrt(squares) < 4e-3);
    }
    test_stage_close(&s);
}

/// π L (1 − F) before a wall that hides F.
TEST(a_sky_beside_a_wall)
{
    const vec3 wall[4] = {{0, 0, -1}, {1.2f, 0, -1}, {1.2f, 0.8f, -1}, {0, 0.8f, -1}};
    const double w = 1.2, h = 0.8;
    const double f = (atan(w) - atan(w / sqrt(1 + h * h)) / sqrt(1 + h * h)) / (2 * ALPI_PI);
    const alp_lighting_options o = sky_of(ALP_SKY_CONSTANT);
    test_stage s = test_stage_open(context, make_floor(wall, 0.0f), NULL, 0, &o);
    const test_patch p = test_point(DARK, UP);
    const alpi_reference_value v = test_stage_direct(&s, &p, 16384, 5, NULL);
    ASSERT_LIGHT(v, ALPI_PI * (1.0 - f));
    assert_true(sqrt((double)v.variance[0]) < 2e-3);
    test_stage_close(&s);
}

/// E of a level surface under a sky that is small pixels.
static double level_irradiance(const alpi_lighting *lighting)
{
    enum { CUTS = 1024 };
    double sum = 0.0; // midpoints in (cos²θ, φ): dω cosθ = d(cos²θ)/2 dφ
    for (int i = 0; i < CUTS * CUTS; i++) {
        const double y = sqrt((i / CUTS + 0.5) / CUTS), phi = 2 * ALPI_PI * (i % CUTS + 0.5) / CUTS;
        const double r = sqrt(1.0 - y * y);
        const vec3 d = {(float)(r * cos(phi)), (float)y, (float)(r * sin(phi))};
        sum += (double)alpi_sky_radiance(alpi_lighting_sky(lighting), d).x;
    }
    return sum * ALPI_PI / ((double)CUTS * CUTS);
}

/// An image of one bright and many dim pixels: drawn and met together make its integral.
TEST(an_uneven_sky)
{
    enum { WIDTH = 32, HEIGHT = 16 };
    alp_image *image = NULL;
    ASSERT_OK(
        context,
        alp_image_create(context, (alp_image_info){WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT}, &image));
    float *pixels = image->pixels;
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        pixels[i] = 0.2f + 0.01f * (float)(i / 3 % 7);
    }
    for (int k = 0; k < 3; k++) {
        pixels[3 * (4 * WIDTH + 9) + k] = 300.0f;
    }
    alp_lighting_options o = sky_of(ALP_SKY_IMAGE);
    o.sky.image = image;
    test_stage s = test_stage_open(context, make_floor(NULL, 0.0f), NULL, 0, &o);
    const double exact = level_irradiance(s.lighting);
    const test_patch p = test_point((vec3){1, 0, 2}, UP);
    uint64_t rays;
    const alpi_reference_value v = test_stage_direct(&s, &p, 16384, 6, &rays);
    // 20 cuts a pixel of a continuous function.
    ASSERT_NEAR(v.mean[0], exact, 6.0 * sqrt((double)v.variance[0]) + 1e-4 * exact);
    assert_true(sqrt((double)v.variance[0]) < 2e-3 * exact);
    assert_true(rays > 16384 && rays <= 2 * 16384);
    // Spots alone are asked and not met; the soft rest is known.
    alpi_lighting *whole = s.lighting, *soft, *spots;
    ASSERT_OK(context, alpi_lighting_split_sky(whole, &o, &soft, &spots));
    s.lighting = spots;
    const alpi_reference_value spot = test_stage_direct(&s, &p, 1024, 6, &rays);
    const double rest = exact - level_irradiance(soft);
    ASSERT_NEAR(spot.mean[0], rest, 6.0 * sqrt((double)spot.variance[0]) + 1e-3 * rest);
    assert_true(sqrt((double)spot.variance[0]) < 5e-3 * rest);
    assert_true(rays <= 1024);
    s.lighting = whole;
    alpi_lighting_destroy(context, soft);
    alpi_lighting_destroy(context, spots);
    test_stage_close(&s);
    alp_image_destroy(image);
}
