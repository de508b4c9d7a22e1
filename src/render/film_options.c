// SPDX-License-Identifier: MIT
// How pictures of each method are best shown.
#include <alpenglow/render.h>

alp_film_options alp_render_film_options(alp_render_method method)
{
    alp_film_options options = alp_film_options_default();
    if (method != ALP_RENDER_AO && method != ALP_RENDER_ALBEDO) {
        options.auto_exposure = true;
        options.tone = ALP_TONE_FILM;
        options.dither = ALP_DITHER_HASHED; // smooth light in dark rooms shows every step of a byte
    }
    return options;
}
