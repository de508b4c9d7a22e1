// SPDX-License-Identifier: MIT
// glTF 2.0 document → scene: runs the steps of gltf_read.h. The document stays with the scene, so
// that a writer can patch its text.
#include "formats/gltf/gltf_read.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/gltf/gltf_animation.h"
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
    ALP_TRY(reader->base != NULL ? alpi_scene_share_images(reader->base, reader->scene)
                                 : alpi_gltf_read_images(reader));
    ALP_TRY(alpi_gltf_read_cameras(reader));
    ALP_TRY(alpi_gltf_read_lights(reader));
    ALP_TRY(alpi_gltf_read_animations(reader));
    return reader->base != NULL ? alpi_scene_finish_quietly(reader->scene)
                                : alpi_scene_finish(reader->scene);
}

static void destroy_document(alp_context *context, void *data)
{
    (void)context; // the document knows its own
    alpi_gltf_document_destroy(data);
}

static alp_result read_picture(const alp_scene *scene, uint32_t index, alp_image **image)
{
    return alpi_gltf_read_image(scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data, index, image);
}

/// The document becomes the scene's, also on failure.
static alp_result read_document(alpi_gltf_reader *reader, alpi_gltf_document *document,
                                alp_scene **scene)
{
    *scene = NULL;
    alp_result result = alpi_scene_create(reader->context, document->path, &reader->scene);
    if (result != ALP_OK) {
        alpi_gltf_document_destroy(document);
        return result;
    }
    reader->scene->attachments[ALPI_ATTACHMENT_DOCUMENT] =
        (alpi_attachment){document, destroy_document};
    reader->scene->read_image = read_picture;
    result = fill_scene(reader);
    alpi_release(reader->context, reader->world);
    alpi_release(reader->context, reader->order);
    alpi_release(reader->context, reader->placed);
    alpi_release(reader->context, reader->hidden);
    alpi_release(reader->context, reader->material_used);
    if (result != ALP_OK) {
        alp_scene_destroy(reader->scene);
        return result;
    }
    *scene = reader->scene;
    return ALP_OK;
}

alp_result alpi_gltf_scene_from_document(alpi_gltf_document *document, alp_scene **scene)
{
    const uint64_t hash = hash_document(document);
    alpi_gltf_reader reader = {
        .context = document->context, .document = document, .choice = document->choice};
    ALP_TRY(read_document(&reader, document, scene));
    (*scene)->input_hash = hash;
    return ALP_OK;
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
    document->choice = choice != NULL ? alpi_copy_string(context, choice) : NULL;
    if (choice != NULL && document->choice == NULL) {
        alpi_gltf_document_destroy(document);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return alpi_gltf_scene_from_document(document, scene);
}

// --- a pose --------------------------------------------------------------------------------------

static alp_result read_pose(alpi_gltf_reader *reader, uint32_t animation, double seconds,
                            alp_scene **posed)
{
    alpi_gltf_document *document = reader->base->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    ALP_TRY(alpi_gltf_read_moments(reader, animation, seconds));
    document->more_owners++;
    return read_document(reader, document, posed);
}

alp_result alpi_gltf_read_pose(const alp_scene *scene, uint32_t animation, double seconds,
                               alp_scene **posed)
{
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    alpi_gltf_reader reader = {
        .context = scene->context, .document = document, .choice = document->choice, .base = scene};
    *posed = NULL;
    alpi_hush(scene->context, true); // reading the file has warned
    const alp_result result = read_pose(&reader, animation, seconds, posed);
    alpi_hush(scene->context, false);
    alpi_gltf_release_moments(&reader);
    if (result == ALP_OK && reader.unread_channels > 0) {
        alpi_warn(scene->context, "animation", document->path,
                  "channels that the pose leaves out, as they move neither transforms nor morph "
                  "targets: %u",
                  reader.unread_channels);
    }
    if (result == ALP_OK) {
        (*posed)->metals_black = scene->metals_black;
        const uint64_t hash =
            alpi_hash_bytes(hash_document(document), &animation, sizeof animation);
        (*posed)->input_hash = alpi_hash_bytes(hash, &seconds, sizeof seconds);
    }
    return result;
}
