// SPDX-License-Identifier: MIT
// KHR_lights_punctual: point, spot and directional lights of the scene's nodes, in world space.
// Lights shine along their node's −Z; intensities do not change with its scale.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"
#include "scene/lights/light_kinds.h"

#include <stdio.h>

static alp_result read_kind(const alpi_gltf_reader *reader, json_t *object, const char *owner,
                            alp_light_kind *kind)
{
    const char *type = alpi_gltf_text(object, "type");
    if (type != NULL && alpi_light_kind_named(type, kind)) {
        return ALP_OK;
    }
    return alpi_gltf_fail(reader->document, owner, "type \"%.20s\" is unknown",
                          type != NULL ? type : "");
}

static alp_result read_cone(const alpi_gltf_reader *reader, json_t *object, const char *owner,
                            alpi_light *light)
{
    json_t *spot = json_object_get(object, "spot");
    double inner = 0.0, outer = ALPI_PI / 4.0;
    ALP_TRY(alpi_gltf_number(reader->document, spot, "innerConeAngle", owner, &inner));
    ALP_TRY(alpi_gltf_number(reader->document, spot, "outerConeAngle", owner, &outer));
    double clamped_outer = outer > 0.0 ? fmin(outer, ALPI_PI / 2.0) : ALPI_PI / 4.0;
    double clamped_inner = fmin(fmax(inner, 0.0), clamped_outer);
    if (clamped_outer != outer || clamped_inner != inner) {
        alpi_warn(reader->context, "light", owner,
                  "cone angles %g (inner) and %g (outer) are out of order: %g and %g are used",
                  inner, outer, clamped_inner, clamped_outer);
    }
    light->inner_cone = (float)clamped_inner;
    light->outer_cone = (float)clamped_outer;
    return ALP_OK;
}

/// Brought into [0, most]. @return whether it was above
static bool clamp_strength(double *value, double most)
{
    const bool above = *value > most;
    *value = above ? most : fmax(*value, 0.0);
    return above;
}

/// Intensity, colour and range; what is negative, or so much that sums of it overflow, is set right
/// with a warning.
static alp_result read_strength(const alpi_gltf_reader *reader, json_t *object, const char *owner,
                                alpi_light *light)
{
    const double most_intensity = 1e20, most_color = 1e10; // as of a sun that is given
    double color[3] = {1.0, 1.0, 1.0}, intensity = 1.0, range = HUGE_VAL;
    ALP_TRY(alpi_gltf_numbers(reader->document, object, "color", owner, 3, color));
    ALP_TRY(alpi_gltf_number(reader->document, object, "intensity", owner, &intensity));
    ALP_TRY(alpi_gltf_number(reader->document, object, "range", owner, &range));
    if (!(intensity >= 0.0 && color[0] >= 0.0 && color[1] >= 0.0 && color[2] >= 0.0 &&
          range > 0.0)) {
        alpi_warn(reader->context, "light", owner,
                  "a negative intensity or colour is taken as 0, a range that is not positive as "
                  "none");
    }
    bool above = clamp_strength(&intensity, most_intensity);
    for (int k = 0; k < 3; k++) {
        above |= clamp_strength(&color[k], most_color);
    }
    if (above) {
        alpi_warn(reader->context, "light", owner,
                  "an intensity above %g is taken as that, a colour above %g as that",
                  most_intensity, most_color);
    }
    light->intensity = (float)intensity;
    light->color = (vec3){(float)color[0], (float)color[1], (float)color[2]};
    light->range = range > 0.0 && isfinite(range) ? alpi_gltf_float(range) : INFINITY;
    return ALP_OK;
}

static alp_result read_light(const alpi_gltf_reader *reader, json_t *object, const char *owner,
                             alpi_light *light)
{
    *light = (alpi_light){0};
    ALP_TRY(read_kind(reader, object, owner, &light->kind));
    ALP_TRY(read_strength(reader, object, owner, light));
    if (alp_light_traits_of(light->kind).has_cone) {
        ALP_TRY(read_cone(reader, object, owner, light));
    }
    light->name = alpi_gltf_copy_name(reader->context, object);
    return light->name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_gltf_read_lights(alpi_gltf_reader *reader)
{
    static const char extension[] = "KHR_lights_punctual";
    const alpi_gltf_document *document = reader->document;
    alp_scene *scene = reader->scene;
    json_t *lights = json_object_get(alpi_gltf_extension(document->root, extension), "lights");
    ALPI_TRY_NEW(reader->context, scene->lights, reader->order_count);
    for (uint32_t i = 0; i < reader->order_count; i++) {
        uint32_t node = reader->order[i];
        json_t *use = alpi_gltf_extension(alpi_gltf_item(document, "nodes", node), extension);
        if (use == NULL || reader->hidden[node]) {
            continue;
        }
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "node %u", node);
        size_t index;
        ALP_TRY(alpi_gltf_size(document, use, "light", owner, &index));
        json_t *object = json_array_get(lights, index);
        if (!json_is_object(object)) {
            char elements[ALPI_GLTF_OWNER_SIZE];
            return alpi_gltf_fail(
                document, owner, "light is %zu, but %s", index,
                alpi_gltf_state_count(json_array_size(lights), "lights", elements));
        }
        snprintf(owner, sizeof owner, "light %zu", index);
        alpi_light *light = &scene->lights[scene->light_count];
        ALP_TRY(read_light(reader, object, owner, light));
        if (alpi_light_place(light, &reader->world[node])) {
            scene->light_count++;
        } else {
            alpi_warn(reader->context, "light", owner,
                      "left out: the transform of node %u gives it no place or direction", node);
            alpi_release(reader->context, light->name);
            light->name = NULL;
        }
    }
    return ALP_OK;
}
