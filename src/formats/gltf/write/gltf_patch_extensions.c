// SPDX-License-Identifier: MIT
// extensionsUsed and extensionsRequired: what materials have come to use, and what nothing uses any
// more since meshes were written uncompressed or instances became nodes.

#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_material.h"

#include <string.h>

static size_t count_draco(const alpi_gltf_document *document)
{
    size_t found = 0, count = alpi_gltf_count(document, "meshes");
    for (size_t m = 0; m < count; m++) {
        json_t *primitives = json_object_get(alpi_gltf_item(document, "meshes", m), "primitives");
        for (size_t i = 0; i < json_array_size(primitives); i++) {
            found += alpi_gltf_extension(json_array_get(primitives, i), ALPI_GLTF_DRACO) != NULL;
        }
    }
    return found;
}

static size_t count_instancing(const alpi_gltf_document *document)
{
    size_t found = 0, count = alpi_gltf_count(document, "nodes");
    for (size_t i = 0; i < count; i++) {
        found += alpi_gltf_extension(alpi_gltf_item(document, "nodes", i),
                                     "EXT_mesh_gpu_instancing") != NULL;
    }
    return found;
}

/// Names that the lists lose.
typedef struct losses {
    bool draco, instancing;
} losses;

static bool is_lost(const losses *lost, const char *name)
{
    return name != NULL && ((lost->draco && strcmp(name, ALPI_GLTF_DRACO) == 0) ||
                            (lost->instancing && strcmp(name, "EXT_mesh_gpu_instancing") == 0));
}

/// Edits one list. *empty: nothing is left of it, and so it may not stay.
static void edit_list(alpi_gltf_patcher *p, const char *list, const losses *lost, const char *added,
                      bool *empty)
{
    json_t *names = json_object_get(p->document->root, list);
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_json_span span;
    size_t kept = 0;
    const bool there = alpi_json_find(p->document->text, p->root, list, &span);
    alpi_json_cursor cursor = alpi_json_open(p->document->text, there ? span : (alpi_json_span){0});
    alpi_bytes_print(&text, "[");
    while (alpi_json_next(&cursor)) {
        const char *name = json_string_value(json_array_get(names, cursor.index));
        added = added != NULL && name != NULL && strcmp(name, added) == 0 ? NULL : added;
        if (!is_lost(lost, name)) {
            alpi_bytes_print(&text, "%s", kept++ > 0 ? "," : "");
            alpi_bytes_add(&text, p->document->text + cursor.value.begin,
                           cursor.value.end - cursor.value.begin);
        }
    }
    const bool loses = kept < json_array_size(names);
    if (added != NULL) {
        alpi_bytes_print(&text, "%s\"%s\"", kept++ > 0 ? "," : "", added);
    }
    alpi_bytes_print(&text, "]");
    *empty = loses && kept == 0;
    if (!there && added != NULL) {
        alpi_edits_add(&p->edits, p->root, list, text.bytes, text.size);
    } else if (loses && kept > 0) {
        alpi_edits_set(&p->edits, p->root, list, text.bytes, text.size);
    } else if (!loses && added != NULL) {
        char quoted[80];
        int length = snprintf(quoted, sizeof quoted, "\"%s\"", added);
        alpi_edits_add(&p->edits, span, NULL, quoted, (size_t)length);
    }
    p->data.failed |= text.failed;
    alpi_bytes_destroy(&text);
}

/// What is added is never required: some readers refuse the file then.
void alpi_patcher_state_extensions(alpi_gltf_patcher *p)
{
    static const char *const lists[] = {"extensionsUsed", "extensionsRequired"};
    const losses lost = {
        .draco = p->undraco_count > 0 && p->undraco_count == count_draco(p->document),
        .instancing = p->expanded_count > 0 && p->expanded_count == count_instancing(p->document)};
    const char *gone[2];
    size_t count = 0;
    for (int i = 0; i < 2; i++) {
        bool empty;
        edit_list(p, lists[i], &lost, i == 0 ? p->extension : NULL, &empty);
        if (empty) {
            gone[count++] = lists[i];
        }
    }
    alpi_edits_remove_all(&p->edits, p->root, gone, count);
}
