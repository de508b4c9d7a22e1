// SPDX-License-Identifier: MIT
// Develops the light of a picture: exposure, tone curve and encoding, with the numbers of the film
// module.
#ifndef VIEWER_PASS_FILM_H
#define VIEWER_PASS_FILM_H

#include "passes/screen_pass.h"

#include <alpenglow/film.h>

typedef struct pass_film {
    screen_pass screen;
} pass_film;

/// @return EXIT_DONE, or EXIT_FAILED after a message; pass_film_destroy in both cases
int pass_film_create(pass_film *pass);
void pass_film_destroy(pass_film *pass);
/// @param film    its tone and its dither, which is NONE or HASHED
/// @param numbers of alp_film_resolve
void pass_film_draw(const pass_film *pass, const alp_film_options *film,
                    const alp_film_numbers *numbers, const gl_targets *targets);

#endif
