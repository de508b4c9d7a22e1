// SPDX-License-Identifier: MIT
#include "setup/objects.h"

#include "printing/messages.h"

#include <string.h>

/// Letters of "sphere," and of "teapot,".
enum { KIND_LENGTH = 7, NUMBERS = 4 };

static alp_object_kind kind_of(const char *text)
{
    return strncmp(text, "sphere,", KIND_LENGTH) == 0   ? ALP_OBJECT_SPHERE
           : strncmp(text, "teapot,", KIND_LENGTH) == 0 ? ALP_OBJECT_TEAPOT
                                                        : ALP_OBJECT_NONE;
}

int object_read(const command_line *a, const double origin[3], alp_render_object *object)
{
    const option_value *given = &a->values[OPTION_OBJECT];
    double n[NUMBERS] = {0.0};
    if (!given->given) {
        return EXIT_DONE;
    }
    const alp_object_kind kind = kind_of(given->text);
    const char *end =
        kind != ALP_OBJECT_NONE ? number_parse_list(given->text + KIND_LENGTH, n, NUMBERS) : NULL;
    if (end == NULL || *end != '\0' || n[3] <= 0.0) {
        return usage_error(a->command,
                           "--object: '%s' is no object; give sphere,X,Y,Z,RADIUS or "
                           "teapot,X,Y,Z,RADIUS in metres",
                           given->text);
    }
    object->kind = kind;
    for (int k = 0; k < 3; k++) {
        object->position[k] = (float)(n[k] - origin[k]);
    }
    object->radius = (float)n[3];
    return EXIT_DONE;
}
