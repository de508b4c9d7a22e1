// SPDX-License-Identifier: MIT
// The triangles of a primitive: lists, strips and fans, indexed or not (glTF 2.0, section 3.7.2).
#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_tree.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };
enum { COMPONENT_U8 = 5121, COMPONENT_U16 = 5123, COMPONENT_U32 = 5125 };

/// A primitive's mode and how many corners it lists; accessor ALPI_GLTF_NONE = 0, 1, 2 …
typedef struct corner_list {
    size_t mode, accessor;
    uint32_t count;
} corner_list;

static alp_result find_corners(const alpi_gltf_document *document, json_t *primitive,
                               const char *owner, uint32_t vertex_count, corner_list *list)
{
    ALP_TRY(alpi_gltf_size_or(document, primitive, "mode", owner, MODE_TRIANGLES, &list->mode));
    if (list->mode > MODE_FAN) {
        return alpi_gltf_fail(document, owner, "mode %zu is not defined by glTF", list->mode);
    }
    ALP_TRY(alpi_gltf_index(document, primitive, "indices", "accessors", owner, &list->accessor));
    list->count = vertex_count;
    if (list->accessor < document->decoded_count &&
        document->decoded[list->accessor].values.bytes != NULL) {
        list->mode = MODE_TRIANGLES; // strips too come out of Draco as triangles
    }
    if (list->accessor == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_accessor_check(document, list->accessor, &values));
    bool is_unsigned = values.component_type == COMPONENT_U8 ||
                       values.component_type == COMPONENT_U16 ||
                       values.component_type == COMPONENT_U32;
    if (values.components != 1 || !is_unsigned) {
        return alpi_gltf_fail(document, owner,
                              "its indices (accessor %zu) are not unsigned integer scalars",
                              list->accessor);
    }
    list->count = values.count;
    return ALP_OK;
}

static uint32_t count_triangles(const corner_list *list)
{
    if (list->mode < MODE_TRIANGLES || list->count < 3) {
        return 0;
    }
    return list->mode == MODE_TRIANGLES ? list->count / 3 : list->count - 2;
}

/// Places of the corners of triangle i in the list.
static void triangle_places(size_t mode, uint32_t i, uint32_t place[3])
{
    if (mode == MODE_TRIANGLES) {
        place[0] = 3 * i;
        place[1] = 3 * i + 1;
        place[2] = 3 * i + 2;
    } else if (mode == MODE_STRIP) { // every second triangle is turned
        place[0] = i;
        place[1] = i + 1 + i % 2;
        place[2] = i + 2 - i % 2;
    } else {
        place[0] = i + 1;
        place[1] = i + 2;
        place[2] = 0;
    }
}

static alp_result fill_triangles(const alpi_gltf_document *document, const char *owner,
                                 const corner_list *list, uint32_t vertex_count,
                                 uint32_t (*triangles)[3])
{
    alpi_gltf_values values = {0};
    if (list->accessor != ALPI_GLTF_NONE) {
        ALP_TRY(alpi_gltf_accessor_read(document, list->accessor, &values));
    }
    alp_result result = ALP_OK;
    uint32_t count = count_triangles(list);
    for (uint32_t i = 0; i < count && result == ALP_OK; i++) {
        uint32_t place[3];
        triangle_places(list->mode, i, place);
        for (int k = 0; k < 3 && result == ALP_OK; k++) {
            uint32_t vertex =
                values.bytes == NULL ? place[k] : alpi_gltf_values_index(&values, place[k]);
            if (vertex >= vertex_count) {
                result = alpi_gltf_fail(document, owner, "index %u is %u, but there %s %u %s",
                                        place[k], vertex,
                                        alpi_one_or_many(vertex_count, "is", "are"), vertex_count,
                                        alpi_one_or_many(vertex_count, "vertex", "vertices"));
            }
            triangles[i][k] = vertex;
        }
    }
    alpi_release(document->context, values.bytes);
    return result;
}

alp_result alpi_gltf_primitive_count(const alpi_gltf_document *document, json_t *primitive,
                                     const char *owner, uint32_t vertex_count,
                                     uint32_t *triangle_count, bool *drawable)
{
    corner_list list;
    *triangle_count = 0;
    *drawable = false;
    ALP_TRY(find_corners(document, primitive, owner, vertex_count, &list));
    *triangle_count = count_triangles(&list);
    *drawable = list.mode >= MODE_TRIANGLES;
    return ALP_OK;
}

alp_result alpi_gltf_primitive_triangles(const alpi_gltf_document *document, json_t *primitive,
                                         const char *owner, uint32_t vertex_count,
                                         uint32_t (**indices)[3], uint32_t *triangle_count,
                                         uint32_t *leftover)
{
    corner_list list;
    *indices = NULL;
    *triangle_count = *leftover = 0;
    ALP_TRY(find_corners(document, primitive, owner, vertex_count, &list));
    if (list.mode < MODE_TRIANGLES) {
        return ALP_OK;
    }
    uint32_t count = count_triangles(&list);
    uint32_t(*triangles)[3] = alpi_allocate(document->context, count, sizeof *triangles);
    if (triangles == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = fill_triangles(document, owner, &list, vertex_count, triangles);
    if (result != ALP_OK) {
        alpi_release(document->context, triangles);
        return result;
    }
    *indices = triangles;
    *triangle_count = count;
    *leftover = list.mode == MODE_TRIANGLES ? list.count % 3 : count == 0 ? list.count : 0;
    return ALP_OK;
}
