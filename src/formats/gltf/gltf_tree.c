// SPDX-License-Identifier: MIT
// Typed access to the JSON tree of a glTF asset: every index and number is checked here.
#include "formats/gltf/gltf_tree.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

alp_result(alpi_gltf_fail)(const alpi_gltf_document *document, const char *owner,
                           const char *format, ...)
{
    char fault[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fault, sizeof fault, format, arguments);
    va_end(arguments);
    alpi_gltf_clean(fault);
    return alpi_fail(document->context, ALP_ERROR_INVALID_DATA, "%s: %s: %s", document->path, owner,
                     fault);
}

json_t *alpi_gltf_item(const alpi_gltf_document *document, const char *kind, size_t index)
{
    json_t *item = json_array_get(json_object_get(document->root, kind), index);
    return json_is_object(item) ? item : NULL;
}

size_t alpi_gltf_count(const alpi_gltf_document *document, const char *kind)
{
    return json_array_size(json_object_get(document->root, kind));
}

/// A non-negative integer below 2^53; "3.0" counts as one, as in JavaScript.
static bool read_size(json_t *value, size_t *size)
{
    if (json_is_integer(value) && json_integer_value(value) >= 0) {
        *size = (size_t)json_integer_value(value);
        return true;
    }
    double real = json_is_real(value) ? json_real_value(value) : -1.0;
    if (real >= 0.0 && real <= 0x1p53 && real == floor(real)) {
        *size = (size_t)real;
        return true;
    }
    return false;
}

alp_result alpi_gltf_size_or(const alpi_gltf_document *document, json_t *object, const char *member,
                             const char *owner, size_t fallback, size_t *value)
{
    json_t *found = json_object_get(object, member);
    *value = fallback;
    if (found != NULL && !read_size(found, value)) {
        return alpi_gltf_fail(document, owner, "%s must be a non-negative integer", member);
    }
    return ALP_OK;
}

alp_result alpi_gltf_size(const alpi_gltf_document *document, json_t *object, const char *member,
                          const char *owner, size_t *value)
{
    if (json_object_get(object, member) == NULL) {
        return alpi_gltf_fail(document, owner, "%s is missing", member);
    }
    return alpi_gltf_size_or(document, object, member, owner, 0, value);
}

const char *alpi_gltf_state_count(size_t count, const char *kind, char text[ALPI_GLTF_OWNER_SIZE])
{
    const size_t length = strlen(kind), ending = strcmp(kind, "meshes") == 0 ? 2 : 1;
    if (count == 1) {
        snprintf(text, ALPI_GLTF_OWNER_SIZE, "there is only 1 %.*s", (int)(length - ending), kind);
    } else if (count == 0) {
        snprintf(text, ALPI_GLTF_OWNER_SIZE, "there are no %s", kind);
    } else {
        snprintf(text, ALPI_GLTF_OWNER_SIZE, "there are only %zu %s", count, kind);
    }
    return text;
}

alp_result alpi_gltf_index(const alpi_gltf_document *document, json_t *object, const char *member,
                           const char *kind, const char *owner, size_t *index)
{
    ALP_TRY(alpi_gltf_size_or(document, object, member, owner, ALPI_GLTF_NONE, index));
    size_t count = alpi_gltf_count(document, kind);
    if (*index != ALPI_GLTF_NONE && *index >= count) {
        char elements[ALPI_GLTF_OWNER_SIZE];
        return alpi_gltf_fail(document, owner, "%s is %zu, but %s", member, *index,
                              alpi_gltf_state_count(count, kind, elements));
    }
    return ALP_OK;
}

alp_result alpi_gltf_needed_index(const alpi_gltf_document *document, json_t *object,
                                  const char *member, const char *kind, const char *owner,
                                  size_t *index)
{
    ALP_TRY(alpi_gltf_index(document, object, member, kind, owner, index));
    return *index == ALPI_GLTF_NONE ? alpi_gltf_fail(document, owner, "%s is missing", member)
                                    : ALP_OK;
}

alp_result alpi_gltf_number(const alpi_gltf_document *document, json_t *object, const char *member,
                            const char *owner, double *value)
{
    json_t *found = json_object_get(object, member);
    if (found == NULL) {
        return ALP_OK;
    }
    if (!json_is_number(found)) {
        return alpi_gltf_fail(document, owner, "%s must be a number", member);
    }
    *value = json_number_value(found);
    return ALP_OK;
}

alp_result alpi_gltf_numbers(const alpi_gltf_document *document, json_t *object, const char *member,
                             const char *owner, size_t count, double *values)
{
    json_t *found = json_object_get(object, member);
    if (found == NULL) {
        return ALP_OK;
    }
    bool good = json_is_array(found) && json_array_size(found) == count;
    for (size_t i = 0; good && i < count; i++) {
        json_t *value = json_array_get(found, i);
        good = json_is_number(value);
        values[i] = json_number_value(value);
    }
    return good ? ALP_OK
                : alpi_gltf_fail(document, owner, "%s must be an array of %zu numbers", member,
                                 count);
}

const char *alpi_gltf_text(json_t *object, const char *member)
{
    return json_string_value(json_object_get(object, member));
}

json_t *alpi_gltf_extension(json_t *object, const char *name)
{
    json_t *extension = json_object_get(json_object_get(object, "extensions"), name);
    return json_is_object(extension) ? extension : NULL;
}

void alpi_gltf_clean(char *text)
{
    for (char *c = text; *c != '\0'; c++) {
        if ((unsigned char)*c < 0x20 || *c == 0x7f) {
            *c = '?';
        }
    }
}

float alpi_gltf_float(double value)
{
    return value > (double)FLT_MAX ? FLT_MAX : value < -(double)FLT_MAX ? -FLT_MAX : (float)value;
}

char *alpi_gltf_copy_name(alp_context *context, json_t *object)
{
    const char *name = alpi_gltf_text(object, "name");
    char *copy = alpi_copy_string(context, name != NULL ? name : "");
    if (copy != NULL) {
        alpi_gltf_clean(copy);
    }
    return copy;
}
