// SPDX-License-Identifier: MIT
// The object of alp_render_options as a scene of its own.
#include "base/context.h"
#include "render/object_pass.h"
#include "scene/builtin/teapot.h"

#include <math.h>

enum { SLICES = 96, STACKS = 48, TEAPOT_SEGMENTS = 12 };

static bool is_sound(const alp_render_object *o)
{
    const bool known = o->kind == ALP_OBJECT_SPHERE || o->kind == ALP_OBJECT_TEAPOT;
    return known && o->radius > 0.0f && isfinite(o->radius) &&
           vec3_is_finite(vec3_load(o->position));
}

alp_result alp_render_object_mesh(alp_context *context, const alp_render_object *o,
                                  alp_scene **scene)
{
    if (context == NULL || o == NULL || scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *scene = NULL;
    if (!is_sound(o)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "render: an object needs a kind, a finite position and a radius above 0");
    }
    const float albedo = ALPI_OBJECT_ALBEDO;
    const vec3 center = vec3_load(o->position), foot = {center.x, center.y - o->radius, center.z};
    const vec3 white = {albedo, albedo, albedo}, black = {0.0f, 0.0f, 0.0f};
    alpi_builder builder;
    alpi_builder_start(&builder, context, "object");
    alpi_builder_surface(&builder, "object",
                         alpi_builder_material(&builder, "white", white, black));
    if (o->kind == ALP_OBJECT_SPHERE) {
        alpi_builder_ball(&builder, &(alpi_ball){.center = center,
                                                 .radius = o->radius,
                                                 .top = o->radius,
                                                 .slices = SLICES,
                                                 .stacks = STACKS});
    } else {
        alpi_builder_teapot(
            &builder,
            &(alpi_teapot){.foot = foot, .height = 2.0f * o->radius, .segments = TEAPOT_SEGMENTS});
    }
    return alpi_builder_finish(&builder, scene);
}
