// SPDX-License-Identifier: MIT
// Radiance pictures (.hdr, RGBE): flat, old and new run lengths, all eight orientations.
// Greg Ward: Real Pixels. Graphics Gems II, 1991; layout after the Radiance file formats manual.
#include "formats/images/images.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// Lines of other widths cannot be stored with new run lengths.
enum { NEW_RUNS_LEAST = 8, NEW_RUNS_MOST = 32767 };
/// A byte of exponent e and a mantissa m stand for m · 2^(e − 136).
enum { EXPONENT_BIAS = 128, MANTISSA_BITS = 8 };

// --- reading: header -----------------------------------------------------------------------------

typedef struct hdr_reader {
    alp_context *context;
    const char *name;
    const uint8_t *bytes;
    size_t size, place;
    double correction[3]; // by what the values were multiplied before they were stored
    bool x_major;         // lines of the file are columns of the picture
    bool flip_x, flip_y;  // against left to right, top to bottom
    uint32_t width, height, line, line_count;
    alp_image *image;
    uint8_t *quads; // one line of the file, [length][4]
    double powers[256];
} hdr_reader;

static alp_result fail_hdr(const hdr_reader *r, const char *fault)
{
    return alpi_fail(r->context, ALP_ERROR_INVALID_DATA, "%s: Radiance picture: %s", r->name,
                     fault);
}

static alp_result fail_line(const hdr_reader *r, const char *fault)
{
    return alpi_fail(r->context, ALP_ERROR_INVALID_DATA, "%s: Radiance picture: line %u of %u: %s",
                     r->name, r->line + 1, r->line_count, fault);
}

/// Takes the next header line, without its end, cut to the room there is. False at the file's end.
static bool read_text(hdr_reader *r, char text[128])
{
    const uint8_t *start = r->bytes + r->place;
    const uint8_t *end = r->place < r->size ? memchr(start, '\n', r->size - r->place) : NULL;
    if (end == NULL) {
        return false;
    }
    r->place += (size_t)(end - start) + 1;
    size_t length = (size_t)(end - start);
    length -= length > 0 && start[length - 1] == '\r';
    length = length < 127 ? length : 127;
    memcpy(text, start, length);
    text[length] = '\0';
    return true;
}

static const char *skip_blanks(const char *text)
{
    while (*text == ' ' || *text == '\t') {
        text++;
    }
    return text;
}

/// A decimal number after blanks; strtod would ask the host's locale what a decimal point is.
/// @return behind the number, NULL where there is none
static const char *read_decimal(const char *text, double *value)
{
    double number = 0.0, sign = 1.0;
    int exponent = 0, digits = 0, power = 0, power_sign = 1;
    text = skip_blanks(text);
    if (*text == '-' || *text == '+') {
        sign = *text++ == '-' ? -1.0 : 1.0;
    }
    for (bool fraction = false; (*text >= '0' && *text <= '9') || (*text == '.' && !fraction);
         text++) {
        if (*text == '.') {
            fraction = true;
        } else {
            number = number * 10.0 + (*text - '0');
            exponent -= fraction;
            digits++;
        }
    }
    if (digits > 0 && (*text == 'e' || *text == 'E')) {
        text++;
        if (*text == '-' || *text == '+') {
            power_sign = *text++ == '-' ? -1 : 1;
        }
        for (; *text >= '0' && *text <= '9'; text++) {
            power = power < 1000 ? power * 10 + (*text - '0') : power;
        }
    }
    *value = sign * number * pow(10.0, exponent + power_sign * power);
    return digits > 0 ? text : NULL;
}

/// One factor for all channels, or one for each; those of several lines multiply.
static alp_result read_correction(hdr_reader *r, const char *text, int count, const char *fault)
{
    double factors[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < count; k++) {
        text = read_decimal(text, &factors[k]);
        if (text == NULL || !(factors[k] > 0.0) || !isfinite(factors[k])) {
            return fail_hdr(r, fault);
        }
    }
    for (int k = 0; k < 3; k++) {
        r->correction[k] *= factors[k < count ? k : 0];
    }
    return ALP_OK;
}

/// What comes after "NAME=" where the line has it, else NULL.
static const char *value_of(const char *line, const char *name)
{
    size_t length = strlen(name);
    return strncmp(line, name, length) == 0 ? line + length : NULL;
}

static alp_result read_variable(hdr_reader *r, const char *line)
{
    const char *value = NULL;
    if ((value = value_of(line, "FORMAT=")) != NULL) {
        value = skip_blanks(value);
        if (strncmp(value, "32-bit_rle_rgbe", 15) != 0) {
            return alpi_fail(r->context, ALP_ERROR_UNSUPPORTED,
                             "%s: Radiance picture: its format is \"%s\"; convert it to "
                             "32-bit_rle_rgbe",
                             r->name, value);
        }
    } else if ((value = value_of(line, "EXPOSURE=")) != NULL) {
        return read_correction(r, value, 1, "its EXPOSURE is no positive number");
    } else if ((value = value_of(line, "COLORCORR=")) != NULL) {
        return read_correction(r, value, 3, "its COLORCORR is not three positive numbers");
    }
    return ALP_OK; // others describe, but do not change the numbers
}

/// "-Y 256": the axis, whether it runs downwards in its coordinate, and the number of pixels.
static const char *read_axis(const char *text, char *axis, bool *negative, uint64_t *count)
{
    text = skip_blanks(text);
    if ((text[0] != '-' && text[0] != '+') || (text[1] != 'X' && text[1] != 'Y')) {
        return NULL;
    }
    *negative = text[0] == '-';
    *axis = text[1];
    text = skip_blanks(text + 2);
    const char *digits = text;
    for (*count = 0; *text >= '0' && *text <= '9'; text++) {
        *count = *count < UINT32_MAX ? *count * 10 + (uint64_t)(*text - '0') : *count;
    }
    return text > digits ? text : NULL;
}

/// The last line of the header, as "-Y 256 +X 512": lines from the top, each from the left.
static alp_result read_size(hdr_reader *r)
{
    char text[128], axes[2] = "";
    bool negative[2] = {false, false};
    uint64_t counts[2] = {0, 0};
    const char *rest = read_text(r, text) ? text : NULL;
    for (int i = 0; i < 2 && rest != NULL; i++) {
        rest = read_axis(rest, &axes[i], &negative[i], &counts[i]);
    }
    if (rest == NULL || axes[0] == axes[1] || counts[0] == 0 || counts[1] == 0) {
        return fail_hdr(r, "its header does not end in a size such as \"-Y 256 +X 512\"");
    }
    if (counts[0] > ALPI_IMAGE_SIDE_LIMIT || counts[1] > ALPI_IMAGE_SIDE_LIMIT ||
        counts[0] * counts[1] > ALPI_IMAGE_PIXEL_LIMIT) {
        return alpi_fail(r->context, ALP_ERROR_LIMIT,
                         "%s: %s pixels; the limits are 2^28, and %d in a row", r->name, text,
                         ALPI_IMAGE_SIDE_LIMIT);
    }
    r->x_major = axes[0] == 'X';
    r->flip_x = negative[r->x_major ? 0 : 1];
    r->flip_y = !negative[r->x_major ? 1 : 0];
    r->width = (uint32_t)counts[r->x_major ? 0 : 1];
    r->height = (uint32_t)counts[r->x_major ? 1 : 0];
    r->line_count = (uint32_t)counts[0];
    return ALP_OK;
}

static alp_result read_header(hdr_reader *r)
{
    char text[128];
    r->correction[0] = r->correction[1] = r->correction[2] = 1.0;
    if (!read_text(r, text) || strncmp(text, "#?", 2) != 0) {
        return fail_hdr(r, "it does not begin with a line \"#?RADIANCE\"");
    }
    while (read_text(r, text)) {
        if (text[0] == '\0') {
            return read_size(r);
        }
        ALP_TRY(read_variable(r, text));
    }
    return fail_hdr(r, "it ends within its header");
}

// --- reading: lines ------------------------------------------------------------------------------

static const char CUT_OFF[] = "the file ends within it";

/// Four channels after each other, each in runs: a count above 128 repeats one byte, one up to 128
/// is followed by as many.
static alp_result read_new_runs(hdr_reader *r, uint32_t length)
{
    for (uint32_t k = 0; k < 4; k++) {
        for (uint32_t x = 0; x < length;) {
            if (r->size - r->place < 2) {
                return fail_line(r, CUT_OFF);
            }
            uint32_t count = r->bytes[r->place++];
            bool repeats = count > 128;
            count -= repeats ? 128 : 0;
            if (count == 0 || count > length - x) {
                return fail_line(r, count == 0 ? "it has a run of no length"
                                               : "a run is longer than the line");
            }
            if (r->size - r->place < (repeats ? 1 : count)) {
                return fail_line(r, CUT_OFF);
            }
            for (uint32_t i = 0; i < count; i++, x++) {
                r->quads[4 * (size_t)x + k] = r->bytes[r->place + (repeats ? 0 : i)];
            }
            r->place += repeats ? 1 : count;
        }
    }
    return ALP_OK;
}

/// Pixel after pixel; one of (1, 1, 1, n) repeats the last one n times, and another such directly
/// after it n · 256 times.
static alp_result read_old_runs(hdr_reader *r, uint32_t length)
{
    uint32_t shift = 0;
    for (uint32_t x = 0; x < length;) {
        if (r->size - r->place < 4) {
            return fail_line(r, CUT_OFF);
        }
        const uint8_t *quad = r->bytes + r->place;
        r->place += 4;
        if (quad[0] != 1 || quad[1] != 1 || quad[2] != 1) {
            memcpy(r->quads + 4 * (size_t)x++, quad, 4);
            shift = 0;
            continue;
        }
        uint64_t count = shift < 24 ? (uint64_t)quad[3] << shift : UINT64_MAX;
        if (x == 0) {
            return fail_line(r, "it begins with a repetition");
        }
        if (count > length - x) {
            return fail_line(r, "a run is longer than the line");
        }
        for (; count > 0; count--, x++) {
            memcpy(r->quads + 4 * (size_t)x, r->quads + 4 * (size_t)(x - 1), 4);
        }
        shift += 8;
    }
    return ALP_OK;
}

static alp_result read_line(hdr_reader *r, uint32_t length)
{
    const uint8_t *start = r->bytes + r->place;
    bool new_runs = length >= NEW_RUNS_LEAST && length <= NEW_RUNS_MOST &&
                    r->size - r->place >= 4 && start[0] == 2 && start[1] == 2 && start[2] < 128;
    if (!new_runs) {
        return read_old_runs(r, length);
    }
    if (((uint32_t)start[2] << 8 | start[3]) != length) {
        return fail_line(r, "its length is not the picture's");
    }
    r->place += 4;
    return read_new_runs(r, length);
}

static void put_pixel(const hdr_reader *r, uint32_t i, const uint8_t quad[4])
{
    uint32_t x = r->x_major ? r->line : i, y = r->x_major ? i : r->line;
    x = r->flip_x ? r->width - 1 - x : x;
    y = r->flip_y ? r->height - 1 - y : y;
    float *pixel = (float *)r->image->pixels + ((size_t)y * r->width + x) * 3;
    for (int k = 0; k < 3; k++) {
        double value = quad[k] * r->powers[quad[3]] / r->correction[k];
        pixel[k] = value < (double)FLT_MAX ? (float)value : FLT_MAX;
    }
}

static alp_result read_picture(hdr_reader *r)
{
    ALP_TRY(read_header(r));
    uint32_t length = r->x_major ? r->height : r->width;
    // One stored pixel a line, or one and a repetition, is the least there can be.
    if ((r->size - r->place) / (length > 1 ? 8 : 4) < r->line_count) {
        return alpi_fail(r->context, ALP_ERROR_INVALID_DATA,
                         "%s: %zu bytes cannot hold %u x %u pixels: it was cut off", r->name,
                         r->size, r->width, r->height);
    }
    for (int e = 1; e < 256; e++) { // 0 is black, whatever the mantissas
        r->powers[e] = ldexp(1.0, e - EXPONENT_BIAS - MANTISSA_BITS);
    }
    alp_image_info info = {r->width, r->height, 3, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(r->context, info, &r->image));
    ALPI_TRY_NEW(r->context, r->quads, (size_t)length * 4);
    for (r->line = 0; r->line < r->line_count; r->line++) {
        ALP_TRY(read_line(r, length));
        for (uint32_t i = 0; i < length; i++) {
            put_pixel(r, i, r->quads + 4 * (size_t)i);
        }
    }
    return ALP_OK;
}

alp_result alpi_hdr_decode(alp_context *context, const char *name, const uint8_t *bytes,
                           size_t size, alp_image **image)
{
    *image = NULL;
    hdr_reader reader = {.context = context, .name = name, .bytes = bytes, .size = size};
    alp_result result = read_picture(&reader);
    alpi_release(context, reader.quads);
    if (result == ALP_OK) {
        *image = reader.image;
    } else {
        alp_image_destroy(reader.image);
    }
    return result;
}

// --- writing -------------------------------------------------------------------------------------

typedef struct hdr_writer {
    alp_context *context;
    uint8_t *bytes;
    size_t size, capacity;
    uint64_t clamped; // values that the format cannot hold
} hdr_writer;

/// A value as the format can hold it: 0 to 255/256 · 2^127.
static double hold(hdr_writer *w, float value)
{
    const double most = ldexp(255.0, 127 - MANTISSA_BITS);
    bool fits = value >= 0.0f && (double)value <= most;
    w->clamped += !fits;
    return fits ? (double)value : value > 0.0f ? most : 0.0;
}

static void encode_pixel(hdr_writer *w, const float rgba[4], uint8_t quad[4])
{
    double c[3], most = 0.0;
    for (int k = 0; k < 3; k++) {
        c[k] = hold(w, rgba[k]);
        most = fmax(most, c[k]);
    }
    int exponent = 0;
    frexp(most, &exponent);                                     // most in [½, 1) · 2^exponent
    exponent += ldexp(most, MANTISSA_BITS - exponent) >= 255.5; // would round to 256
    memset(quad, 0, 4);
    if (most > 0.0 && exponent + EXPONENT_BIAS > 0) {
        for (int k = 0; k < 3; k++) {
            quad[k] = (uint8_t)(ldexp(c[k], MANTISSA_BITS - exponent) + 0.5);
        }
        quad[3] = (uint8_t)(exponent + EXPONENT_BIAS);
    }
}

/// How many of the next bytes, `stride` apart and at most `limit`, are the same.
static uint32_t run_length(const uint8_t *bytes, uint32_t limit)
{
    uint32_t count = 1;
    while (count < limit && bytes[4 * (size_t)count] == bytes[0]) {
        count++;
    }
    return count;
}

/// One channel of a line in runs; three equal bytes are the fewest that gain by one.
static void put_runs(hdr_writer *w, const uint8_t *channel, uint32_t length)
{
    uint8_t *out = w->bytes + w->size;
    for (uint32_t x = 0; x < length;) {
        uint32_t left = length - x,
                 run = run_length(channel + 4 * (size_t)x, left < 127 ? left : 127);
        if (run >= 3) {
            *out++ = (uint8_t)(128 + run);
            *out++ = channel[4 * (size_t)x];
            x += run;
            continue;
        }
        uint8_t *count = out++;
        *count = 0;
        do {
            *out++ = channel[4 * (size_t)x++];
            ++*count;
            left = length - x;
        } while (left > 0 && *count < 128 &&
                 run_length(channel + 4 * (size_t)x, left < 3 ? left : 3) < 3);
    }
    w->size = (size_t)(out - w->bytes);
}

static alp_result put_line(hdr_writer *w, const uint8_t *quads, uint32_t length)
{
    // Runs cost at most one byte in a hundred more than they hold.
    ALP_TRY(alpi_grow(w->context, (void **)&w->bytes, &w->capacity,
                      w->size + 4 + 5 * (size_t)length, 1));
    if (length < NEW_RUNS_LEAST || length > NEW_RUNS_MOST) {
        memcpy(w->bytes + w->size, quads, 4 * (size_t)length);
        w->size += 4 * (size_t)length;
        return ALP_OK;
    }
    const uint8_t head[4] = {2, 2, (uint8_t)(length >> 8), (uint8_t)length};
    memcpy(w->bytes + w->size, head, 4);
    w->size += 4;
    for (uint32_t k = 0; k < 4; k++) {
        put_runs(w, quads + k, length);
    }
    return ALP_OK;
}

static alp_result put_picture(hdr_writer *w, const alp_image *image, uint8_t *quads)
{
    uint32_t width = image->info.width, height = image->info.height;
    ALP_TRY(alpi_grow(w->context, (void **)&w->bytes, &w->capacity, 128, 1));
    w->size =
        (size_t)snprintf((char *)w->bytes, 128,
                         "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", height, width);
    for (uint32_t y = 0; y < height; y++) {
        ALP_TRY(alpi_tick(w->context, "write", y, height));
        for (uint32_t x = 0; x < width; x++) {
            float rgba[4];
            alpi_image_pixel(image, x, y, rgba);
            encode_pixel(w, rgba, quads + 4 * (size_t)x);
        }
        ALP_TRY(put_line(w, quads, width));
    }
    return ALP_OK;
}

alp_result alpi_hdr_encode(const alp_image *image, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    *size = 0;
    alp_context *context = image->context;
    if (image->info.component != ALP_COMPONENT_FLOAT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "HDR holds float images; save an 8-bit one as PNG");
    }
    hdr_writer writer = {.context = context};
    uint8_t *quads = ALPI_NEW(context, uint8_t, (size_t)image->info.width * 4);
    alp_result result =
        quads != NULL ? put_picture(&writer, image, quads) : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(context, quads);
    if (result != ALP_OK) {
        alpi_release(context, writer.bytes);
        return result;
    }
    if (writer.clamped > 0) {
        alpi_warn(context, "hdr-range", NULL,
                  "%llu values are negative, NaN or beyond 1.7e38, which .hdr cannot hold; they "
                  "were clamped; .exr holds them",
                  (unsigned long long)writer.clamped);
    }
    *bytes = writer.bytes;
    *size = writer.size;
    return ALP_OK;
}
