// SPDX-License-Identifier: MIT
// Numbers of up to 15 or so digits take one exact multiplication or division of doubles; others are
// given to strtod without their decimal point, which is where it would ask the locale.
// William D. Clinger: How to Read Floating Point Numbers Accurately. PLDI 1990.
#include "base/decimal.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEPT_DIGITS = 19,       // that a uint64_t always holds
    EXACT_POWER = 22,       // 10^22 is the last power of ten that is a double
    EXPONENT_LIMIT = 99999, // beyond, all is 0 or infinite, and sums of these do not overflow
    SLOW_DIGITS = 800       // more than decide between two doubles (767)
};

/// 0.DIGITS · 10^exponent
typedef struct decimal {
    bool negative;
    int kept;          // significant digits in the mantissa, the first KEPT_DIGITS at most
    bool cut;          // there are more
    uint64_t mantissa; // mantissa · 10^(exponent − kept) is the value, unless cut
    int64_t exponent;
    const char *digits, *end; // from the first significant digit to behind the last digit or point
} decimal;

static bool is_digit(const char *at, const char *end)
{
    return at < end && (unsigned)(*at - '0') < 10;
}

/// The digits and the point. @return behind them, NULL without a digit
static const char *scan_digits(const char *at, const char *end, decimal *d)
{
    bool any = false, fraction = false;
    d->digits = end;
    for (; at < end; at++) {
        unsigned digit = (unsigned)*at - '0';
        if (digit < 10) {
            any = true;
            if (digit == 0 && d->kept == 0) { // leading zeros only move the point
                d->exponent -= fraction;
                continue;
            }
            d->exponent += !fraction;
            d->digits = d->kept == 0 ? at : d->digits;
            d->cut = d->kept == KEPT_DIGITS;
            if (!d->cut) {
                d->kept++;
                d->mantissa = d->mantissa * 10 + digit;
            }
        } else if (*at == '.' && !fraction) {
            fraction = true;
        } else {
            break;
        }
    }
    d->end = at;
    return any ? at : NULL;
}

/// @return behind the number, NULL where there is none
static const char *scan(const char *at, const char *end, decimal *d)
{
    *d = (decimal){.negative = at < end && *at == '-'};
    at += at < end && (*at == '-' || *at == '+');
    at = scan_digits(at, end, d);
    if (at == NULL || at >= end || (*at != 'e' && *at != 'E')) {
        return at;
    }
    const char *power = at + 1;
    bool negative = power < end && *power == '-';
    power += power < end && (*power == '-' || *power == '+');
    if (!is_digit(power, end)) {
        return at; // the e is not ours
    }
    int64_t exponent = 0;
    for (; is_digit(power, end); power++) {
        exponent = exponent < EXPONENT_LIMIT ? exponent * 10 + (*power - '0') : exponent;
    }
    d->exponent += negative ? -exponent : exponent;
    return power;
}

/// mantissa · 10^exponent in one rounding; false where that takes more.
static bool convert_fast(const decimal *d, double *value)
{
    static const double powers[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (d->mantissa == 0) {
        *value = 0.0;
        return true;
    }
    const int64_t exponent = d->exponent - d->kept;
    if (d->cut || d->mantissa > (uint64_t)1 << DBL_MANT_DIG || exponent < -EXACT_POWER ||
        exponent > EXACT_POWER) {
        return false;
    }
    double mantissa = (double)d->mantissa;
    *value = exponent < 0 ? mantissa / powers[-exponent] : mantissa * powers[exponent];
    return true;
}

/// "DIGITSeEXPONENT" for strtod, which asks the locale for nothing in it.
static void print_plain(const decimal *d, char text[SLOW_DIGITS + 32])
{
    int used = 0;
    bool rest = false;
    for (const char *at = d->digits; at < d->end; at++) {
        if (*at != '.' && used < SLOW_DIGITS) {
            text[used++] = *at;
        } else {
            rest = rest || (*at != '.' && *at != '0');
        }
    }
    if (rest) { // more than half of the last digit or less, it only must not be nothing
        text[used++] = '1';
    }
    int64_t exponent = d->exponent - used;
    exponent = exponent > EXPONENT_LIMIT ? EXPONENT_LIMIT : exponent;
    exponent = exponent < -EXPONENT_LIMIT ? -EXPONENT_LIMIT : exponent;
    snprintf(text + used, 24, "e%lld", (long long)exponent);
}

const char *alpi_decimal_double(const char *text, const char *end, double *value)
{
    decimal d;
    const char *behind = scan(text, end, &d);
    if (behind == NULL) {
        return NULL;
    }
    if (!convert_fast(&d, value)) {
        char plain[SLOW_DIGITS + 32];
        print_plain(&d, plain);
        *value = strtod(plain, NULL);
    }
    *value = d.negative ? -*value : *value;
    return behind;
}

/// Whether a correctly rounded double lies on neither side of what decides between two floats: only
/// there, and where floats have fewer bits, is rounding it once more not rounding the number.
static bool is_undecided(double value)
{
    const uint64_t low = ((uint64_t)1 << (DBL_MANT_DIG - FLT_MANT_DIG)) - 1;
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & low) == (low + 1) / 2 || (value != 0.0 && value < (double)FLT_MIN) ||
           value > (double)FLT_MAX;
}

const char *alpi_decimal_float(const char *text, const char *end, float *value)
{
    decimal d;
    double nearest;
    const char *behind = scan(text, end, &d);
    if (behind == NULL) {
        return NULL;
    }
    if (convert_fast(&d, &nearest) && !is_undecided(nearest)) {
        *value = (float)nearest;
    } else {
        char plain[SLOW_DIGITS + 32];
        print_plain(&d, plain);
        *value = strtof(plain, NULL);
    }
    *value = d.negative ? -*value : *value;
    return behind;
}
