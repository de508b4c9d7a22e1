// SPDX-License-Identifier: MIT
// The table of built-in scenes.
#include "scene/builtin.h"

#include <stdio.h>
#include <string.h>

typedef struct builtin {
    const char *name; // with "builtin:", as users write it
    void (*build)(alpi_builder *builder);
} builtin;

enum { PREFIX_LENGTH = sizeof "builtin:" - 1 };
static const builtin BUILTINS[] = {
    {"builtin:cornell", alpi_builtin_cornell},
    {"builtin:furnace", alpi_builtin_furnace},
    {"builtin:bowl", alpi_builtin_bowl},
    {"builtin:sphere-plane", alpi_builtin_sphere_plane},
    {"builtin:torus-plane", alpi_builtin_torus_plane},
    {"builtin:teapot-room", alpi_builtin_teapot_room},
};
enum { BUILTIN_COUNT = sizeof BUILTINS / sizeof *BUILTINS };

/// Scenes that are planned: refused by name, so that nobody looks for a typing error.
static const char *const PLANNED[] = {"windows", "atrium", "terrain"};

static bool is_planned(const char *name)
{
    for (size_t i = 0; i < sizeof PLANNED / sizeof *PLANNED; i++) {
        if (strcmp(name, PLANNED[i]) == 0) {
            return true;
        }
    }
    return false;
}

static alp_result fail_unknown(alp_context *context, const char *name)
{
    char list[BUILTIN_COUNT * 40] = "";
    for (int i = 0; i < BUILTIN_COUNT; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i == 0 ? "" : ", ",
                 BUILTINS[i].name + PREFIX_LENGTH);
    }
    bool planned = is_planned(name);
    return alpi_fail(context, planned ? ALP_ERROR_UNSUPPORTED : ALP_ERROR_INVALID_ARGUMENT,
                     "builtin:%s: %s; there are: %s", name,
                     planned ? "not built yet" : "no such built-in scene", list);
}

alp_result alpi_builtin_create(alp_context *context, const char *name, alp_scene **scene)
{
    *scene = NULL;
    for (int i = 0; i < BUILTIN_COUNT; i++) {
        if (strcmp(name, BUILTINS[i].name + PREFIX_LENGTH) == 0) {
            alpi_builder builder;
            alpi_builder_start(&builder, context, BUILTINS[i].name);
            BUILTINS[i].build(&builder);
            return alpi_builder_finish(&builder, scene);
        }
    }
    return fail_unknown(context, name);
}
