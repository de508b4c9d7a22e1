// SPDX-License-Identifier: MIT
// Tone curves against their closed forms.
#include "test_support.h"

#include "film/curves.h"

#include <math.h>

/// Of doubles, with room for a dozen operations.
static const double ROUNDING = 1e-14;

static const alp_tone tones[] = {ALP_TONE_FILM, ALP_TONE_REINHARD, ALP_TONE_FILMIC, ALP_TONE_NONE};

TEST(black_stays_black)
{
    for (int i = 0; i < 4; i++) {
        assert_true(alpi_film_curve(tones[i], 4.0, 0.0) == 0.0);
        assert_true(alpi_film_curve(tones[i], 4.0, -3.0) == 0.0);
        assert_true(alpi_film_curve(tones[i], 4.0, (double)NAN) == 0.0);
    }
}

TEST(more_light_is_never_darker)
{
    const double whites[] = {1e-6, 0.5, 4.0, 5.6, 1e6, (double)INFINITY};
    for (int i = 0; i < 4; i++) {
        for (int w = 0; w < 6; w++) {
            double before = 0.0;
            for (double stop = -40.0; stop <= 130.0; stop += 0.125) {
                double value = alpi_film_curve(tones[i], whites[w], exp2(stop));
                assert_true(isfinite(value));
                assert_true(value >= before * (1.0 - ROUNDING));
                assert_true(stop > 0.0 || value > before); // strictly, where there is room
                before = value;
            }
            double end = alpi_film_curve(tones[i], whites[w], (double)INFINITY);
            assert_true(isfinite(end) && end >= before * (1.0 - ROUNDING));
        }
    }
}

TEST(film_is_exponential)
{
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILM, 0.0, 1.0), 1.0 - exp(-1.0), ROUNDING);
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILM, 0.0, log(2.0)), 0.5, ROUNDING);
    // two exposures one after the other leave what both leave: 1 − f(a + b) = (1 − f(a))(1 − f(b))
    double a = alpi_film_curve(ALP_TONE_FILM, 0.0, 0.3);
    double b = alpi_film_curve(ALP_TONE_FILM, 0.0, 1.9);
    ASSERT_NEAR(1.0 - alpi_film_curve(ALP_TONE_FILM, 0.0, 2.2), (1.0 - a) * (1.0 - b), ROUNDING);
    // dark as it is: 1 − e^−L = L − L²/2 + …
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILM, 0.0, 1e-6) / 1e-6, 1.0 - 0.5e-6, 1e-12);
}

TEST(reinhard_reaches_white)
{
    for (double white = 0.25; white < 100.0; white *= 2.0) {
        ASSERT_NEAR(alpi_film_curve(ALP_TONE_REINHARD, white, white), 1.0, ROUNDING);
    }
    // without a white point: L / (1 + L)
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_REINHARD, (double)INFINITY, 3.0), 0.75, ROUNDING);
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_REINHARD, 2.0, 1.0), 0.625, ROUNDING); // (1 + ¼)/2
    assert_true(alpi_film_default_white(ALP_TONE_REINHARD) == 4.0);
}

/// Hable's curve as it was published.
static double published(double x)
{
    const double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

TEST(filmic_is_as_published)
{
    double white = alpi_film_default_white(ALP_TONE_FILMIC);
    ASSERT_NEAR(white, 5.6, ROUNDING);
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILMIC, white, white), 1.0, ROUNDING);
    for (double light = 0.01; light < 50.0; light *= 1.3) {
        double expected = published(2.0 * light) / published(11.2);
        ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILMIC, white, light), expected, ROUNDING);
    }
    // by hand: 0.36·(.042·.36 + .005) / (.3·(.36·(.15·.36 + .5) + .06)) / .725131 at middle grey
    ASSERT_NEAR(alpi_film_curve(ALP_TONE_FILMIC, white, 0.18), 0.12834, 1e-5); // digits given
}

TEST(none_is_none)
{
    assert_true(alpi_film_curve(ALP_TONE_NONE, 4.0, 0.7) == 0.7);
    assert_true(alpi_film_curve(ALP_TONE_NONE, 4.0, 70.0) == 70.0);
}
