// SPDX-License-Identifier: MIT
// The clear sky against the published formulas, evaluated here a second time for luminance, and
// against what every clear sky does.
#include "sky_checks.h"

#include "base/random.h"
#include "scene/sky/sky_clear.h"

#include <math.h>

static vec3 sun_at(double elevation_degrees, double phi)
{
    return sky_polar(ALPI_PI / 2.0 - elevation_degrees * ALPI_PI / 180.0, phi);
}

/// Perez' distribution with Preetham's coefficients for luminance (appendix A.2), turbidity T.
static double perez(double t, double theta, double gamma)
{
    double a = 0.1787 * t - 1.4630, b = -0.3554 * t + 0.4275, c = -0.0227 * t + 5.3251;
    double d = 0.1206 * t - 2.5771, e = -0.0670 * t + 0.3703;
    return (1.0 + a * exp(b / cos(theta))) *
           (1.0 + c * exp(d * gamma) + e * cos(gamma) * cos(gamma));
}

static double zenith_luminance(double t, double theta_sun)
{
    double chi = (4.0 / 9.0 - t / 120.0) * (ALPI_PI - 2.0 * theta_sun);
    return 1000.0 * ((4.0453 * t - 4.9710) * tan(chi) - 0.2155 * t + 2.4192);
}

TEST_WITH_CONTEXT(luminance_is_the_published_one, 1)
{
    const double turbidities[] = {2.0, 3.0, 6.0}, elevations[] = {20.0, 45.0, 80.0};
    for (int i = 0; i < 3; i++) {
        for (int s = 0; s < 3; s++) {
            alp_sky_options o = sky_options(ALP_SKY_CLEAR);
            o.turbidity = (float)turbidities[i];
            o.strength = 0.5f;
            double t = turbidities[i], theta_sun = ALPI_PI / 2.0 - elevations[s] * ALPI_PI / 180.0;
            alpi_sky *sky = sky_make(context, &o, sun_at(elevations[s], 0.8));
            // the zenith; 60° from it away from the sun; 30° from it and beside the sun
            const double thetas[] = {0.0, ALPI_PI / 3.0, ALPI_PI / 6.0};
            const double phis[] = {0.0, 0.8 + ALPI_PI, 0.8 + ALPI_PI / 2.0};
            for (int p = 0; p < 3; p++) {
                double gamma = acos(cos(thetas[p]) * cos(theta_sun) +
                                    sin(thetas[p]) * sin(theta_sun) * cos(phis[p] - 0.8));
                double expected = zenith_luminance(t, theta_sun) * perez(t, thetas[p], gamma) /
                                  perez(t, 0.0, theta_sun);
                vec3 radiance = alpi_sky_radiance(sky, sky_polar(thetas[p], phis[p]));
                // The matrix to Rec.709 and its weights of luminance have four digits.
                ASSERT_NEAR(2.0 * sky_luminance(radiance) / expected, 1.0, 1e-3);
            }
            alpi_sky_destroy(context, sky);
        }
    }
}

/// Chromaticity of the zenith at turbidity 2 and a sun at 45°: x = .2412, y = .2503 by hand from
/// the paper's matrices; a blue sky.
TEST_WITH_CONTEXT(the_zenith_is_blue, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    o.turbidity = 2.0f;
    alpi_sky *sky = sky_make(context, &o, sun_at(45.0, 0.0));
    vec3 c = alpi_sky_radiance(sky, (vec3){0.0f, 1.0f, 0.0f});
    double t = 2.0, s = ALPI_PI / 4.0;
    double x = t * t * (0.00166 * s * s * s - 0.00375 * s * s + 0.00209 * s) +
               t * (-0.02903 * s * s * s + 0.06377 * s * s - 0.03202 * s + 0.00394) +
               (0.11693 * s * s * s - 0.21196 * s * s + 0.06052 * s + 0.25886);
    double y = t * t * (0.00275 * s * s * s - 0.00610 * s * s + 0.00317 * s) +
               t * (-0.04214 * s * s * s + 0.08970 * s * s - 0.04153 * s + 0.00516) +
               (0.15346 * s * s * s - 0.26756 * s * s + 0.06670 * s + 0.26688);
    // Rec.709 to XYZ (IEC 61966-2-1), the inverse of what made the colour.
    double r = (double)c.x, g = (double)c.y, b = (double)c.z;
    double cie_x = 0.4124 * r + 0.3576 * g + 0.1805 * b;
    double cie_y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    double cie_z = 0.0193 * r + 0.1192 * g + 0.9505 * b;
    ASSERT_NEAR(cie_x / (cie_x + cie_y + cie_z), x, 5e-4);
    ASSERT_NEAR(cie_y / (cie_x + cie_y + cie_z), y, 5e-4);
    assert_true(c.z > 1.5f * c.x);
    alpi_sky_destroy(context, sky);
}

/// Over all turbidities, suns and directions: finite, and its luminance positive.
TEST(there_is_light_everywhere)
{
    for (double t = 1.7; t <= 10.0001; t += 0.5 * 0.83) {
        for (int e = 0; e <= 90; e += 5) {
            alpi_clear_sky sky;
            ASSERT_NEAR(alpi_clear_sky_init(&sky, sun_at(e, 1.0), fmin(t, 10.0)), 1.0, 0.0);
            for (int i = 0; i < 500; i++) {
                vec3 d = sky_polar(ALPI_PI / 2.0 * (i % 25) / 24.0, 0.31 * i);
                vec3 radiance;
                sky.radiances(&sky, &d, 1, &radiance);
                assert_true(vec3_is_finite(radiance));
                assert_true(fminf(fminf(radiance.x, radiance.y), radiance.z) >= 0.0f);
                double luminance = sky_luminance(radiance);
                if (!(luminance > 10.0 && luminance < 1e6)) {
                    fail_msg("turbidity %g, sun at %d°: %g cd/m²", t, e, luminance);
                }
            }
        }
    }
}

/// In doubles, from the coefficients that the sky has.
static void radiance_in_doubles(const alpi_clear_sky *sky, vec3 d, double rgb[3])
{
    const double dot = (double)vec3_dot(d, sky->sun); // a float's: beside the sun it tells
    const double cosine = fmax(fmin(dot, 1.0), -1.0), gamma = acos(cosine);
    double v[3];
    for (int k = 0; k < 3; k++) {
        const double *p = sky->perez[k];
        v[k] = sky->scale[k] * (1.0 + p[0] * exp(p[1] / fmax((double)d.y, 1e-6))) *
               (1.0 + p[2] * exp(p[3] * gamma) + p[4] * cosine * cosine);
    }
    const double X = v[1] / v[2] * v[0], Z = (1.0 - v[1] - v[2]) / v[2] * v[0];
    rgb[0] = fmax(3.2406 * X - 1.5372 * v[0] - 0.4986 * Z, 0.0);
    rgb[1] = fmax(-0.9689 * X + 1.8758 * v[0] + 0.0415 * Z, 0.0);
    rgb[2] = fmax(0.0557 * X - 0.2040 * v[0] + 1.0570 * Z, 0.0);
}

/// A direction not below the horizon, `number` of them: about the zenith, the horizon, the sun and
/// the point across from it by distances of all sizes, or anywhere; the first ones exactly there.
static vec3 pick_direction(vec3 sun, uint32_t number)
{
    const vec3 exact[4] = {{0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, sun, {-sun.x, sun.y, -sun.z}};
    const float u = alpi_unit_float(alpi_hash32(3 * number + 1));
    const float v = alpi_unit_float(alpi_hash32(3 * number + 2));
    const double phi = 2.0 * ALPI_PI * (double)v, size = pow(10.0, -6.0 * (double)u);
    const vec3 off = vec3_scale(sky_polar(ALPI_PI * (double)v, 10.0 * phi), (float)size);
    vec3 d = sky_polar(acos((double)u), phi);
    if (number < 4) {
        return exact[number];
    }
    switch (number % 8) {
    case 0:
    case 1:
        d = sky_polar(0.3 * (double)(u * u), phi);
        break;
    case 2:
        d = sky_polar(ALPI_PI / 2.0 - 0.2 * size, phi);
        break;
    case 3:
    case 4:
        d = vec3_normalize_or(vec3_add(exact[number % 8 - 1], off), sun);
        break;
    default:
        break;
    }
    d.y = fmaxf(d.y, 0.0f);
    return d;
}

/// Any number of directions at once, by any instructions, each as by itself, and as in doubles.
TEST_WITH_CONTEXT(many_directions_are_as_one_by_one, 1)
{
    enum { MANY = 2997 };
    static const double turbidities[] = {1.7, 1.72, 1.75, 1.8, 1.9, 2.0, 2.2, 2.5,
                                         3.0, 4.0,  5.0,  6.0, 7.0, 8.0, 9.0, 10.0};
    static vec3 directions[MANY], radiances[2][MANY];
    double worst = 0.0;
    for (int k = 0; k < 7 * 16; k++) {
        const double turbidity = turbidities[k / 7];
        const int elevation = 15 * (k % 7);
        alpi_clear_sky sky;
        double all = 0.0;
        (void)alpi_clear_sky_init(&sky, sun_at(elevation, 1.0), turbidity);
        for (uint32_t i = 0; i < MANY; i++) {
            directions[i] = pick_direction(sky.sun, i);
        }
        alpi_clear_sky_radiances_baseline(&sky, directions, MANY, radiances[0]);
        ALPI_COMPILED_FOR(context, alpi_clear_sky_radiances)(&sky, directions, MANY, radiances[1]);
        assert_memory_equal(radiances[1], radiances[0], sizeof radiances[0]);
        for (int i = 0; i < MANY; i++) {
            vec3 alone;
            double exact[3];
            alpi_clear_sky_radiances_one_by_one(&sky, &directions[i], 1, &alone);
            assert_memory_equal(&radiances[0][i], &alone, sizeof alone);
            sky.radiances(&sky, &directions[i], 1, &alone);
            assert_memory_equal(&radiances[0][i], &alone, sizeof alone);
            radiance_in_doubles(&sky, directions[i], exact);
            const double whole = exact[0] + exact[1] + exact[2];
            all = fmax(all, fabs((double)alone.x - exact[0]) / whole);
            all = fmax(all, fabs((double)alone.y - exact[1]) / whole);
            all = fmax(all, fabs((double)alone.z - exact[2]) / whole);
        }
        if (!(all < 1e-6)) { // what sky_clear.h promises
            fail_msg("turbidity %g, sun at %d°: %.2g of the radiance from doubles", turbidity,
                     elevation, all);
        }
        worst = fmax(worst, all);
    }
    print_message("largest difference from doubles: %.2g of the radiance\n", worst);
}

/// A sky asked in directions above and below the horizon at once.
TEST_WITH_CONTEXT(sky_and_ground_are_told_apart, 1)
{
    enum { MANY = 203 };
    vec3 directions[MANY], radiances[MANY];
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    alpi_sky *sky = sky_make(context, &o, sun_at(30.0, 2.5));
    int below = 0;
    for (int i = 0; i < MANY; i++) {
        directions[i] = sky_polar(0.013 * ((i * 89) % 240), 0.7 * i);
        below += directions[i].y < 0.0f;
    }
    assert_true(below > 60 && below < 140);
    alpi_sky_radiances(sky, directions, MANY, radiances);
    for (int i = 0; i < MANY; i++) {
        const vec3 alone = alpi_sky_radiance(sky, directions[i]);
        assert_memory_equal(&radiances[i], &alone, sizeof alone);
    }
    alpi_sky_destroy(context, sky);
}

TEST_WITH_CONTEXT(brightest_at_the_sun_and_symmetric_about_it, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    const double sun_phi = 2.0;
    vec3 sun = sun_at(40.0, sun_phi), brightest = {0};
    alpi_sky *sky = sky_make(context, &o, sun);
    double most = 0.0;
    for (int j = 0; j < 90; j++) {
        for (int i = 0; i < 180; i++) {
            double theta = (j + 0.5) * ALPI_PI / 180.0, phi = (i + 0.5) * ALPI_PI / 180.0;
            vec3 right = sky_polar(theta, sun_phi + phi), left = sky_polar(theta, sun_phi - phi);
            double a = sky_luminance(alpi_sky_radiance(sky, right));
            double b = sky_luminance(alpi_sky_radiance(sky, left));
            ASSERT_NEAR(a / b, 1.0, 1e-5); // rounding of the directions, some near the sun
            if (a > most) {
                most = a;
                brightest = right;
            }
        }
    }
    assert_true(vec3_dot(brightest, sun) > 0.999f); // within 2.6°
    double opposite = sky_luminance(alpi_sky_radiance(sky, sky_polar(0.9, sun_phi + ALPI_PI)));
    double horizon = sky_luminance(alpi_sky_radiance(sky, sky_polar(1.55, sun_phi + ALPI_PI)));
    double zenith = sky_luminance(alpi_sky_radiance(sky, (vec3){0.0f, 1.0f, 0.0f}));
    assert_true(most > 4.0 * zenith);
    // The darkest part is high and opposite to the sun; the horizon is a little brighter than both.
    assert_true(opposite < zenith && horizon > 1.1 * zenith && horizon < 2.0 * zenith);
    alpi_sky_destroy(context, sky);
}

/// The ground is the sky's own light on it times 0.2/π; what is drawn follows the table.
TEST_WITH_CONTEXT(ground_and_samples, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    const vec3 up = {0.0f, 1.0f, 0.0f};
    for (int e = 5; e <= 90; e += 17) {
        alpi_sky *sky = sky_make(context, &o, sun_at(e, 2.5));
        vec3 ground = alpi_sky_radiance(sky, sky_polar(2.0, 1.0)), mean = alpi_sky_mean(sky);
        double sum[3], drawn[3], error[3], above[3];
        sky_irradiance_sum(sky, up, 512, sum);
        // A coarser table of midpoints, the cusp at the sun and the horizon's brim in it.
        ASSERT_NEAR((double)ground.x * ALPI_PI / (0.2 * sum[0]), 1.0, 2e-3);
        ASSERT_NEAR((double)ground.z * ALPI_PI / (0.2 * sum[2]), 1.0, 2e-3);
        sky_irradiance_drawn(sky, (vec3){0.6f, 0.0f, 0.8f}, 40000, drawn, error);
        sky_irradiance_sum(sky, (vec3){0.6f, 0.0f, 0.8f}, 512, above);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(drawn[k], above[k], 4.0 * error[k] + 1e-4 * above[k]);
        }
        assert_true(mean.x > 0.0f && mean.y > 0.0f && mean.z > 0.0f);
        sky_check_density(sky, 512);
        alpi_sky_destroy(context, sky);
    }
}

TEST_WITH_CONTEXT(the_mean_is_the_integral, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    alpi_sky *sky = sky_make(context, &o, sun_at(30.0, -1.0));
    enum { ROWS = 1024 };
    double sum = 0.0, step = ALPI_PI / ROWS;
    for (int j = 0; j < ROWS; j++) {
        double area = step * (cos(j * step) - cos((j + 1) * step));
        for (int i = 0; i < 2 * ROWS; i++) {
            vec3 d = sky_polar((j + 0.5) * step, (i + 0.5) * step);
            sum += sky_luminance(alpi_sky_radiance(sky, d)) * area;
        }
    }
    double mean = sky_luminance(alpi_sky_mean(sky));
    ASSERT_NEAR(mean / (sum / (4.0 * ALPI_PI)), 1.0, 2e-3); // a table of 256 × 128
    alpi_sky_destroy(context, sky);
}

TEST_WITH_CONTEXT(twilight_fades, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_CLEAR);
    const vec3 d = {0.0f, 1.0f, 0.0f};
    test_log_clear();
    alpi_sky *sky = sky_make(context, &o, sun_at(0.0, 1.0));
    assert_false(test_log_has("sun-below-horizon"));
    double sunset = sky_luminance(alpi_sky_radiance(sky, d));
    alpi_sky_destroy(context, sky);
    sky = sky_make(context, &o, sun_at(-6.0, 1.0));
    assert_true(test_log_has("sun-below-horizon"));
    ASSERT_NEAR(sky_luminance(alpi_sky_radiance(sky, d)) / sunset, 0.01, 1e-5);
    alpi_sky_destroy(context, sky);
    const double night[] = {-18.01, -90.0};
    for (int i = 0; i < 2; i++) {
        ASSERT_OK(context, alpi_sky_create(context, &o, sun_at(night[i], 1.0), &sky));
        assert_null(sky);
    }
}
