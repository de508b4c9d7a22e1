// SPDX-License-Identifier: MIT
// Prints what a JSON file is made of, one "path type" a line in the file's order, for golden tests.
// Of an array only the first element is looked at.
#include <jansson.h>

#include <stdio.h>

enum { DEPTH_LIMIT = 8, PATH_SIZE = 256 };

static const char *type_name(const json_t *value)
{
    static const char *const names[] = {
        [JSON_OBJECT] = "object",   [JSON_ARRAY] = "array", [JSON_STRING] = "string",
        [JSON_INTEGER] = "integer", [JSON_REAL] = "real",   [JSON_TRUE] = "boolean",
        [JSON_FALSE] = "boolean",   [JSON_NULL] = "null",
    };
    return names[json_typeof(value)];
}

static void print_shape(json_t *value, const char *path, int depth)
{
    printf("%s %s\n", path, type_name(value));
    char inner[PATH_SIZE];
    const char *key = NULL;
    json_t *member = NULL;
    if (depth >= DEPTH_LIMIT) {
        return;
    }
    json_object_foreach(value, key, member)
    {
        snprintf(inner, sizeof inner, "%s.%s", path, key);
        print_shape(member, inner, depth + 1);
    }
    if (json_is_array(value) && json_array_size(value) > 0) {
        snprintf(inner, sizeof inner, "%s[]", path);
        print_shape(json_array_get(value, 0), inner, depth + 1);
    }
}

int main(int count, char **words)
{
    json_error_t error;
    json_t *document = count == 2 ? json_load_file(words[1], JSON_REJECT_DUPLICATES, &error) : NULL;
    if (document == NULL) {
        fprintf(stderr, "json_shape: %s\n", count == 2 ? error.text : "one file, please");
        return 1;
    }
    print_shape(document, "", 0);
    json_decref(document);
    return 0;
}
