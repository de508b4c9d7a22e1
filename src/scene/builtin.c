// SPDX-License-Identifier: MIT
#include "scene/scene.h"

alp_result alpi_builtin_create(alp_context *context, const char *name, alp_scene **scene)
{
    *scene = NULL;
    return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "builtin:%s: no such scene", name);
}
