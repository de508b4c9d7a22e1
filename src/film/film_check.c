// SPDX-License-Identifier: MIT
// Options of the film: defaults, and the refusal of values that are out of range.
#include "base/image.h"
#include "film/meter.h"

alp_film_options alp_film_options_default(void)
{
    return (alp_film_options){.struct_size = sizeof(alp_film_options),
                              .key = 0.18f,
                              .meter_low = 0.05f,
                              .meter_high = 0.95f,
                              .tone = ALP_TONE_NONE,
                              .kelvin = 6504.0f};
}

static bool within(double value, double low, double high) // NaN is not
{
    return value >= low && value <= high;
}

static const char *find_fault(const alp_film_options *o)
{
    if (o->struct_size != sizeof *o) {
        return "options are not from _default()";
    }
    if (!within(o->exposure, -ALPI_EXPOSURE_LIMIT, ALPI_EXPOSURE_LIMIT)) {
        return "exposure must be -64 to 64";
    }
    if (!(o->key > 0.0f && o->key <= 1.0f)) {
        return "key must be above 0, and 1 at most";
    }
    if (!(o->meter_low >= 0.0f && o->meter_low < o->meter_high && o->meter_high <= 1.0f)) {
        return "meter_low and meter_high must be 0 to 1, low below high";
    }
    if (o->tone < ALP_TONE_FILM || o->tone > ALP_TONE_NONE) {
        return "unknown tone curve";
    }
    // below, the filmic curve's white would be rounding
    if (o->white_point != 0.0f && !(o->white_point >= 1e-6f)) {
        return "white_point must be 0 (the curve's own) or 1e-6 and more";
    }
    if (o->white_balance < ALP_WHITE_BALANCE_OFF || o->white_balance > ALP_WHITE_BALANCE_AUTO) {
        return "unknown white balance";
    }
    if (!within((double)o->kelvin, 1000.0, 25000.0)) {
        return "kelvin must be 1000 to 25000";
    }
    return o->dither < ALP_DITHER_NONE || o->dither > ALP_DITHER_HASHED ? "unknown dithering"
                                                                        : NULL;
}

alp_result alpi_film_check(const alp_image *linear, const alp_film_options *options)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (linear == NULL) {
        return code;
    }
    if (linear->info.component != ALP_COMPONENT_FLOAT) {
        return alpi_fail(linear->context, code, "film: a linear float image is needed, not 8 bits");
    }
    const char *fault = options != NULL ? find_fault(options) : NULL;
    return fault != NULL ? alpi_fail(linear->context, code, "film: %s", fault) : ALP_OK;
}
