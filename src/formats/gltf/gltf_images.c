// SPDX-License-Identifier: MIT
// Images of a glTF asset. Only those that a used material needs for diffuse light are decoded; one
// that cannot be read costs a warning, because its material still has a factor. Normal maps are
// decoded later, by normal_maps.c.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_scene.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/images/images.h"

#include <stdio.h>
#include <string.h>

static void mark_image(const alpi_texture *texture, bool *needed)
{
    if (texture->image != ALPI_NONE) {
        needed[texture->image] = true;
    }
}

static void mark_images(const alpi_gltf_reader *reader, bool *needed)
{
    for (uint32_t i = 0; i < reader->scene->material_count; i++) {
        const alpi_material *material = &reader->scene->materials[i];
        if (reader->material_used[i]) {
            mark_image(&material->base_color_texture, needed);
            mark_image(&material->metallic_texture, needed);
            mark_image(&material->emission_texture, needed);
            mark_image(&material->occlusion_texture, needed);
            mark_image(&material->transmission_texture, needed);
        }
    }
}

/// The encoded bytes. *owned is what to release, NULL when they lie in a buffer.
static alp_result find_bytes(const alpi_gltf_document *document, size_t index, const char *owner,
                             alpi_gltf_view *view, uint8_t **owned)
{
    json_t *object = alpi_gltf_item(document, "images", index);
    size_t buffer_view;
    ALP_TRY(alpi_gltf_index(document, object, "bufferView", "bufferViews", owner, &buffer_view));
    if (buffer_view != ALPI_GLTF_NONE) {
        return alpi_gltf_view_read(document, buffer_view, view);
    }
    const char *uri = alpi_gltf_text(object, "uri");
    if (uri == NULL) {
        return alpi_gltf_fail(document, owner, "has neither uri nor bufferView");
    }
    ALP_TRY(alpi_gltf_image_read(document, uri, owner, owned, &view->size));
    view->bytes = *owned;
    return ALP_OK;
}

alp_result alpi_gltf_decode_image(const alpi_gltf_document *document, size_t index,
                                  alp_image **image)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "image %zu", index);
    alpi_gltf_view view = {0};
    uint8_t *owned = NULL;
    alp_result result = find_bytes(document, index, owner, &view, &owned);
    if (result == ALP_OK) {
        char *name = alpi_format(document->context, "%s: %s", document->path, owner);
        result = name == NULL
                     ? ALP_ERROR_OUT_OF_MEMORY
                     : alpi_image_decode(document->context, name, view.bytes, view.size, image);
        alpi_release(document->context, name);
    }
    alpi_release(document->context, owned);
    return result;
}

/// Whether a warning was given of an image of the same uri. Not all are compared where very many
/// are missing.
static bool is_uri_told(const alpi_gltf_document *document, size_t index)
{
    enum { COMPARED_LIMIT = 64 };
    const char *uri = alpi_gltf_text(alpi_gltf_item(document, "images", index), "uri");
    size_t compared = 0;
    for (size_t i = 0; i < index && uri != NULL && compared < COMPARED_LIMIT; i++) {
        if (document->told_images[i]) {
            const char *other = alpi_gltf_text(alpi_gltf_item(document, "images", i), "uri");
            if (other != NULL && strcmp(other, uri) == 0) {
                return true;
            }
            compared++;
        }
    }
    return false;
}

/// Warns of an image by the context's message, without the names of file and image in it.
static void warn_of_image(const alpi_gltf_document *document, size_t index)
{
    char owner[ALPI_GLTF_OWNER_SIZE], reason[512];
    const char *message = alp_context_message(document->context);
    snprintf(owner, sizeof owner, "image %zu", index);
    const char *const names[] = {document->path, owner};
    for (int i = 0; i < 2; i++) {
        const size_t length = strlen(names[i]);
        if (strncmp(message, names[i], length) == 0 && strncmp(message + length, ": ", 2) == 0) {
            message += length + 2;
        }
    }
    snprintf(reason, sizeof reason, "%s", message);
    alpi_gltf_clean(reason);
    alpi_warn(document->context, "image", owner, "%s; its materials are read without this texture",
              reason);
}

alp_result alpi_gltf_read_image(const alpi_gltf_document *document, size_t index, alp_image **image)
{
    *image = NULL;
    if (document->told_images[index]) {
        return ALP_OK;
    }
    const alp_result result = alpi_gltf_decode_image(document, index, image);
    if (result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    if (!is_uri_told(document, index)) {
        warn_of_image(document, index);
    }
    document->told_images[index] = true;
    return ALP_OK;
}

alp_result alpi_gltf_read_images(alpi_gltf_reader *reader)
{
    alp_scene *scene = reader->scene;
    size_t count = alpi_gltf_count(reader->document, "images");
    scene->images = ALPI_NEW(reader->context, alp_image *, count);
    if (scene->images == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    scene->image_count = (uint32_t)count;
    bool *needed = ALPI_NEW(reader->context, bool, count);
    if (needed == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    mark_images(reader, needed);
    alp_result result = ALP_OK;
    for (size_t i = 0; i < count && result == ALP_OK; i++) {
        const char *uri = alpi_gltf_text(alpi_gltf_item(reader->document, "images", i), "uri");
        result = uri != NULL ? alpi_gltf_note_image(reader->document, uri) : ALP_OK;
        if (result == ALP_OK && needed[i]) {
            result = alpi_gltf_read_image(reader->document, i, &scene->images[i]);
        }
    }
    alpi_release(reader->context, needed);
    return result;
}

// --- how an image is stored ----------------------------------------------------------------------

static alpi_image_encoding find_encoding(const alpi_gltf_view *view)
{
    enum { PNG_DEPTH_AT = 24 }; // signature 8, chunk header 8, width 4, height 4
    if (view->size > PNG_DEPTH_AT && memcmp(view->bytes, "\x89PNG", 4) == 0) {
        return view->bytes[PNG_DEPTH_AT] == 16 ? ALPI_IMAGE_ENCODING_PNG_16
                                               : ALPI_IMAGE_ENCODING_PNG_8;
    }
    if (view->size > 3 && memcmp(view->bytes, "\xff\xd8\xff", 3) == 0) {
        return ALPI_IMAGE_ENCODING_JPEG;
    }
    if (view->size > 12 && memcmp(view->bytes, "RIFF", 4) == 0 &&
        memcmp(view->bytes + 8, "WEBP", 4) == 0) {
        return ALPI_IMAGE_ENCODING_WEBP;
    }
    return ALPI_IMAGE_ENCODING_OTHER;
}

alp_result alpi_gltf_image_source(const alp_scene *scene, uint32_t image, alpi_image_source *source)
{
    const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    *source = (alpi_image_source){.encoding = ALPI_IMAGE_ENCODING_OTHER};
    snprintf(source->name, sizeof source->name, "image %u", image);
    if (document == NULL || image >= alpi_gltf_count(document, "images")) {
        return ALP_OK;
    }
    json_t *object = alpi_gltf_item(document, "images", image);
    const char *text = alpi_gltf_text(object, "name");
    text = text != NULL ? text : alpi_gltf_text(object, "uri");
    if (text != NULL && text[0] != '\0' && strncmp(text, "data:", 5) != 0) {
        snprintf(source->name, sizeof source->name, "image %u (%.60s)", image, text);
        alpi_gltf_clean(source->name);
    }
    alpi_gltf_view view = {0};
    uint8_t *owned = NULL;
    alp_result result = find_bytes(document, image, source->name, &view, &owned);
    if (result == ALP_OK) {
        source->encoding = find_encoding(&view);
    }
    alpi_release(scene->context, owned);
    return result == ALP_ERROR_OUT_OF_MEMORY ? result : ALP_OK;
}
