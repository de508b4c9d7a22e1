// SPDX-License-Identifier: MIT
// Adaptation over time: exposure follows the light of a sequence, exponentially.
#include "base/context.h"
#include "base/image.h"
#include "film/meter.h"

#include <math.h>

alp_film_adaptation alp_film_adaptation_default(void)
{
    return (alp_film_adaptation){
        .struct_size = sizeof(alp_film_adaptation), .brighter_seconds = 0.4, .darker_seconds = 1.2};
}

static const char *find_fault(const alp_film_adaptation *state, double seconds)
{
    if (state == NULL || state->struct_size != sizeof *state) {
        return "the adaptation is NULL or not from _default()";
    }
    if (!(state->brighter_seconds >= 0.0 && state->darker_seconds >= 0.0)) {
        return "the time constants of an adaptation must be 0 or more";
    }
    if (state->adapted && !isfinite(state->log2_luminance)) {
        return "the adapted luminance is not finite";
    }
    return seconds >= 0.0 ? NULL : "the time between pictures must be 0 seconds or more";
}

static void approach(alp_film_adaptation *state, double target, double seconds)
{
    const double gap = state->log2_luminance - target;
    const double constant = gap < 0.0 ? state->brighter_seconds : state->darker_seconds;
    // 0/0 is no time for an adaptation that takes none: it stays; ∞/∞ arrives.
    const double left = seconds == 0.0 ? 1.0 : isinf(seconds) ? 0.0 : exp(-seconds / constant);
    state->log2_luminance = state->adapted ? target + gap * left : target;
    state->adapted = true;
}

alp_result alp_film_adapt(alp_film_adaptation *state, const alp_image *linear,
                          const alp_film_options *options, double seconds, double *exposure)
{
    ALP_TRY(alpi_film_check(linear, options));
    const char *fault = find_fault(state, seconds);
    if (fault != NULL) {
        return alpi_fail(linear->context, ALP_ERROR_INVALID_ARGUMENT, "film: %s", fault);
    }
    const alp_film_options o = options != NULL ? *options : alp_film_options_default();
    double target = 0.0;
    uint64_t pixels = 0;
    ALP_TRY(alp_film_meter(linear, &o, &target, &pixels));
    if (pixels > 0) {
        approach(state, target, seconds);
    }
    if (exposure != NULL) {
        *exposure = state->adapted ? alpi_film_exposure(&o, state->log2_luminance) : 0.0;
    }
    return ALP_OK;
}
