// SPDX-License-Identifier: MIT
// Light that nothing hides, through the path tracer: skies, suns, lamps and spots over receivers of
// any tilt, and what a camera sees of them.
#include "test_lit.h"

#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdio.h>

TEST_CONTEXT(2);

// --- receivers in free space ---------------------------------------------------------------------

/// A black square metre, a kilometre from all that is asked: it takes 1e-6 of a hemisphere or less.
static alp_scene *far_ground(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "far");
    alpi_builder_surface(
        &b, "far",
        alpi_builder_material(&b, "black", (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, 0.0f}));
    alpi_builder_quad(&b,
                      (const vec3[4]){{0, -1000, 1}, {1, -1000, 1}, {1, -1000, 0}, {0, -1000, 0}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

enum { TILTS = 7, AZIMUTHS = 8, AXES = TILTS * AZIMUTHS };

/// Normals 0° to 180° from straight up, in steps of 30°, from eight azimuths.
static void make_axes(vec3 axes[AXES])
{
    for (int i = 0; i < AXES; i++) {
        const double tilt = ALPI_PI * (i / AZIMUTHS) / (TILTS - 1);
        const double azimuth = 2.0 * ALPI_PI * (i % AZIMUTHS) / AZIMUTHS + 0.2;
        axes[i] = (vec3){(float)(sin(tilt) * sin(azimuth)), (float)cos(tilt),
                         (float)(sin(tilt) * cos(azimuth))};
    }
}

/// E at the origin for each axis.
static void gather(const alpi_reference *r, const vec3 *axes, uint32_t count,
                   alpi_reference_value *values)
{
    static const vec3 origins[AXES];
    test_lit_irradiance(r, origins, axes, 1e-6f, count, values);
}

/// As seldom as 4 standard errors: the spread is measured by 16 replicates (Student's t of 15
/// degrees of freedom is beyond it once in 16,000 times, beyond 4 once in 860).
static const double STANDARD_ERRORS = 5.5;

/// Holds E at all axes to `exact` in channel 1, each and in their mean; returns the largest error
/// over exact[0]. `slack` is what may be missing of exact[0] without being noise, beside rounding.
static double hold(const alpi_reference_value *values, const double *exact, uint32_t count,
                   double slack)
{
    const double least = (slack + 1e-6) * exact[0];
    double variance = 0.0, worst = 0.0, error = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double own = (double)values[i].variance[1],
                     apart = (double)values[i].mean[1] - exact[i];
        ASSERT_NEAR(values[i].mean[1], exact[i], STANDARD_ERRORS * sqrt(own) + least);
        variance += own;
        error += apart / count;
        worst = fmax(worst, fabs(apart));
    }
    ASSERT_NEAR(error, 0.0, 4.0 * sqrt(variance) / count + least);
    return worst / fabs(exact[0]);
}

// --- skies ---------------------------------------------------------------------------------------

/// Oracles 1 and 2: E = π L whatever the tilt t; under a hemisphere π (up (1 + cos t) + down (1 −
/// cos t)) / 2. A picture that is one colour is a constant sky.
TEST(skies_over_any_tilt)
{
    static const char *const names[] = {"constant", "hemisphere", "picture of one colour"};
    static const alp_sky_kind kinds[] = {ALP_SKY_CONSTANT, ALP_SKY_HEMISPHERE, ALP_SKY_IMAGE};
    vec3 axes[AXES];
    double exact[AXES];
    alpi_reference_value values[AXES];
    alp_image *picture = NULL;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){32, 16, 3, ALP_COMPONENT_FLOAT},
                                        &picture));
    for (int i = 0; i < 32 * 16 * 3; i++) {
        alp_image_floats(picture)[i] = i % 3 == 1 ? 0.7f : 0.1f;
    }
    make_axes(axes);
    for (int k = 0; k < 3; k++) {
        alp_lighting_options o = alp_lighting_options_default();
        o.sky.kind = kinds[k];
        o.sky.up[1] = 0.7f;
        o.sky.down[1] = 0.2f;
        o.sky.strength = 3.0f;
        o.sky.image = picture;
        test_lit lit = test_lit_open(far_ground(), &o);
        for (int i = 0; i < AXES; i++) {
            const double up = 3.0 * 0.7, down = k == 1 ? 3.0 * 0.2 : up, c = (double)axes[i].y;
            exact[i] = ALPI_PI * (up * (1.0 + c) + down * (1.0 - c)) / 2.0;
        }
        alpi_reference r = test_lit_reference(&lit, 4, 8192);
        gather(&r, axes, AXES, values);
        const double with = hold(values, exact, AXES, 0.0);
        r.next_event = false;
        gather(&r, axes, AXES, values);
        const double without = hold(values, exact, AXES, 0.0);
        printf("accuracy: %s sky, 7 tilts x 8 azimuths: largest error %.1e, met by chance %.1e\n",
               names[k], with, without);
        assert_true(with <= 2e-3);
        test_lit_close(&lit);
    }
    alp_image_destroy(picture);
}

// --- suns and lamps ------------------------------------------------------------------------------

static const double AZIMUTH = 0.7, ELEVATION = 0.9;

/// E⊥ = 1000 lux from (AZIMUTH, ELEVATION).
static alp_lighting_options sun_of(double size)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sun.azimuth = (float)AZIMUTH;
    o.sun.elevation = (float)ELEVATION;
    o.sun.illuminance = 1000.0f;
    o.sun.size = (float)size;
    return o;
}

/// Oracle 3's source: E = E⊥ cosθ⁺, where the disk is not cut by the receiver's own horizon.
/// Without size that is exact; so is a disk of any size in the mean, because the cosine is linear.
TEST(a_sun_gives_its_lux_times_the_cosine)
{
    static const double sizes[] = {0.0, 0.0093, 0.2};
    const double sun[3] = {cos(ELEVATION) * sin(AZIMUTH), sin(ELEVATION),
                           cos(ELEVATION) * cos(AZIMUTH)};
    for (int k = 0; k < 3; k++) {
        const alp_lighting_options o = sun_of(sizes[k]);
        test_lit lit = test_lit_open(far_ground(), &o);
        vec3 axes[AXES], used[AXES];
        double exact[AXES] = {1000.0};
        alpi_reference_value values[AXES];
        uint32_t count = 1, lit_count = 0;
        make_axes(axes);
        used[0] = (vec3){(float)sun[0], (float)sun[1], (float)sun[2]};
        for (int i = 0; i < AXES; i++) {
            const double cosine = sun[0] * (double)axes[i].x + sun[1] * (double)axes[i].y +
                                  sun[2] * (double)axes[i].z;
            if (count < AXES && fabs(cosine) > sin(0.5 * sizes[k])) {
                exact[count] = 1000.0 * fmax(cosine, 0.0);
                lit_count += cosine > 0.0;
                used[count++] = axes[i];
            }
        }
        assert_true(lit_count > 20 && count - lit_count > 20);
        alpi_reference r = test_lit_reference(&lit, 4, k < 2 ? 4096 : 16384);
        gather(&r, used, count, values);
        // The balance heuristic leaves as much of the light to rays that meet the disk by chance as
        // chance has of it, sin²: of a small one hardly one of 4096 does.
        const double with = hold(values, exact, count, pow(sin(0.5 * sizes[k]), 2.0));
        for (uint32_t i = 0; i < count; i++) { // behind is dark, and a point is exact
            assert_true(exact[i] > 0.0 || values[i].mean[1] == 0.0f);
            assert_true(sizes[k] > 0.0 || sqrt((double)values[i].variance[1]) < 1e-3);
        }
        double without = 0.0;
        if (sizes[k] > 0.1) { // of a smaller one too few rays meet the disk
            r.next_event = false;
            gather(&r, used, count, values);
            without = hold(values, exact, count, 0.0);
        }
        printf("accuracy: sun %.4f wide, %u normals: largest error %.1e of E, met by chance %.1e\n",
               sizes[k], count, with, without);
        assert_true(with <= 1e-3);
        test_lit_close(&lit);
    }
}

enum { LAMPS = 3 };

/// A point, a spot that looks down −x, and a directional light.
static void make_lamps(alpi_light lamps[LAMPS])
{
    lamps[0] = (alpi_light){.kind = ALP_LIGHT_POINT,
                            .color = {0.5f, 1.0f, 0.25f},
                            .intensity = 80.0f,
                            .position = {1.0f, 3.0f, -2.0f},
                            .range = INFINITY};
    lamps[1] = (alpi_light){.kind = ALP_LIGHT_SPOT,
                            .color = {0.5f, 1.0f, 0.25f},
                            .intensity = 200.0f,
                            .position = {4.0f, 0.0f, 0.0f},
                            .direction = {-1.0f, 0.0f, 0.0f},
                            .range = INFINITY,
                            .inner_cone = 0.2f,
                            .outer_cone = 0.5f};
    lamps[2] = (alpi_light){.kind = ALP_LIGHT_DIRECTIONAL,
                            .color = {0.5f, 1.0f, 0.25f},
                            .intensity = 7.0f,
                            .direction = {0.0f, -1.0f, 0.0f},
                            .range = INFINITY};
}

/// E of one lamp at a point, in doubles: I/r² cosθ⁺, of a spot × ramp² between its cones
/// (KHR_lights_punctual), E⊥ cosθ⁺ of a directional one.
static double lamp_irradiance(const alpi_light *l, vec3 point, vec3 normal)
{
    const double d[3] = {(double)l->position.x - (double)point.x,
                         (double)l->position.y - (double)point.y,
                         (double)l->position.z - (double)point.z};
    const double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double n[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
    const double a[3] = {(double)l->direction.x, (double)l->direction.y, (double)l->direction.z};
    double cosine = (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / r, ramp = 1.0;
    if (l->kind == ALP_LIGHT_DIRECTIONAL) {
        return (double)l->intensity * fmax(-(a[0] * n[0] + a[1] * n[1] + a[2] * n[2]), 0.0);
    }
    if (l->kind == ALP_LIGHT_SPOT) {
        const double inner = cos((double)l->inner_cone), outer = cos((double)l->outer_cone);
        const double axis = -(d[0] * a[0] + d[1] * a[1] + d[2] * a[2]) / r;
        ramp = fmin(fmax((axis - outer) / (inner - outer), 0.0), 1.0);
    }
    return (double)l->intensity / (r * r) * fmax(cosine, 0.0) * ramp * ramp;
}

/// Each lamp alone, and all together: nothing is left to chance where nothing is hidden, but with
/// several lamps one of them is drawn in proportion to what it gives, which is as exact.
TEST(lamps_and_spots)
{
    alpi_light lamps[LAMPS];
    vec3 axes[AXES];
    make_lamps(lamps);
    make_axes(axes);
    for (uint32_t k = 0; k <= LAMPS; k++) {
        const uint32_t first = k < LAMPS ? k : 0, count = k < LAMPS ? 1 : LAMPS;
        alp_scene *scene = far_ground();
        test_lit_set_lamps(scene, lamps + first, count);
        test_lit lit = test_lit_open(scene, NULL);
        alpi_reference r = test_lit_reference(&lit, 4, 16);
        uint32_t shone = 0;
        for (int i = 0; i < AXES; i++) {
            // out of the spot's axis, through the ramp and beyond the outer cone (.546 of 1 m)
            const vec3 at = {0.0f, 0.06f * (float)i, 0.1f};
            double exact = 0.0;
            for (uint32_t j = first; j < first + count; j++) {
                exact += lamp_irradiance(&lamps[j], at, axes[i]);
            }
            const alpi_reference_value v = test_lit_point(&r, at, axes[i]);
            // Floats: the cosine of a cone is right to 6e-8, which in a ramp of .1 is 1e-6 of the
            // spot's 12.5.
            const double rounding = 2e-6 * 12.5;
            ASSERT_NEAR(v.mean[1], exact, rounding);
            ASSERT_NEAR(v.mean[0], 0.5 * exact, rounding);
            ASSERT_NEAR(v.mean[2], 0.25 * exact, rounding);
            shone += exact > 0.0;
        }
        assert_true(shone >= 12 && shone <= 48);
        r.next_event = false; // no ray can meet them
        ASSERT_NEAR(test_lit_point(&r, (vec3){0, 0, 0}, (vec3){0.6f, 0.8f, 0.0f}).mean[1], 0.0,
                    0.0);
        test_lit_close(&lit);
    }
}

// --- pictures ------------------------------------------------------------------------------------

/// A camera that looks straight down on a unit square of places about (0, 2, 0).
static void look_down(const void *user, uint32_t count, const uint64_t *pixels, const float *u,
                      const float *v, const alpi_camera_rays *rays)
{
    (void)pixels;
    const float *x = user;
    for (uint32_t i = 0; i < count; i++) {
        rays->start[0][i] = *x + u[i] - 0.5f;
        rays->start[1][i] = 2.0f;
        rays->start[2][i] = v[i] - 0.5f;
        rays->direction[0][i] = rays->direction[2][i] = 0.0f;
        rays->direction[1][i] = -1.0f;
    }
}

static alp_scene *table(float albedo, float emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "table");
    alpi_builder_surface(&b, "top",
                         alpi_builder_material(&b, "top", (vec3){albedo, albedo, albedo},
                                               (vec3){emission, emission, emission}));
    alpi_builder_quad(&b, (const vec3[4]){{-8, 0, 8}, {8, 0, 8}, {8, 0, -8}, {-8, 0, -8}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// L = Le + ρ/π E at what is seen: under a sun E⊥ cosθ, under a sky π L, and Le of its own; past
/// the edge of the table there is the sky, which counts as met where it shines.
TEST(what_a_camera_sees)
{
    alp_lighting_options o = sun_of(0.6);
    o.sky.kind = ALP_SKY_HEMISPHERE;
    o.sky.up[1] = 40.0f;
    o.sky.down[1] = 9.0f;
    test_lit lit = test_lit_open(table(0.4f, 5.0f), &o);
    alpi_reference r = test_lit_reference(&lit, 6, 16384);
    const double E = 1000.0 * sin(ELEVATION) + ALPI_PI * 40.0, L = 5.0 + 0.4 / ALPI_PI * E;
    for (int k = 0; k < 2; k++) {
        r.next_event = k == 0;
        alpi_reference_value v;
        float covered, x = 0.0f;
        ASSERT_OK(context, alpi_reference_pixels(&r, look_down, &x, 3, 1, &v, &covered));
        ASSERT_NEAR(covered, 1.0, 0.0);
        ASSERT_NEAR(v.mean[1], L, STANDARD_ERRORS * sqrt((double)v.variance[1]));
        assert_true(sqrt((double)v.variance[1]) < (k == 0 ? 1e-3 : 4e-2) * L);
        x = 8.25f; // a quarter of the pixel lies on the table
        ASSERT_OK(context, alpi_reference_pixels(&r, look_down, &x, 4, 1, &v, &covered));
        ASSERT_NEAR(covered, 1.0, 0.0);
        ASSERT_NEAR(v.mean[1], 0.25 * L + 0.75 * 9.0,
                    STANDARD_ERRORS * sqrt((double)v.variance[1]));
    }
    test_lit_close(&lit);
    o.sky.kind = ALP_SKY_NONE;
    lit = test_lit_open(table(0.4f, 0.0f), &o);
    r = test_lit_reference(&lit, 6, 16384);
    alpi_reference_value v = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    float covered = 0.0f;
    ASSERT_OK(context, alpi_reference_pixels(&r, look_down, &(float){8.25f}, 4, 1, &v, &covered));
    ASSERT_NEAR(covered, 0.25, 1e-3); // 16 × 1024 stratified points against an edge
    ASSERT_NEAR(v.mean[1], 0.25 * 0.4 / ALPI_PI * 1000.0 * sin(ELEVATION),
                STANDARD_ERRORS * sqrt((double)v.variance[1]));
    test_lit_close(&lit);
}
