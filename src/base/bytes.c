// SPDX-License-Identifier: MIT
// Growing bytes.
#include "base/bytes.h"

#include "base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void alpi_bytes_destroy(alpi_bytes *bytes)
{
    alpi_release(bytes->context, bytes->bytes);
    *bytes = (alpi_bytes){.context = bytes->context};
}

static bool make_room(alpi_bytes *bytes, size_t size)
{
    if (bytes->failed || size > SIZE_MAX - 1 - bytes->size) {
        bytes->failed = true;
        return false;
    }
    void *items = bytes->bytes;
    bytes->failed =
        alpi_grow(bytes->context, &items, &bytes->capacity, bytes->size + size + 1, 1) != ALP_OK;
    bytes->bytes = items;
    return !bytes->failed;
}

void alpi_bytes_reserve(alpi_bytes *bytes, size_t more)
{
    if (bytes->failed || more > SIZE_MAX - 1 - bytes->size ||
        bytes->size + more + 1 <= bytes->capacity) {
        return; // the size is known to be too much, or comes out where it is added
    }
    const size_t capacity = bytes->size + more + 1;
    void *moved = alpi_reallocate(bytes->context, bytes->bytes, capacity, 1);
    bytes->failed = moved == NULL;
    bytes->bytes = moved != NULL ? moved : bytes->bytes;
    bytes->capacity = moved != NULL ? capacity : bytes->capacity;
}

void alpi_bytes_add(alpi_bytes *bytes, const void *data, size_t size)
{
    if (make_room(bytes, size)) {
        if (size > 0) {
            memcpy(bytes->bytes + bytes->size, data, size);
        }
        bytes->size += size;
        bytes->bytes[bytes->size] = 0;
    }
}

void alpi_bytes_print_arguments(alpi_bytes *bytes, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    if (length >= 0 && make_room(bytes, (size_t)length)) {
        // Both callers started it. NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
        vsnprintf((char *)bytes->bytes + bytes->size, (size_t)length + 1, format, arguments);
        bytes->size += (size_t)length;
    }
}

void alpi_bytes_print(alpi_bytes *bytes, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    alpi_bytes_print_arguments(bytes, format, arguments);
    va_end(arguments);
}

void alpi_bytes_number(alpi_bytes *bytes, double value, int digits)
{
    char text[64];
    snprintf(text, sizeof text, "%.*g", digits, value);
    for (char *p = text; *p != '\0'; p++) {
        *p = strchr("0123456789+-eE", *p) != NULL ? *p : '.'; // the locale's decimal sign
    }
    alpi_bytes_add(bytes, text, strlen(text));
}

void alpi_bytes_float(alpi_bytes *bytes, float value)
{
    char text[32];
    int digits = 5;
    do { // nine always do
        snprintf(text, sizeof text, "%.*g", ++digits, (double)value);
    } while (digits < 9 && strtof(text, NULL) != value);
    alpi_bytes_number(bytes, (double)value, digits);
}

void alpi_bytes_base64(alpi_bytes *bytes, const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t bits = (uint32_t)data[i] << 16;
        bits |= left > 1 ? (uint32_t)data[i + 1] << 8 : 0;
        bits |= left > 2 ? (uint32_t)data[i + 2] : 0;
        char group[4] = {digits[bits >> 18], digits[bits >> 12 & 63],
                         left > 1 ? digits[bits >> 6 & 63] : '=',
                         left > 2 ? digits[bits & 63] : '='};
        alpi_bytes_add(bytes, group, sizeof group);
    }
}

void alpi_bytes_quote(alpi_bytes *bytes, const char *text)
{
    alpi_bytes_add(bytes, "\"", 1);
    for (; *text != '\0'; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            alpi_bytes_print(bytes, "\\%c", c);
        } else if (c < 0x20) {
            alpi_bytes_print(bytes, "\\u%04x", (unsigned)c);
        } else {
            alpi_bytes_add(bytes, text, 1);
        }
    }
    alpi_bytes_add(bytes, "\"", 1);
}

void alpi_bytes_add_u32(alpi_bytes *bytes, uint32_t value)
{
    const uint8_t little[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                               (uint8_t)(value >> 24)};
    alpi_bytes_add(bytes, little, sizeof little);
}

void alpi_bytes_align(alpi_bytes *bytes, char filler)
{
    while (!bytes->failed && bytes->size % 4 != 0) {
        alpi_bytes_add(bytes, &filler, 1);
    }
}
