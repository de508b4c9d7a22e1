// SPDX-License-Identifier: MIT
// Values at vertices as an attribute: COLOR_0, which viewers multiply into the base colour, or
// _OCCLUSION, which is ours (glTF 2.0, section 3.7.2.1: names of other attributes begin with _).
#include "formats/gltf/write/gltf_patch_vertex.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_plan.h"

#include <math.h>
#include <string.h>

enum { COMPONENT_U16 = 5123, COMPONENT_FLOAT = 5126, FULL = 65535 };

static bool in_color(const alpi_gltf_patcher *p)
{
    return p->patch->vertex_attribute == ALPI_VERTEX_COLOR;
}

const char *alpi_patcher_vertex_name(const alpi_gltf_patcher *p)
{
    return in_color(p) ? "COLOR_0" : "_OCCLUSION";
}

uint16_t alpi_patcher_vertex_value(const alpi_gltf_patcher *p, uint32_t vertex)
{
    float value = p->patch->vertex_values[vertex];
    return value > 0.0f ? (uint16_t)lroundf(fminf(value, 1.0f) * (float)FULL) : 0;
}

/// Scalars, or colours where there were none: 16 bits, because 8 show steps on smooth walls.
static alp_result add_new(alpi_gltf_patcher *p, const alpi_gltf_vertex_input *input,
                          size_t *accessor)
{
    uint32_t components = in_color(p) ? 4 : 1;
    uint16_t *stored = alpi_allocate(p->context, input->count, components * sizeof *stored);
    if (stored == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < input->count; i++) {
        for (uint32_t k = 0; k < components; k++) {
            stored[(size_t)i * components + k] = k < 3 ? input->values[i] : FULL;
        }
    }
    alpi_gltf_array array = {.bytes = stored,
                             .count = input->count,
                             .components = components,
                             .component_type = COMPONENT_U16,
                             .element_size = components * sizeof *stored,
                             .normalized = true,
                             .mark = ALPI_GLTF_VALUES};
    alp_result result = alpi_patcher_add_accessor(p, &array, accessor);
    alpi_release(p->context, stored);
    return result;
}

/// Component k of the new colour of vertex i.
static float darkened(const alpi_gltf_vertex_input *input, const alpi_gltf_values *old, uint32_t i,
                      uint32_t k)
{
    uint32_t source = input->sources != NULL ? input->sources[i] : i;
    float color = alpi_gltf_values_float(old, source, k);
    return k < 3 ? color * (float)input->values[i] / (float)FULL : color;
}

/// Old colours times the values. Floats stay floats, because they may be above 1; bytes become 16
/// bits, because a product of bytes does not fit into one.
static alp_result add_product(alpi_gltf_patcher *p, const alpi_gltf_vertex_input *input,
                              const alpi_gltf_values *old, size_t *accessor)
{
    bool is_float = old->component_type == COMPONENT_FLOAT;
    size_t size = is_float ? sizeof(float) : sizeof(uint16_t);
    uint8_t *stored = alpi_allocate(p->context, input->count, old->components * size);
    if (stored == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < input->count; i++) {
        for (uint32_t k = 0; k < old->components; k++) {
            float value = darkened(input, old, i, k);
            uint16_t bits = value > 0.0f ? (uint16_t)lroundf(fminf(value, 1.0f) * (float)FULL) : 0;
            memcpy(stored + ((size_t)i * old->components + k) * size,
                   is_float ? (const void *)&value : (const void *)&bits, size);
        }
    }
    alpi_gltf_array array = {.bytes = stored,
                             .count = input->count,
                             .components = old->components,
                             .component_type = is_float ? COMPONENT_FLOAT : COMPONENT_U16,
                             .element_size = old->components * size,
                             .normalized = !is_float,
                             .mark = ALPI_GLTF_VALUES};
    alp_result result = alpi_patcher_add_accessor(p, &array, accessor);
    alpi_release(p->context, stored);
    return result;
}

/// Whether the colours of a primitive bear the mark of a bake, however it was baked since.
static bool holds_values(const alpi_gltf_patcher *p, const alpi_gltf_plan *plan)
{
    json_t *primitive = alpi_gltf_primitive(p->document, plan->mesh, plan->primitive);
    json_t *color = json_object_get(json_object_get(primitive, "attributes"), "COLOR_0");
    const double index = json_number_value(color);
    const bool there = json_is_number(color) && index >= 0.0 &&
                       index < (double)p->lists[ALPI_GLTF_ACCESSORS].count;
    const char *mark = there ? alpi_gltf_mark(p->document, "accessors", (size_t)index) : NULL;
    return mark != NULL && strcmp(mark, ALPI_GLTF_VALUES) == 0;
}

void alpi_patcher_warn_of_former(const alpi_gltf_patcher *p)
{
    json_t *extras = json_object_get(json_object_get(p->document->root, "asset"), "extras");
    json_t *former = json_object_get(json_object_get(extras, "alpenglow"), "occlusion");
    const char *name = json_string_value(json_object_get(former, "vertex_attribute"));
    bool is_former = name != NULL && strcmp(name, "COLOR_0") == 0;
    for (size_t i = 0; i < p->plan_count && !is_former; i++) {
        is_former = holds_values(p, &p->plans[i]);
    }
    if (in_color(p) && is_former) {
        alpi_warn(
            p->context, "baked-twice", p->document->path,
            "its COLOR_0 holds the occlusion of an earlier bake and is multiplied again; bake "
            "the original file");
    }
}

alp_result alpi_patcher_add_vertex_values(alpi_gltf_patcher *p, const alpi_gltf_vertex_input *input,
                                          size_t *accessor)
{
    size_t color = ALPI_GLTF_NONE;
    json_t *attributes = json_object_get(input->primitive, "attributes");
    if (in_color(p)) {
        ALP_TRY(
            alpi_gltf_index(p->document, attributes, "COLOR_0", "accessors", input->owner, &color));
    }
    if (color == ALPI_GLTF_NONE) {
        return add_new(p, input, accessor);
    }
    alpi_gltf_values old;
    ALP_TRY(alpi_gltf_accessor_read(p->document, color, &old));
    alp_result result;
    if (old.count != input->source_count || old.components < 3) {
        result = alpi_gltf_fail(p->document, input->owner,
                                "COLOR_0 (accessor %zu) has %u elements of %u components for %u "
                                "vertices",
                                color, old.count, old.components, input->source_count);
    } else {
        result = add_product(p, input, &old, accessor);
    }
    alpi_release(p->context, old.bytes);
    return result;
}
