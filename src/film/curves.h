// SPDX-License-Identifier: MIT
#ifndef ALPI_FILM_CURVES_H
#define ALPI_FILM_CURVES_H

#include <alpenglow/film.h>

/// The white point that a curve has when none is given.
double alpi_film_default_white(alp_tone tone);

/// Exposed light → display value, not yet cut off at 1: 0 at 0, monotone. Negative light and NaN
/// give 0. `white` is the L that becomes 1 (REINHARD, FILMIC), > 0, may be infinite.
double alpi_film_curve(alp_tone tone, double white, double light);

#endif
