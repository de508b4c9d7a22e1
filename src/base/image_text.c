// SPDX-License-Identifier: MIT
// Texts that an image carries into its file.
#include "base/image.h"
#include "base/memory.h"

#include <string.h>

enum { KEY_LIMIT = 79 }; // of PNG

static bool is_key(const char *key)
{
    const size_t length = strlen(key);
    for (const char *at = key; *at != '\0'; at++) {
        if (*at < ' ' || *at > '~') {
            return false;
        }
    }
    return length > 0 && length <= KEY_LIMIT && key[0] != ' ' && key[length - 1] != ' ';
}

static void release(alp_context *context, alpi_image_text *text)
{
    alpi_release(context, text->key);
    alpi_release(context, text->text);
    alpi_release(context, text);
}

alp_result alp_image_add_text(alp_image *image, const char *key, const char *text)
{
    if (image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (key == NULL || text == NULL || !is_key(key)) {
        return alpi_fail(image->context, ALP_ERROR_INVALID_ARGUMENT,
                         "image: a text needs a key of 1 to %d printable ASCII characters, without "
                         "a blank at either end",
                         KEY_LIMIT);
    }
    alpi_image_text *added = ALPI_NEW(image->context, alpi_image_text, 1), **end = &image->texts;
    if (added == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    added->key = alpi_copy_string(image->context, key);
    added->text = alpi_copy_string(image->context, text);
    if (added->key == NULL || added->text == NULL) {
        release(image->context, added);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    while (*end != NULL) {
        end = &(*end)->next;
    }
    *end = added;
    return ALP_OK;
}

void alpi_image_release_texts(alp_image *image)
{
    while (image->texts != NULL) {
        alpi_image_text *first = image->texts;
        image->texts = first->next;
        release(image->context, first);
    }
}
