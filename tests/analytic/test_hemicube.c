// SPDX-License-Identifier: MIT
// Light gathered by hemicubes: against closed forms, and against what whole pixels can tell.
#include "test_probe.h"
#include "test_scenes.h"

#include "base/random.h"
#include "maps/lightmap.h"

#include <math.h>

static const vec3 BLACK = {0, 0, 0};
TEST_CONTEXT(1);

// --- what pixels can tell ------------------------------------------------------------------------

/// Of a polygon seen from the origin, in the cube's own axes.
typedef struct pixel_count {
    double centres; // weights of the pixels whose centres it holds
    double unsure;  // weights of those whose centres lie within 1e-5 of its edges
    double crossed; // weights of those that its edges cross
    double squares; // of the same, of their squares
} pixel_count;

enum { MOST = 256 };
static uint8_t marks[4 * MOST * MOST];

/// The pixel that a direction above the horizon lies in, found without the code that is tested.
static uint32_t pixel_of(uint32_t n, const double d[3])
{
    const double x = fabs(d[0]), y = fabs(d[1]), z = d[2], largest = fmax(fmax(x, y), z);
    double u = d[0] / largest, v = d[1] / largest;
    if (x == largest && x > z) {
        u = copysign(2.0 - z / x, d[0]);
    } else if (y == largest && y > z) {
        v = copysign(2.0 - z / y, d[1]);
    }
    const double last = 2.0 * n - 1.0;
    const double column = fmin(fmax(floor((u + 2.0) * n / 2.0), 0.0), last);
    const double row = fmin(fmax(floor((2.0 - v) * n / 2.0), 0.0), last);
    return (uint32_t)(row * 2.0 * n + column);
}

/// Marks pixels along an edge, 64 times in each and more.
static void mark_edge(uint32_t n, const double a[3], const double b[3])
{
    const uint32_t steps = 256 * n;
    for (uint32_t i = 0; i <= steps; i++) {
        const double t = (double)i / steps;
        const double d[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                             a[2] + t * (b[2] - a[2])};
        if (d[2] > 0.0) {
            marks[pixel_of(n, d)] = 1;
        }
    }
}

/// How far inside of all planes through the origin and the edges of a convex polygon, which runs
/// counter-clockwise seen from the origin; sine of the least angle.
static double depth_in(const double (*corners)[3], int count, const double d[3])
{
    double least = 1.0;
    for (int i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        const double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                             a[0] * b[1] - a[1] * b[0]};
        const double lengths = sqrt((c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) *
                                    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        least = fmin(least, -(c[0] * d[0] + c[1] * d[1] + c[2] * d[2]) / lengths);
    }
    return least;
}

static pixel_count count_pixels(uint32_t n, const double (*corners)[3], int count)
{
    pixel_count sum = {0.0, 0.0, 0.0, 0.0};
    memset(marks, 0, sizeof marks);
    for (int i = 0; i < count; i++) {
        mark_edge(n, corners[i], corners[(i + 1) % count]);
    }
    for (uint32_t i = 0; i < 4 * n * n; i++) {
        const uint32_t c = i % (2 * n), r = i / (2 * n);
        double d[3];
        if (!alpi_hemicube_pixel(n, c, r, d)) {
            continue;
        }
        const double w = alpi_hemicube_weight(n, c, r), depth = depth_in(corners, count, d);
        sum.centres += depth > 0.0 ? w : 0.0;
        sum.unsure += fabs(depth) < 1e-5 ? w : 0.0;
        sum.crossed += marks[i] ? w : 0.0;
        sum.squares += marks[i] ? w * w : 0.0;
    }
    return sum;
}

/// Even over directions. @param k which of many
static vec3 direction_of(uint32_t k)
{
    const vec2 u = alpi_sample_2d(77, k);
    const float z = 1.0f - 2.0f * u.x, r = sqrtf(fmaxf(1.0f - z * z, 0.0f));
    const float phi = 2.0f * (float)ALPI_PI * u.y;
    return vec3_normalize_or((vec3){r * cosf(phi), r * sinf(phi), z}, (vec3){0, 1, 0});
}

// --- light without edges -------------------------------------------------------------------------

/// E = πL for any resolution, axis and turn: to the rounding of the weights.
TEST(a_constant_sky_is_exact)
{
    static const uint32_t resolutions[] = {2, 4, 6, 10, 14, 64, 130};
    const alp_lighting_options o = test_sky_of(ALP_SKY_CONSTANT);
    test_probe p = test_probe_open(context, test_probe_quad(context, NULL), &o, 2);
    for (uint32_t k = 0; k < 7; k++) {
        test_probe_set_resolution(&p, resolutions[k]);
        for (uint32_t i = 0; i < 6; i++) {
            const vec3 n = i == 0 ? (vec3){0, 1, 0} : direction_of(i);
            const alpi_receiver_point point = test_probe_point((vec3){0, -8, 20}, n);
            p.options.turned = i % 2 != 0;
            ASSERT_NEAR(test_probe_gather(&p, &point, i), ALPI_PI, 2e-7 * ALPI_PI);
        }
    }
    p.options.from.sky = false;
    const alpi_receiver_point point = test_probe_point(BLACK, (vec3){0, 1, 0});
    assert_true(test_probe_gather(&p, &point, 0) == 0.0);
    test_probe_close(&p);
}

// --- horizons ------------------------------------------------------------------------------------

/// The weights of the pixels that a great circle crosses: all directions across `axis`.
static double crossed_by_horizon(uint32_t n, const alpi_hemicube_frame *f, vec3 axis)
{
    vec3 t, b;
    vec3_frame(axis, &t, &b);
    const vec3 round[4] = {t, b, vec3_scale(t, -1.0f), vec3_scale(b, -1.0f)};
    double local[4][3], sum = 0.0;
    memset(marks, 0, sizeof marks);
    for (int i = 0; i < 4; i++) {
        local[i][0] = (double)vec3_dot(round[i], f->right);
        local[i][1] = (double)vec3_dot(round[i], f->up);
        local[i][2] = (double)vec3_dot(round[i], f->forward);
    }
    for (int i = 0; i < 4; i++) {
        mark_edge(n, local[i], local[(i + 1) % 4]);
    }
    for (uint32_t i = 0; i < 4 * n * n; i++) {
        sum += marks[i] ? alpi_hemicube_weight(n, i % (2 * n), i / (2 * n)) : 0.0;
    }
    return sum;
}

/// E = πL (1 + cos t)/2 of a sky that is bright above the horizon alone, at a tilt of t. Where the
/// surface itself is tilted against its shading normal, rays below it are traced, as the reference
/// traces them: with nothing in their way, all of a constant sky is there.
TEST(horizons_count_by_whole_pixels)
{
    for (int own = 0; own < 2; own++) {
        const alp_lighting_options o = test_sky_of(own ? ALP_SKY_CONSTANT : ALP_SKY_HEMISPHERE);
        test_probe p = test_probe_open(context, test_probe_quad(context, NULL), &o, 32);
        for (uint32_t i = 0; i < 40; i++) {
            const vec3 up = {0, 1, 0}, n = direction_of(i);
            const alpi_receiver_point point = {{0, 1, 0}, own ? up : n, n, 0.0f};
            const alpi_hemicube_frame f = alpi_hemicube_frame_about(n, 0.04f * (float)i);
            float e[3];
            ASSERT_OK(context, alpi_hemicube_gather_in(&p.options, &point, &f, e));
            ASSERT_NEAR((double)e[0] / ALPI_PI, own ? 1.0 : 0.5 + 0.5 * (double)n.y,
                        own ? 2e-7 : crossed_by_horizon(32, &f, up));
        }
        test_probe_close(&p);
    }
}

// --- polygons ------------------------------------------------------------------------------------

/// A polygon of radiance 1 about the cube's own axes: E and what is known of it.
typedef struct polygon_light {
    double closed_form;
    pixel_count pixels;
} polygon_light;

/// Corners in the cube's own axes. Right, up and forward are left-handed, so that the order turns.
static void see(const alpi_hemicube_frame *frame, const vec3 *quad, double local[4][3])
{
    const vec3 axes[3] = {frame->right, frame->up, frame->forward};
    for (int i = 0; i < 4; i++) {
        const vec3 c = quad[3 - i];
        for (int k = 0; k < 3; k++) {
            local[i][k] = (double)c.x * (double)axes[k].x + (double)c.y * (double)axes[k].y +
                          (double)c.z * (double)axes[k].z;
        }
    }
}

static double form_factor(const double (*local)[3])
{
    const double origin[3] = {0, 0, 0}, normal[3] = {0, 0, 1};
    return test_polygon_form_factor(origin, normal, local, 4);
}

/// @param frame of the cube at the origin   @param quad counter-clockwise seen from the origin
static polygon_light look_at(uint32_t n, const alpi_hemicube_frame *frame, const vec3 *quad)
{
    double local[4][3];
    see(frame, quad, local);
    const double(*corners)[3] = (const double(*)[3])local;
    return (polygon_light){form_factor(corners), count_pixels(n, corners, 4)};
}

/// Holds one gather to its polygon: all of it that whole pixels tell, and the truth but for the
/// pixels on the edges. @return E / π − F
static double hold(const test_probe *p, const alpi_hemicube_frame *frame, const vec3 *quad,
                   polygon_light *light)
{
    const alpi_receiver_point point = {BLACK, frame->forward, frame->forward, 0.0f};
    float e[3];
    ASSERT_OK(context, alpi_hemicube_gather_in(&p->options, &point, frame, e));
    *light = look_at(p->cube->resolution, frame, quad);
    const double f = (double)e[0] / ALPI_PI;
    ASSERT_NEAR(f, light->pixels.centres, light->pixels.unsure + 2e-7);
    // A corner that cuts less than a 64th off a pixel is not marked.
    ASSERT_NEAR(f, light->closed_form, 1.02 * light->pixels.crossed + 1e-7);
    return f - light->closed_form;
}

/// Wide quads above and beside, cut by the horizon and not: the error falls by more than a pixel's
/// size, 1/n, because it is as often up as down.
TEST(a_large_polygon)
{
    // Faces the origin; 4 m × 3 m, 2 m away.
    const vec3 quad[4] = {{-2, 2, -1}, {2, 2, -1}, {2, 2, 2}, {-2, 2, 2}};
    static const uint32_t resolutions[] = {8, 32, 128};
    double error[3] = {0, 0, 0}, predicted[3] = {0, 0, 0};
    test_probe p = test_probe_open(context, test_probe_quad(context, quad), NULL, 2);
    for (uint32_t k = 0; k < 3; k++) {
        test_probe_set_resolution(&p, resolutions[k]);
        for (uint32_t i = 0; i < 40; i++) {
            const alpi_hemicube_frame f =
                alpi_hemicube_frame_about(direction_of(i), 0.04f * (float)i);
            polygon_light light;
            const double off = hold(&p, &f, quad, &light);
            error[k] += off * off / 40.0;
            predicted[k] += light.pixels.squares / 12.0 / 40.0;
        }
        // A crossed pixel errs by any part of ± ½ of its weight; 40 such sums tell their root mean
        // square to 11 %, four times which is .45.
        assert_true(error[k] < 1.45 * 1.45 * predicted[k]);
    }
    test_probe_close(&p);
}

// --- the seed's loss at edges --------------------------------------------------------------------

/// A frame in which a direction of the scene appears at `local`.
static alpi_hemicube_frame frame_with(vec3 world, const double local[3], float spin)
{
    // Axes about the two directions, each with the same handedness, and the turn between them.
    vec3 a[3], b[3];
    const vec3 there = {(float)local[0], (float)local[1], (float)local[2]};
    const alpi_hemicube_frame w = alpi_hemicube_frame_about(world, spin);
    const alpi_hemicube_frame l = alpi_hemicube_frame_about(there, 0.0f);
    a[0] = w.right, a[1] = w.up, a[2] = w.forward;
    // In the left-handed local axes the same triad has its first vector mirrored.
    b[0] = vec3_scale(l.right, -1.0f), b[1] = l.up, b[2] = l.forward;
    float in_local[3][3];
    vec3 axes[3];
    for (int k = 0; k < 3; k++) {
        vec3_store(in_local[k], b[k]);
    }
    for (int k = 0; k < 3; k++) {
        axes[k] = vec3_scale(a[0], in_local[0][k]);
        axes[k] = vec3_mad(axes[k], in_local[1][k], a[1]);
        axes[k] = vec3_mad(axes[k], in_local[2][k], a[2]);
    }
    return (alpi_hemicube_frame){axes[0], axes[1], axes[2]};
}

static const vec3 SMALL[4] = {
    {-0.2f, 2, -0.2f}, {0.2f, 2, -0.2f}, {0.2f, 2, 0.2f}, {-0.2f, 2, 0.2f}};

/// A small emitter goes from the zenith to below the horizon, across the edge between two faces, or
/// the corner where three meet, and once round through four upright edges.
TEST(a_small_emitter_sweeps_over_edges_and_corners)
{
    const uint32_t steps = 160;
    test_probe p = test_probe_open(context, test_probe_quad(context, SMALL), NULL, 32);
    for (int sweep = 0; sweep < 3; sweep++) {
        for (uint32_t i = 0; i < steps; i++) {
            const double t = (double)i / steps;
            const double azimuth = sweep == 2 ? 2.0 * ALPI_PI * t : ALPI_PI / 4.0 * (double)sweep;
            const double tilt = sweep == 2 ? 1.2 : 1.7 * t;
            const double local[3] = {sin(tilt) * cos(azimuth), sin(tilt) * sin(azimuth), cos(tilt)};
            const alpi_hemicube_frame f = frame_with((vec3){0, 1, 0}, local, 0.3f);
            polygon_light light;
            hold(&p, &f, SMALL, &light);
        }
    }
    test_probe_close(&p);
}

/// Not more lost than won: at places drawn about two edges, their corner, the horizon and nowhere
/// special, the mean error is zero.
TEST(nothing_is_lost_at_edges)
{
    enum { PLACES = 1500 };
    static const double centres[5][3] = {
        {1, 0.3, 1}, {1, 1, 0.4}, {1, 1, 1}, {1, -0.2, 0.1}, {0.4, 0.3, 1}};
    test_probe p = test_probe_open(context, test_probe_quad(context, SMALL), NULL, 32);
    for (int k = 0; k < 5; k++) {
        double sum = 0.0, squares = 0.0, all = 0.0;
        for (uint32_t i = 0; i < PLACES; i++) {
            const vec2 a = alpi_sample_2d(5, i), b = alpi_sample_2d(6, i);
            const vec3 to = {(float)centres[k][0] + 0.5f * (a.x - 0.5f),
                             (float)centres[k][1] + 0.5f * (a.y - 0.5f),
                             (float)centres[k][2] + 0.5f * (b.x - 0.5f)};
            const vec3 unit = vec3_normalize_or(to, to);
            const double local[3] = {(double)unit.x, (double)unit.y, (double)unit.z};
            const alpi_hemicube_frame f = frame_with((vec3){0, 1, 0}, local, 6.2832f * b.y);
            const alpi_receiver_point point = {BLACK, f.forward, f.forward, 0.0f};
            double corners[4][3];
            see(&f, SMALL, corners);
            const double exact = form_factor((const double(*)[3])corners);
            float e[3];
            ASSERT_OK(context, alpi_hemicube_gather_in(&p.options, &point, &f, e));
            const double off = (double)e[0] / ALPI_PI - exact;
            sum += off;
            squares += off * off;
            all += exact;
        }
        const double mean = sum / PLACES;
        const double error = sqrt((squares / PLACES - mean * mean) / PLACES);
        // What centres miss of how weights curve is 1.7 / n² at the corner of three faces, and
        // falls by four from n = 32 to 64; one lost row would be an eighth of the emitter.
        ASSERT_NEAR(mean, 0.0, 4.0 * error + 2.0 / (32 * 32) * all / PLACES);
    }
    test_probe_close(&p);
}

// --- against the path tracer ---------------------------------------------------------------------

/// The Cornell box's lamp, counterclockwise from inside the room, and its radiance.
static const vec3 LAMP[4] = {{0.343f, 0.5488f, 0.227f},
                             {0.343f, 0.5488f, 0.332f},
                             {0.213f, 0.5488f, 0.332f},
                             {0.213f, 0.5488f, 0.227f}};
static const double LAMP_RADIANCE = 20.717;

static alpi_hemicube_frame cornell_frame(const test_patch *patch, uint32_t i)
{
    return alpi_hemicube_frame_about(patch->normal, 0.7f * (float)i);
}

/// Weights of the pixels that the lamp's edges cross, and of their squares.
static pixel_count lamp_pixels(uint32_t n, const test_patch *patch, uint32_t i)
{
    const alpi_hemicube_frame f = cornell_frame(patch, i);
    vec3 seen[4];
    for (int k = 0; k < 4; k++) {
        seen[k] = vec3_sub(LAMP[k], patch->corner);
    }
    return look_at(n, &f, seen).pixels;
}

/// At points of floor and walls, past the blocks: what is seen of the lamp where a straight edge
/// hides some of it has no longer a rim than the whole.
TEST(direct_light_in_the_cornell_box)
{
    enum { POINTS = 96, N = 64 };
    static test_patch patches[POINTS];
    static alpi_reference_value values[POINTS];
    alp_scene *scene = test_load(context, "builtin:cornell");
    test_probe p = test_probe_open(context, scene, NULL, N);
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec2 u = alpi_sample_2d(9, i);
        const float a = 0.02f + 0.5f * u.x, b = 0.02f + 0.5f * u.y;
        patches[i] = i % 2 == 0 ? test_point((vec3){a, 0, b}, (vec3){0, 1, 0})
                                : test_point((vec3){0, a, b}, (vec3){1, 0, 0});
    }
    const test_patches all = {.count = POINTS, .patches = patches, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&all);
    const alpi_reference r = test_stage_reference(&p.stage, 1024);
    ASSERT_OK(context, alpi_reference_irradiance(&r, &receivers, NULL, 0, NULL, values));
    double squares = 0.0, predicted = 0.0, sum = 0.0, scale = ALPI_PI * LAMP_RADIANCE;
    for (uint32_t i = 0; i < POINTS; i++) {
        const alpi_receiver_point point = test_probe_point(patches[i].corner, patches[i].normal);
        const alpi_hemicube_frame f = cornell_frame(&patches[i], i);
        const pixel_count rim = lamp_pixels(N, &patches[i], i);
        const double variance = (double)values[i].variance[0];
        float e[3];
        ASSERT_OK(context, alpi_hemicube_gather_in(&p.options, &point, &f, e));
        ASSERT_NEAR(e[0], values[i].mean[0], 1.02 * scale * rim.crossed + 6.0 * sqrt(variance));
        const double off = (double)e[0] - (double)values[i].mean[0];
        squares += off * off / POINTS;
        sum += off / POINTS;
        predicted += (scale * scale * rim.squares / 12.0 + variance) / POINTS;
    }
    // Four standard errors of a root mean square of 96, and of their mean.
    assert_true(squares < 1.29 * 1.29 * predicted);
    ASSERT_NEAR(sum, 0.0, 4.0 * sqrt(squares / POINTS));
    test_probe_close(&p);
}

// --- emitters of a bake --------------------------------------------------------------------------

enum { BAKED_PIXELS = 32 };

static alp_bake_options counting(alp_emitters emitters)
{
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = 56;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = ALP_MAP_LIGHT;
    o.light.gather = ALP_GATHER_HEMICUBE;
    o.light.hemicube = BAKED_PIXELS;
    o.light.emitters = emitters;
    o.light.direct = ALP_DIRECT_APART;
    o.light.bounces = 2;
    o.stitch = false; // what is dark stays dark
    return o;
}

static alp_lightmap *bake(const alp_scene *scene, const alp_bake_options *o,
                          alp_bake_report *report)
{
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, o, &lightmap, report));
    return lightmap;
}

/// What a texel sees of the lamp, if nothing is in its way, by hemicubes turned anyhow; the form
/// factor is 0 where a texel is so near that light changes within it.
static polygon_light lamp_from(const alp_lightmap *l, uint32_t texel)
{
    alpi_receiver_point point;
    alpi_texels_point(&l->texels, texel, &point);
    const alpi_hemicube_frame f =
        alpi_hemicube_frame_about(point.shading_normal, 0.7f * (float)texel);
    const vec3 middle = vec3_scale(vec3_add(LAMP[0], LAMP[2]), 0.5f);
    const vec3 to = vec3_sub(middle, point.position);
    vec3 seen[4];
    for (int k = 0; k < 4; k++) {
        seen[k] = vec3_sub(LAMP[k], point.position);
    }
    if (vec3_length(to) < 0.35f || vec3_dot(to, point.shading_normal) < 0.05f) {
        return (polygon_light){.closed_form = 0.0};
    }
    return look_at(BAKED_PIXELS, &f, seen);
}

static double value_of(const alp_lightmap *l, alp_map map, uint32_t texel)
{
    const float *page = alp_lightmap_map_page(l, map, l->texels.pages[texel], NULL, NULL);
    const uint16_t *pixel = l->texels.pixels[texel];
    return (double)page[4 * ((size_t)pixel[1] * l->width + pixel[0])];
}

/// Texels that see all of the lamp: off by what its rim crosses, and right in the mean. What sees
/// nothing of it gets nothing.
TEST(a_bake_may_count_emitters)
{
    const alp_bake_options told = counting(ALP_EMITTERS_ANALYTIC);
    const alp_bake_options counts = counting(ALP_EMITTERS_COUNTED);
    alp_bake_report reports[2];
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_lightmap *analytic = bake(scene, &told, &reports[0]);
    alp_lightmap *counted = bake(scene, &counts, &reports[1]);
    const double scale = ALPI_PI * LAMP_RADIANCE;
    double squares = 0.0, predicted = 0.0, sum = 0.0;
    uint32_t lit = 0, dark = 0;
    for (uint32_t t = 0; t < analytic->texels.count; t++) {
        const polygon_light lamp = lamp_from(analytic, t);
        const double a = value_of(analytic, ALP_MAP_DIRECT, t);
        const double off = value_of(counted, ALP_MAP_DIRECT, t) - a;
        if (analytic->texels.coverages[t] < 0.999f) {
            continue; // its light is not that of its point
        }
        if (a == 0.0) {
            assert_true(off == 0.0);
            dark++;
        }
        if (lamp.closed_form > 1e-3 && a > 0.995 * scale * lamp.closed_form) {
            squares += off * off;
            sum += off;
            predicted += scale * scale * lamp.pixels.squares / 12.0;
            lit++;
        }
    }
    print_message(
        "accuracy: emitters counted by hemicubes of %d in the Cornell box, %u texels that "
        "see all of the lamp: off by %.3f W/m2 (root mean square; rim pixels allow %.3f), "
        "mean off by %.4f\n",
        (int)BAKED_PIXELS, lit, sqrt(squares / lit), sqrt(predicted / lit), sum / lit);
    assert_true(lit > 400 && dark > 100);
    // Four standard errors of a root mean square of so many, and of their mean; edges that run
    // along rows of pixels, of which there are few across a lamp, err by a row at once: a tenth
    // more.
    const double spread = 4.0 / sqrt(2.0 * lit);
    assert_true(squares < (1.1 + spread) * (1.1 + spread) * predicted);
    assert_true(squares > (1.0 - spread) * (1.0 - spread) * 0.5 * predicted); // it is not analytic
    ASSERT_NEAR(sum / lit, 0.0, 4.0 * sqrt(squares) / lit);
    // Twice the rays of the texels, but for shadow rays and for what texels gather in blocks.
    const double cube = 3.0 * BAKED_PIXELS * BAKED_PIXELS * analytic->texels.count;
    assert_true((double)reports[1].rays - (double)reports[0].rays > 0.8 * cube);
    alp_lightmap_destroy(analytic);
    alp_lightmap_destroy(counted);
    alp_scene_destroy(scene);
}

/// Lamps, suns and skies are no surfaces: the same bits either way.
TEST(other_lights_are_not_counted)
{
    alp_lamp lamp = alp_lamp_default();
    alp_scene *scene = NULL;
    lamp.position[1] = 1.0f;
    lamp.intensity = 1.0f;
    ASSERT_OK(context, alp_scene_load(context, "builtin:torus-plane", &scene));
    for (int soft = 0; soft < 2; soft++) {
        alp_lightmap *maps[2];
        for (int i = 0; i < 2; i++) {
            alp_bake_options o = counting((alp_emitters)i);
            o.light.hemicube = 8;
            o.light.lighting.lamps = &lamp;
            o.light.lighting.lamp_count = 1;
            o.light.lighting.sky.kind = soft ? ALP_SKY_CONSTANT : ALP_SKY_NONE;
            maps[i] = bake(scene, &o, NULL);
        }
        for (uint32_t t = 0; t < maps[0]->texels.count; t++) {
            assert_true(value_of(maps[0], ALP_MAP_LIGHT, t) == value_of(maps[1], ALP_MAP_LIGHT, t));
        }
        alp_lightmap_destroy(maps[0]);
        alp_lightmap_destroy(maps[1]);
    }
    alp_scene_destroy(scene);
}

TEST(what_cannot_be_counted_is_refused)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    for (int i = 0; i < 5; i++) {
        alp_bake_options o = counting(ALP_EMITTERS_COUNTED);
        o.light.direct = ALP_DIRECT_ON;
        o.light.gather = i == 0 ? ALP_GATHER_RAYS : ALP_GATHER_HEMICUBE;
        o.light.bounces = i == 1 ? 0 : 1;
        o.light.layers = i == 2;
        o.only = i == 3 ? "*" : NULL;
        o.light.emitters = i == 4 ? (alp_emitters)2 : ALP_EMITTERS_COUNTED;
        assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    }
    alp_scene_destroy(scene);
}
