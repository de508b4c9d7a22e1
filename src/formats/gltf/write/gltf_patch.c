// SPDX-License-Identifier: MIT
// Makes and destroys the patcher, runs its steps, and applies its edits.
#include "formats/gltf/write/gltf_patch.h"

#include "base/memory.h"
#include "formats/gltf/write/gltf_patch_instances.h"
#include "formats/gltf/write/gltf_patch_material.h"
#include "formats/gltf/write/gltf_patch_mesh.h"
#include "formats/gltf/write/gltf_patch_plan.h"
#include "formats/gltf/write/gltf_patch_vertex.h"

#include <string.h>

static const char *const kind_names[ALPI_GLTF_KIND_COUNT] = {[ALPI_GLTF_ACCESSORS] = "accessors",
                                                             [ALPI_GLTF_BUFFERS] = "buffers",
                                                             [ALPI_GLTF_BUFFER_VIEWS] =
                                                                 "bufferViews",
                                                             [ALPI_GLTF_IMAGES] = "images",
                                                             [ALPI_GLTF_MATERIALS] = "materials",
                                                             [ALPI_GLTF_MESHES] = "meshes",
                                                             [ALPI_GLTF_NODES] = "nodes",
                                                             [ALPI_GLTF_SAMPLERS] = "samplers",
                                                             [ALPI_GLTF_TEXTURES] = "textures"};

// --- life ----------------------------------------------------------------------------------------

static alp_result find_elements(alpi_gltf_patcher *p, alpi_gltf_kind kind)
{
    alpi_gltf_list *list = &p->lists[kind];
    list->text = alpi_bytes_create(p->context);
    list->count = alpi_gltf_count(p->document, kind_names[kind]);
    ALPI_TRY_NEW(p->context, list->spans, list->count);
    alpi_json_span array = {0};
    alpi_json_find(p->document->text, p->root, kind_names[kind], &array);
    alpi_json_cursor cursor = alpi_json_open(p->document->text, array);
    size_t found = 0;
    while (found < list->count && alpi_json_next(&cursor)) {
        list->spans[found++] = cursor.value;
    }
    return found == list->count
               ? ALP_OK
               : alpi_fail(p->context, ALP_ERROR_INVALID_DATA,
                           "%s: %s: its text holds %zu elements, its tree %zu", p->document->path,
                           kind_names[kind], found, list->count);
}

static alp_result fill_patcher(alpi_gltf_patcher *p)
{
    const alpi_gltf_document *document = p->document;
    p->edits = alpi_edits_create(p->context, document->text);
    p->data = alpi_bytes_create(p->context);
    if (!alpi_json_value(document->text, 0, document->text_size, &p->root)) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_DATA, "%s: the JSON is empty",
                         document->path);
    }
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        ALP_TRY(find_elements(p, (alpi_gltf_kind)kind));
    }
    ALPI_TRY_NEW(p->context, p->page_textures, p->patch->page_count);
    ALPI_TRY_NEW(p->context, p->light_textures, p->patch->page_count);
    for (uint32_t i = 0; i < p->patch->page_count; i++) {
        p->page_textures[i] = p->light_textures[i] = ALPI_GLTF_NONE;
    }
    ALPI_TRY_NEW(p->context, p->packed_images, p->patch->packed_count);
    memset(p->packed_images, 0xff, p->patch->packed_count * sizeof *p->packed_images); // all NONE
    size_t textures = p->lists[ALPI_GLTF_TEXTURES].count;
    ALPI_TRY_NEW(p->context, p->texture_copies, textures);
    memset(p->texture_copies, 0xff, textures * sizeof *p->texture_copies);
    return ALP_OK;
}

alp_result alpi_patcher_create(const alp_scene *scene, const alpi_mesh_patch *patch,
                               const alpi_gltf_document *document, alpi_gltf_patcher *patcher)
{
    *patcher = (alpi_gltf_patcher){.context = scene->context,
                                   .scene = scene,
                                   .patch = patch,
                                   .document = document,
                                   .exported = document !=
                                               scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data};
    alp_result result = fill_patcher(patcher);
    if (result != ALP_OK) {
        alpi_patcher_destroy(patcher);
    }
    return result;
}

void alpi_patcher_destroy(alpi_gltf_patcher *p)
{
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        alpi_release(p->context, p->lists[kind].spans);
        if (p->lists[kind].text.context != NULL) {
            alpi_bytes_destroy(&p->lists[kind].text);
        }
    }
    alpi_edits_destroy(&p->edits);
    alpi_bytes_destroy(&p->data);
    alpi_release(p->context, p->known);
    alpi_release(p->context, p->known_table);
    alpi_release(p->context, p->triangle_pages);
    alpi_release(p->context, p->plans);
    alpi_release(p->context, p->showings);
    alpi_release(p->context, p->pieces);
    alpi_release(p->context, p->mapped);
    alpi_release(p->context, p->copies);
    alpi_release(p->context, p->instance_counts);
    alpi_release(p->context, p->instance_firsts);
    alpi_release(p->context, p->instances);
    alpi_release(p->context, p->page_textures);
    alpi_release(p->context, p->light_textures);
    alpi_release(p->context, p->packed_images);
    alpi_release(p->context, p->texture_copies);
    alpi_release(p->context, p->image_embedded);
    *p = (alpi_gltf_patcher){
        .context = p->context, .edits = {.context = p->context}, .data = {.context = p->context}};
}

// --- the whole sequence --------------------------------------------------------------------------

/// asset.extras.alpenglow; extras that are no object are somebody else's and stay.
static void state_origin(alpi_gltf_patcher *p)
{
    const char *text = p->document->text, *json = p->patch->extras_json;
    alpi_json_span asset, extras, old;
    if (json == NULL || !alpi_json_find(text, p->root, "asset", &asset)) {
        return;
    }
    if (!alpi_json_find(text, asset, "extras", &extras)) {
        alpi_bytes value = alpi_bytes_create(p->context);
        alpi_bytes_print(&value, "{\"alpenglow\":%s}", json);
        p->data.failed |= value.failed;
        alpi_edits_add(&p->edits, asset, "extras", value.bytes, value.size);
        alpi_bytes_destroy(&value);
    } else if (text[extras.begin] != '{') {
        alpi_note(p->context, "extras", p->document->path,
                  "asset.extras is not an object and stays unchanged: the file does not state "
                  "how it was baked");
    } else if (alpi_json_find(text, extras, "alpenglow", &old)) {
        alpi_edits_replace(&p->edits, old, "%s", json);
    } else {
        alpi_edits_add(&p->edits, extras, "alpenglow", json, strlen(json));
    }
}

alp_result alpi_patcher_run(alpi_gltf_patcher *patcher)
{
    ALP_TRY(alpi_patcher_find_instances(patcher));
    ALP_TRY(alpi_patcher_plan(patcher));
    if (patcher->patch->vertex_values == NULL) {
        ALP_TRY(alpi_patcher_materials(patcher));
        alpi_patcher_follow_pointers(patcher);
    } else {
        alpi_patcher_warn_of_former(patcher);
    }
    ALP_TRY(alpi_patcher_meshes(patcher));
    ALP_TRY(alpi_patcher_expand_instances(patcher));
    alpi_patcher_state_extensions(patcher);
    state_origin(patcher);
    return patcher->data.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_patcher_finish(alpi_gltf_patcher *p, alpi_bytes *text)
{
    for (int kind = 0; kind < ALPI_GLTF_KIND_COUNT; kind++) {
        alpi_gltf_list *list = &p->lists[kind];
        if (list->text.failed) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        alpi_json_span array;
        if (list->added == 0) {
            continue;
        }
        if (alpi_json_find(p->document->text, p->root, kind_names[kind], &array)) {
            alpi_edits_add(&p->edits, array, NULL, list->text.bytes, list->text.size);
        } else {
            alpi_bytes value = alpi_bytes_create(p->context);
            alpi_bytes_add(&value, "[", 1);
            alpi_bytes_add(&value, list->text.bytes, list->text.size);
            alpi_bytes_add(&value, "]", 1);
            p->data.failed |= value.failed;
            alpi_edits_add(&p->edits, p->root, kind_names[kind], value.bytes, value.size);
            alpi_bytes_destroy(&value);
        }
    }
    if (p->data.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return alpi_edits_apply(&p->edits, (alpi_json_span){0, p->document->text_size}, text);
}
