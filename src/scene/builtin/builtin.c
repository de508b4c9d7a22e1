// SPDX-License-Identifier: MIT
// The table of built-in scenes, and their names as users write them: NAME[,KEY=NUMBER]...
#include "scene/builtin/builtin.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

enum { PARAMETER_LIMIT = 2 };

/// A whole number that a scene takes.
typedef struct parameter {
    const char *key; // NULL = no more
    uint32_t low, high, standard;
} parameter;

typedef struct builtin {
    const char *name;
    void (*build)(alpi_builder *builder); // or, with parameters,
    void (*build_with)(alpi_builder *builder, const uint32_t *values);
    parameter parameters[PARAMETER_LIMIT];
} builtin;

static const builtin BUILTINS[] = {
    {.name = "cornell", .build = alpi_builtin_cornell},
    {.name = "furnace", .build = alpi_builtin_furnace},
    {.name = "bowl", .build = alpi_builtin_bowl},
    {.name = "sphere-plane", .build = alpi_builtin_sphere_plane},
    {.name = "torus-plane", .build = alpi_builtin_torus_plane},
    {.name = "teapot-room", .build = alpi_builtin_teapot_room},
    {.name = "windows", .build = alpi_builtin_windows},
    {.name = "atrium",
     .build_with = alpi_builtin_atrium,
     .parameters = {{"triangles", ALPI_ATRIUM_LOW, ALPI_SIZED_HIGH, ALPI_ATRIUM_STANDARD}}},
    {.name = "terrain",
     .build_with = alpi_builtin_terrain,
     .parameters = {{"triangles", ALPI_TERRAIN_LOW, ALPI_SIZED_HIGH, ALPI_TERRAIN_STANDARD},
                    {"trees", 0, ALPI_TREES_HIGH, ALPI_NONE}}},
};
enum { BUILTIN_COUNT = sizeof BUILTINS / sizeof *BUILTINS };

static alp_result fail_unknown(alp_context *context, const char *name)
{
    char list[BUILTIN_COUNT * 40] = "";
    for (int i = 0; i < BUILTIN_COUNT; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ", BUILTINS[i].name);
    }
    return name[0] == '\0'
               ? alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                           "builtin: the name of a scene is missing; there are: %s", list)
               : alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                           "builtin:%s: no such built-in scene; there are: %s", name, list);
}

/// Says what the scene takes; `fault` is about the setting at `text`, `length` bytes long.
static alp_result fail_setting(alp_context *context, const builtin *b, const char *text,
                               size_t length, const char *fault)
{
    char list[PARAMETER_LIMIT * 80] = "";
    for (int i = 0; i < PARAMETER_LIMIT && b->parameters[i].key != NULL; i++) {
        const parameter *p = &b->parameters[i];
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s=N, %u to %u", i == 0 ? "" : "; ", p->key,
                 p->low, p->high);
    }
    int shown = length < 100 ? (int)length : 100;
    if (list[0] == '\0') {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "builtin:%s: \"%.*s\": this scene takes no settings; leave them out",
                         b->name, shown, text);
    }
    return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                     "builtin:%s: \"%.*s\": %s; it takes, after commas: %s", b->name, shown, text,
                     fault, list);
}

/// Digits alone, at most 4294967294; ALPI_NONE if it is anything else.
static uint32_t read_number(const char *text, size_t length)
{
    uint64_t number = 0;
    for (size_t i = 0; i < length; i++) {
        if (text[i] < '0' || text[i] > '9') {
            return ALPI_NONE;
        }
        number = 10 * number + (uint64_t)(text[i] - '0');
        if (number >= ALPI_NONE) {
            return ALPI_NONE;
        }
    }
    return length == 0 ? ALPI_NONE : (uint32_t)number;
}

/// One KEY=NUMBER, `length` bytes long. `given` says which keys were set before.
static alp_result read_setting(alp_context *context, const builtin *b, const char *text,
                               size_t length, uint32_t *values, bool *given)
{
    for (int i = 0; i < PARAMETER_LIMIT && b->parameters[i].key != NULL; i++) {
        const parameter *p = &b->parameters[i];
        size_t key = strlen(p->key);
        if (length <= key || strncmp(text, p->key, key) != 0 || text[key] != '=') {
            continue;
        }
        uint32_t number = read_number(text + key + 1, length - key - 1);
        if (number == ALPI_NONE) {
            return fail_setting(context, b, text, length, "not a whole number");
        }
        if (number < p->low || number > p->high) {
            return fail_setting(context, b, text, length, "out of range");
        }
        if (given[i]) {
            return fail_setting(context, b, text, length, "set twice");
        }
        values[i] = number;
        given[i] = true;
        return ALP_OK;
    }
    return fail_setting(context, b, text, length, "no such setting");
}

static alp_result read_settings(alp_context *context, const builtin *b, const char *text,
                                uint32_t *values)
{
    bool given[PARAMETER_LIMIT] = {false};
    for (int i = 0; i < PARAMETER_LIMIT; i++) {
        values[i] = b->parameters[i].standard;
    }
    while (*text == ',') {
        size_t length = strcspn(text + 1, ",");
        ALP_TRY(read_setting(context, b, text + 1, length, values, given));
        text += length + 1;
    }
    return ALP_OK;
}

static alp_result create(alp_context *context, const builtin *b, const char *name,
                         alp_scene **scene)
{
    uint32_t values[PARAMETER_LIMIT];
    ALP_TRY(read_settings(context, b, name + strlen(b->name), values));
    char *full_name = alpi_format(context, "builtin:%s", name);
    if (full_name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_builder builder;
    alpi_builder_start(&builder, context, full_name);
    alpi_release(context, full_name);
    if (b->build != NULL) {
        b->build(&builder);
    } else {
        b->build_with(&builder, values);
    }
    return alpi_builder_finish(&builder, scene);
}

alp_result alpi_builtin_create(alp_context *context, const char *name, alp_scene **scene)
{
    *scene = NULL;
    size_t length = strcspn(name, ",");
    for (int i = 0; i < BUILTIN_COUNT; i++) {
        if (strlen(BUILTINS[i].name) == length && strncmp(name, BUILTINS[i].name, length) == 0) {
            return create(context, &BUILTINS[i], name, scene);
        }
    }
    return fail_unknown(context, name);
}
