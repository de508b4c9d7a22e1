// SPDX-License-Identifier: MIT
// COLLADA documents made in memory by tests.
#include "test_collada.h"

#include "base/memory.h"
#include "formats/collada_read.h"

#include <stdio.h>
#include <stdlib.h>

char *test_collada_text(const char *inside, size_t *size)
{
    static const char begin[] = "<?xml version='1.0' encoding='utf-8'?>\n<COLLADA "
                                "xmlns='http://www.collada.org/2005/11/COLLADASchema' "
                                "version='1.4.1'>",
                      end[] = "</COLLADA>\n";
    *size = strlen(begin) + strlen(inside) + strlen(end);
    char *text = malloc(*size + 1);
    assert_non_null(text);
    snprintf(text, *size + 1, "%s%s%s", begin, inside, end);
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    return text;
}

alp_result test_collada_bytes(alp_context *context, const void *bytes, size_t size,
                              alp_scene **scene)
{
    // With the zero byte that a read file has, and no more: a sanitizer sees a read past it.
    uint8_t *copy = alpi_allocate(context, size + 1, 1);
    *scene = NULL;
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(copy, bytes, size);
    alpi_collada_document *document = NULL;
    alp_result result = alpi_collada_document_parse(context, "test.dae", copy, size, &document);
    return result == ALP_OK ? alpi_collada_scene_from_document(document, scene) : result;
}

alp_result test_collada_scene(alp_context *context, const char *inside, alp_scene **scene)
{
    size_t size;
    char *text = test_collada_text(inside, &size);
    alp_result result = test_collada_bytes(context, text, size, scene);
    free(text);
    return result;
}
