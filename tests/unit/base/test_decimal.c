// SPDX-License-Identifier: MIT
// Decimal numbers against the C library's, bit for bit, whatever the locale.
#include "test_support.h"

#include "base/decimal.h"
#include "base/random.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void compare(const char *text)
{
    const char *end = text + strlen(text);
    double d = -1.0, wanted = strtod(text, NULL);
    float f = -1.0f, wanted_float = strtof(text, NULL);
    if (alpi_decimal_double(text, end, &d) != end || alpi_decimal_float(text, end, &f) != end) {
        fail_msg("\"%s\" is not read to its end", text);
    }
    if (d != wanted || signbit(d) != signbit(wanted) || f != wanted_float ||
        signbit(f) != signbit(wanted_float)) {
        fail_msg("\"%s\": %.17g and %.9g, not %.17g and %.9g", text, d, (double)f, wanted,
                 (double)wanted_float);
    }
}

static uint64_t draw(uint64_t *state)
{
    return *state = alpi_hash64(*state);
}

/// Digits, a point somewhere, an exponent at times.
TEST(random_texts)
{
    enum { ROUNDS = 200000 };
    uint64_t seed = 1;
    for (int round = 0; round < ROUNDS; round++) {
        char text[80];
        int used = 0, digits = 1 + (int)(draw(&seed) % (round % 10 == 0 ? 40 : 18));
        int point = (int)(draw(&seed) % 24);
        if (draw(&seed) % 3 == 0) {
            text[used++] = draw(&seed) % 2 == 0 ? '-' : '+';
        }
        for (int i = 0; i < digits; i++) {
            if (i == point) {
                text[used++] = '.';
            }
            text[used++] = (char)('0' + (draw(&seed) % 5 == 0 ? 0 : draw(&seed) % 10));
        }
        text[used] = '\0';
        if (draw(&seed) % 4 == 0) {
            snprintf(text + used, 16, "%c%+d", draw(&seed) % 2 ? 'e' : 'E',
                     (int)(draw(&seed) % 700) - 350);
        }
        compare(text);
    }
}

/// What printf makes of random bits comes back, with few digits and with many.
TEST(printed_numbers)
{
    uint64_t seed = 2;
    for (int round = 0; round < 100000; round++) {
        uint64_t bits = draw(&seed);
        uint32_t half = (uint32_t)draw(&seed);
        double d;
        float f;
        char text[64];
        memcpy(&d, &bits, sizeof d);
        memcpy(&f, &half, sizeof f);
        if (isfinite(d) && isfinite(f)) {
            snprintf(text, sizeof text, "%.*g", 1 + round % 20, d);
            compare(text);
            snprintf(text, sizeof text, "%.9g", (double)f);
            compare(text);
            snprintf(text, sizeof text, "%.6f", (double)f * 1e-30);
            compare(text);
        }
    }
}

/// Half way between two floats, exactly and with one digit more or less: where rounding twice goes
/// wrong.
TEST(half_way)
{
    uint64_t seed = 3;
    for (int round = 0; round < 20000; round++) {
        uint32_t bits = (uint32_t)(draw(&seed) % 0x7f000000u);
        float low, high;
        char text[256];
        memcpy(&low, &bits, sizeof low);
        bits++;
        memcpy(&high, &bits, sizeof high);
        int length = snprintf(text, sizeof text - 8, "%.150e", ((double)low + (double)high) / 2.0);
        compare(text);
        char *at = strchr(text, 'e');
        memmove(at + 1, at, (size_t)(text + length - at) + 1);
        *at = '1'; // a little more than half way
        compare(text);
        at[-1] = at[-1] == '0' ? '0' : (char)(at[-1] - 1);
        compare(text);
        // near 1, cut to so few digits that the fast way is taken and the double is half way
        bits = 0x3f000000u + (uint32_t)(draw(&seed) % 0x1000000u);
        memcpy(&low, &bits, sizeof low);
        bits++;
        memcpy(&high, &bits, sizeof high);
        for (int digits = 15; digits <= 16; digits++) {
            snprintf(text, sizeof text, "%.*g", digits, ((double)low + (double)high) / 2.0);
            compare(text);
        }
    }
}

TEST(edges)
{
    static const char *const texts[] = {"0",
                                        "-0",
                                        "+.5",
                                        "5.",
                                        "00001",
                                        "0.000000000000000000000000000000000000000000001",
                                        "1e30",
                                        "1e38",
                                        "3.4028235e38",
                                        "3.4028236e38",
                                        "3.40282357e38",
                                        "1e-45",
                                        "7e-46",
                                        "7.1e-46",
                                        "1e308",
                                        "1e309",
                                        "1e-400",
                                        "0e999999999999999999",
                                        "1e999999999999999999",
                                        "1e-999999999999999999",
                                        "9007199254740993",
                                        "16777217",
                                        "16777217.000000000000000000000000000001",
                                        "2.2250738585072011e-308",
                                        "123456789012345678901234567890"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        compare(texts[i]);
    }
    static const char *const none[] = {"", "-", ".", "e5", "nan", "inf", "-.e1", " 1", "x"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        double d;
        float f;
        assert_null(alpi_decimal_double(none[i], none[i] + strlen(none[i]), &d));
        assert_null(alpi_decimal_float(none[i], none[i] + strlen(none[i]), &f));
    }
    static const struct {
        const char *text;
        size_t size; // of the number
    } partly[] = {{"1e", 1}, {"1e+", 1}, {"1.2.3", 3}, {"0x10", 1}, {"1,5", 1}, {"3f", 1}};
    for (size_t i = 0; i < sizeof partly / sizeof *partly; i++) {
        double d;
        const char *text = partly[i].text;
        assert_ptr_equal(alpi_decimal_double(text, text + strlen(text), &d), text + partly[i].size);
    }
}

/// Nothing is read behind the end, and thousands of digits are a number like any other.
TEST(long_numbers)
{
    char text[4096];
    double d;
    memset(text, '1', sizeof text);
    assert_ptr_equal(alpi_decimal_double(text, text + 3, &d), text + 3);
    ASSERT_NEAR(d, 111.0, 0.0);
    text[1] = '.';
    text[sizeof text - 1] = '\0';
    compare(text);
    memset(text, '0', 2000);
    text[1] = '.';
    compare(text);
}

TEST(other_locales)
{
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "sv_SE.UTF-8", "C.UTF-8"};
    for (size_t i = 0; i < sizeof locales / sizeof *locales; i++) {
        if (setlocale(LC_ALL, locales[i]) == NULL) {
            continue; // not installed
        }
        static const char text[] = "0.12345678901234567890123456789";
        double d = 0.0;
        assert_ptr_equal(alpi_decimal_double(text, text + sizeof text - 1, &d),
                         text + sizeof text - 1);
        ASSERT_NEAR(d, 0.12345678901234567890123456789, 0.0);
    }
    setlocale(LC_ALL, "C");
}
