// SPDX-License-Identifier: MIT
// The sample sequence: stratified as a (0,2)-sequence must be, uniform and independent over keys.
#include "test_support.h"

#include "base/random.h"

TEST(hashes_give_published_values)
{
    // SplitMix64 from state 1234567; each call advances the state by the golden ratio.
    const uint64_t expected[] = {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                 4593380528125082431u};
    for (uint64_t i = 0; i < 4; i++) {
        assert_true(alpi_hash64(1234567u + i * 0x9e3779b97f4a7c15u) == expected[i]);
    }
    assert_int_equal(alpi_hash32(0), 0); // this mix has a fixed point, so keys are mixed before it
    assert_int_equal(alpi_reverse_bits(0x80000001u), 0x80000001u);
    assert_int_equal(alpi_reverse_bits(0x00000052u), 0x4a000000u);
}

/// Sobol's recurrence for x + 1: direction numbers v_{k+1} = v_k xor (v_k >> 1).
static uint32_t sobol_by_recurrence(uint32_t index)
{
    uint32_t point = 0, direction = 1u << 31;
    for (; index != 0; index >>= 1) {
        point ^= (index & 1u) ? direction : 0u;
        direction ^= direction >> 1;
    }
    return point;
}

TEST(the_second_dimension_is_sobols)
{
    for (uint32_t i = 0; i < 5000; i++) {
        uint32_t index = i < 1000 ? i : alpi_hash32(i);
        assert_int_equal(alpi_reverse_bits(alpi_sobol_1_reversed(index)),
                         sobol_by_recurrence(index));
    }
}

/// Whether 2^k points from `first` lie one in each of the 2^k boxes of 2^a columns, 2^(k-a) rows.
static bool one_in_each(uint32_t key, uint32_t first, unsigned k, unsigned a)
{
    static unsigned char seen[1 << 12];
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < 1u << k; i++) {
        vec2 p = alpi_sample_2d(key, first + i);
        uint32_t column = (uint32_t)(p.x * (float)(1u << a));
        uint32_t row = (uint32_t)(p.y * (float)(1u << (k - a)));
        if (seen[(row << a) | column]++) {
            return false;
        }
    }
    return true;
}

TEST(aligned_blocks_fill_every_elementary_interval)
{
    for (uint64_t receiver = 0; receiver < 6; receiver++) {
        uint32_t key = alpi_random_key(7, receiver, 0);
        for (unsigned k = 0; k <= 12; k++) {
            for (unsigned a = 0; a <= k; a++) {
                assert_true(one_in_each(key, 0, k, a));
                assert_true(one_in_each(key, 5u << k, k, a));
            }
        }
    }
    assert_false(one_in_each(1, 1, 8, 4)); // a block that is not aligned does not: the test can see
}

TEST(each_sample_is_uniform_over_keys)
{
    enum { KEYS = 1 << 14 };
    for (uint32_t sample = 0; sample < 5; sample++) {
        double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
        for (uint32_t i = 0; i < KEYS; i++) {
            vec2 p = alpi_sample_2d(alpi_random_key(1, i, 0), sample);
            x += (double)p.x / KEYS;
            y += (double)p.y / KEYS;
            xx += (double)p.x * (double)p.x / KEYS;
            yy += (double)p.y * (double)p.y / KEYS;
            xy += (double)p.x * (double)p.y / KEYS;
        }
        const double sigmas = 4.0 / sqrt(KEYS);
        ASSERT_NEAR(x, 1.0 / 2.0, sigmas * sqrt(1.0 / 12.0));
        ASSERT_NEAR(y, 1.0 / 2.0, sigmas * sqrt(1.0 / 12.0));
        ASSERT_NEAR(xx, 1.0 / 3.0, sigmas * sqrt(4.0 / 45.0));
        ASSERT_NEAR(yy, 1.0 / 3.0, sigmas * sqrt(4.0 / 45.0));
        ASSERT_NEAR(xy, 1.0 / 4.0, sigmas * sqrt(7.0 / 144.0));
    }
}

/// Correlation of coordinate x of sample 0 between keys a(i) and b(i).
static double correlation(uint64_t seed_step, uint64_t receiver_step, uint32_t stream_step)
{
    enum { PAIRS = 1 << 14 };
    double sum = 0.0;
    for (uint64_t i = 0; i < PAIRS; i++) {
        vec2 a = alpi_sample_2d(alpi_random_key(3, i, 0), 0);
        vec2 b = alpi_sample_2d(alpi_random_key(3 + seed_step, i + receiver_step, stream_step), 0);
        sum += ((double)a.x - 0.5) * ((double)b.x - 0.5);
    }
    return sum / PAIRS * 12.0;
}

TEST(neighbouring_keys_are_independent)
{
    ASSERT_NEAR(correlation(0, 0, 0), 1.0, 0.05); // the same key: the measure works
    const double four_sigmas = 4.0 / 128.0;
    ASSERT_NEAR(correlation(1, 0, 0), 0.0, four_sigmas);
    ASSERT_NEAR(correlation(0, 1, 0), 0.0, four_sigmas);
    ASSERT_NEAR(correlation(0, 0, 1), 0.0, four_sigmas);
    ASSERT_NEAR(correlation(0, 1u << 31, 0), 0.0, four_sigmas);
    ASSERT_NEAR(correlation((uint64_t)1 << 40, 0, 0), 0.0, four_sigmas);
}

TEST(the_sequence_beats_random_points)
{
    // Mean of x·y over 256 points: Owen's scramble errs by about n^-1.5, random points by n^-0.5.
    enum { KEYS = 256, POINTS = 256 };
    double squares = 0.0, bias = 0.0;
    for (uint32_t i = 0; i < KEYS; i++) {
        uint32_t key = alpi_random_key(2, i, 0);
        double mean = 0.0;
        for (uint32_t s = 0; s < POINTS; s++) {
            vec2 p = alpi_sample_2d(key, s);
            mean += (double)p.x * (double)p.y / POINTS;
        }
        squares += (mean - 0.25) * (mean - 0.25) / KEYS;
        bias += (mean - 0.25) / KEYS;
    }
    double random_error = sqrt(7.0 / 144.0 / POINTS), error = sqrt(squares);
    assert_true(error < random_error / 20.0);
    ASSERT_NEAR(bias, 0.0, 4.0 * error / sqrt(KEYS) + 0x1p-25);
}

TEST(the_bits_stay_what_they_are)
{
    // A change here changes every bake: it must be meant, and said in the change log.
    const uint32_t keys[] = {0x559b725au, 0x6cfd08fbu};
    const uint32_t bits[][2] = {{0x758a7fu, 0x6095f8u}, {0xda7401u, 0xcdc290u},
                                {0x2675fdu, 0xa20987u}, {0x352796u, 0x6befc4u},
                                {0xc30eb2u, 0xb9e5b9u}, {0x5a9197u, 0xf561e9u}};
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t key = alpi_random_key(i, 12345, i);
        assert_int_equal(key, keys[i]);
        for (uint32_t s = 0; s < 3; s++) {
            vec2 p = alpi_sample_2d(key, s);
            assert_int_equal((uint32_t)(p.x * 0x1p24f), bits[3 * i + s][0]);
            assert_int_equal((uint32_t)(p.y * 0x1p24f), bits[3 * i + s][1]);
        }
    }
}
