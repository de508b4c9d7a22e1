// SPDX-License-Identifier: MIT
#ifndef ALPI_FILM_METER_H
#define ALPI_FILM_METER_H

#include "film/white_balance.h"

#include <alpenglow/film.h>

/// Exposures lie in [−64, 64] EV.
#define ALPI_EXPOSURE_LIMIT 64.0

/// What a picture's light is like, over the pixels that alp_film_meter counts.
typedef struct alpi_meter {
    uint64_t pixels;       // that count; 0: nothing else has a meaning
    double log2_luminance; // mean
    double colour[3];      // mean, linear Rec. 709
} alpi_meter;

/// Meters a float image. `balance` is applied first, NULL = none. Sums run in the order of pixels.
alp_result alpi_meter_image(const alp_image *linear, const alp_film_options *options,
                            const alpi_matrix3 *balance, alpi_meter *meter);

/// The white balance that options ask for; *balanced tells whether there is one to apply.
alp_result alpi_film_balance(const alp_image *linear, const alp_film_options *options,
                             alpi_matrix3 *balance, bool *balanced);

/// Refuses what cannot be developed or metered, with a message. Both may be NULL.
alp_result alpi_film_check(const alp_image *linear, const alp_film_options *options);

/// The exposure value that makes this luminance L = key.
double alpi_film_exposure(const alp_film_options *options, double log2_luminance);

#endif
