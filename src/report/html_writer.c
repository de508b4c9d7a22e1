// SPDX-License-Identifier: MIT
// A page of HTML on its way into a file: markup, escapes, figures, base64 (RFC 4648).
#include "report/html_writer.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put_bytes(alpi_page *page, const char *bytes, size_t size)
{
    while (size > 0 && page->result == ALP_OK) {
        if (page->used == sizeof page->buffer) {
            page->result = alpi_file_append(page->writer, page->buffer, page->used);
            page->used = 0;
        }
        const size_t room = sizeof page->buffer - page->used;
        const size_t part = size < room ? size : room;
        memcpy(page->buffer + page->used, bytes, part);
        page->used += part;
        bytes += part;
        size -= part;
    }
}

void alpi_page_put(alpi_page *page, const char *markup)
{
    put_bytes(page, markup, strlen(markup));
}

void alpi_page_format(alpi_page *page, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    alpi_page_put(page, text);
}

alp_result alpi_page_flush(alpi_page *page)
{
    if (page->result == ALP_OK && page->used > 0) {
        page->result = alpi_file_append(page->writer, page->buffer, page->used);
        page->used = 0;
    }
    return page->result;
}

// --- text from outside ---------------------------------------------------------------------------

/// Length of the UTF-8 sequence at `at` and its character, or 1 and U+FFFD where there is none:
/// Unicode 15, table 3-7, which knows no overlong forms and no surrogates.
static size_t decode(const unsigned char *at, uint32_t *character)
{
    const size_t length = at[0] < 0x80 ? 1 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    uint32_t c = length == 1 ? at[0] : at[0] & (0xFFu >> (length + 1));
    size_t i = 1;
    while (i < length && (at[i] & 0xC0) == 0x80) { // the zero at the end is none
        c = c << 6 | (at[i] & 0x3Fu);
        i++;
    }
    const bool is_lead = at[0] < 0x80 || (at[0] >= 0xC2 && at[0] <= 0xF4);
    const bool is_surrogate = c >= 0xD800 && c <= 0xDFFF;
    if (!is_lead || i < length || c < least[length] || c > 0x10FFFF || is_surrogate) {
        *character = 0xFFFD;
        return 1;
    }
    *character = c;
    return length;
}

/// What stands for a character that may not stand for itself, or NULL.
static const char *reference(uint32_t c)
{
    switch (c) {
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '&':
        return "&amp;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    case '\t':
    case '\n':
    case '\r':
        return " ";
    default:
        break;
    }
    const bool is_control = c < 0x20 || (c >= 0x7F && c < 0xA0);
    return is_control || (c & 0xFFFE) == 0xFFFE || c == 0xFFFD ? "\xEF\xBF\xBD" : NULL;
}

void alpi_page_text(alpi_page *page, const char *text, size_t limit)
{
    const unsigned char *at = (const unsigned char *)text;
    for (size_t count = 0; *at != '\0'; count++) {
        if (count == limit) {
            alpi_page_put(page, "…");
            return;
        }
        uint32_t character = 0;
        const size_t length = decode(at, &character);
        const char *instead = reference(character);
        if (instead != NULL) {
            alpi_page_put(page, instead);
        } else {
            put_bytes(page, (const char *)at, length);
        }
        at += length;
    }
}

// --- pictures ------------------------------------------------------------------------------------

static void put_base64(alpi_page *page, const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t second = left > 1 ? bytes[i + 1] : 0, third = left > 2 ? bytes[i + 2] : 0;
        const uint32_t three = (uint32_t)bytes[i] << 16 | second << 8 | third;
        const char four[4] = {digits[three >> 18], digits[three >> 12 & 63],
                              left > 1 ? digits[three >> 6 & 63] : '=',
                              left > 2 ? digits[three & 63] : '='};
        put_bytes(page, four, sizeof four);
    }
}

void alpi_page_data(alpi_page *page, const alp_image *picture)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (page->result == ALP_OK) {
        page->result = alpi_png_encode(picture, &bytes, &size);
    }
    alpi_page_put(page, "data:image/png;base64,");
    put_base64(page, bytes, size);
    alpi_release(page->context, bytes);
}

void alpi_page_picture(alpi_page *page, const alp_image *picture, const char *alt)
{
    const alp_image_info info = picture->info;
    alpi_page_format(page, "<img width=\"%u\" height=\"%u\"%s alt=\"%s\" src=\"", info.width,
                     info.height, info.width < 512 ? " class=\"texels\"" : "", alt);
    alpi_page_data(page, picture);
    alpi_page_put(page, "\"/>");
}

// --- figures -------------------------------------------------------------------------------------

alpi_figure alpi_fixed(double number, int decimals)
{
    alpi_figure figure = {"–"};
    char text[400]; // of any double
    if (!isfinite(number)) {
        return figure;
    }
    snprintf(text, sizeof text, "%.*f", decimals, number);
    const char *point = text + strspn(text, "-0123456789"); // of whatever locale
    const char *decimal = point + strcspn(point, "0123456789");
    snprintf(figure.text, sizeof figure.text, "%.*s%s%s", (int)(point - text), text,
             *decimal != '\0' ? "." : "", decimal);
    return figure;
}

alpi_figure alpi_significant(double number, int digits)
{
    if (!isfinite(number) || number == 0.0) {
        return alpi_fixed(number, 0);
    }
    char text[64];
    snprintf(text, sizeof text, "%.*e", digits - 1, number); // rounds .99999 to 1.0 first
    const int exponent = (int)strtol(strchr(text, 'e') + 1, NULL, 10);
    if (exponent >= -4 && exponent < 7) {
        return alpi_fixed(number, digits > exponent + 1 ? digits - exponent - 1 : 0);
    }
    alpi_figure figure = alpi_fixed(number / pow(10.0, exponent), digits - 1);
    const size_t length = strlen(figure.text);
    snprintf(figure.text + length, sizeof figure.text - length, "e%d", exponent);
    return figure;
}

alpi_figure alpi_grouped(uint64_t number)
{
    alpi_figure figure = {""};
    char digits[24];
    const int count = snprintf(digits, sizeof digits, "%llu", (unsigned long long)number);
    size_t used = 0;
    for (int i = 0; i < count; i++) {
        if (i > 0 && (count - i) % 3 == 0) {
            memcpy(figure.text + used, "\xE2\x80\xAF", 3); // U+202F
            used += 3;
        }
        figure.text[used++] = digits[i];
    }
    return figure;
}

static alpi_figure with_unit(alpi_figure figure, const char *unit)
{
    const size_t length = strlen(figure.text);
    snprintf(figure.text + length, sizeof figure.text - length, "\u00A0%s", unit);
    return figure;
}

alpi_figure alpi_bytes(uint64_t bytes)
{
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double number = (double)bytes;
    size_t unit = 0;
    for (; number >= 1024.0 && unit + 1 < sizeof units / sizeof *units; unit++) {
        number /= 1024.0;
    }
    return with_unit(unit == 0 ? alpi_fixed(number, 0) : alpi_significant(number, 3), units[unit]);
}

alpi_figure alpi_duration(double seconds)
{
    if (isfinite(seconds) && seconds < 0.9995) {
        return with_unit(alpi_fixed(1e3 * seconds, seconds < 0.00995 ? 1 : 0), "ms");
    }
    return with_unit(alpi_fixed(seconds, seconds < 99.95 ? 2 : 0), "s");
}

alpi_figure alpi_percent(double share)
{
    return with_unit(alpi_significant(100.0 * share, 2), "%");
}
