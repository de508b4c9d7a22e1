// SPDX-License-Identifier: MIT
// Decimal numbers as text, read to the nearest float or double, whatever the host's locale.
#ifndef ALPI_BASE_DECIMAL_H
#define ALPI_BASE_DECIMAL_H

#include <stddef.h>

/// Reads [+-]digits[.digits][(e|E)[+-]digits], with at least one digit before the exponent, to the
/// nearest value, ties to even; what is too large gives an infinity. No blanks, hexadecimal, nan or
/// inf.
/// @return behind the number; NULL where none begins at `text`
const char *alpi_decimal_double(const char *text, const char *end, double *value);
const char *alpi_decimal_float(const char *text, const char *end, float *value);

#endif
