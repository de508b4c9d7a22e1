// SPDX-License-Identifier: MIT
// glTF 2.0 document → scene: runs the steps of gltf_read.h. The document stays with the scene, so
// that a writer can patch its text.
#include "formats/gltf/gltf_read.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/gltf/gltf_scene.h"
#include "formats/gltf/gltf_tree.h"

static uint64_t hash_document(const alpi_gltf_document *document)
{
    uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, document->file_bytes, document->file_size);
    for (size_t i = 0; i < document->buffer_count; i++) {
        if (document->buffers[i].owned != NULL) { // the others are inside file_bytes
            hash = alpi_hash_bytes(hash, document->buffers[i].bytes, document->buffers[i].size);
        }
    }
    return hash;
}

static alp_result fill_scene(alpi_gltf_reader *reader)
{
    ALP_TRY(alpi_gltf_read_nodes(reader));
    ALP_TRY(alpi_gltf_read_materials(reader));
    ALP_TRY(alpi_gltf_read_meshes(reader));
    ALP_TRY(alpi_gltf_read_images(reader));
    ALP_TRY(alpi_gltf_read_cameras(reader));
    ALP_TRY(alpi_gltf_read_lights(reader));
    return alpi_scene_finish(reader->scene);
}

static void destroy_document(alp_context *context, void *data)
{
    (void)context; // the document knows its own
    alpi_gltf_document_destroy(data);
}

static alp_result read_document(alpi_gltf_document *document, const char *choice, alp_scene **scene)
{
    *scene = NULL;
    alpi_gltf_reader reader = {
        .context = document->context, .document = document, .choice = choice};
    alp_result result = alpi_scene_create(reader.context, document->path, &reader.scene);
    if (result != ALP_OK) {
        alpi_gltf_document_destroy(document);
        return result;
    }
    reader.scene->attachments[ALPI_ATTACHMENT_DOCUMENT] =
        (alpi_attachment){document, destroy_document};
    reader.scene->input_hash = hash_document(document);
    result = fill_scene(&reader);
    alpi_release(reader.context, reader.world);
    alpi_release(reader.context, reader.order);
    alpi_release(reader.context, reader.placed);
    alpi_release(reader.context, reader.material_used);
    if (result != ALP_OK) {
        alp_scene_destroy(reader.scene);
        return result;
    }
    *scene = reader.scene;
    return ALP_OK;
}

alp_result alpi_gltf_scene_from_document(alpi_gltf_document *document, alp_scene **scene)
{
    return read_document(document, NULL, scene);
}

alp_result alpi_gltf_read_scene(alp_context *context, const char *path, alp_scene **scene)
{
    return alpi_gltf_read_choice(context, path, NULL, scene);
}

alp_result alpi_gltf_read_choice(alp_context *context, const char *path, const char *choice,
                                 alp_scene **scene)
{
    alpi_gltf_document *document = NULL;
    *scene = NULL;
    ALP_TRY(alpi_gltf_document_read(context, path, &document));
    return read_document(document, choice, scene);
}
