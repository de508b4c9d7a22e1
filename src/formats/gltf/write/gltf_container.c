// SPDX-License-Identifier: MIT
// Where the binary data of a written glTF lives. What was there stays a prefix of its buffer; new
// data comes behind it, or becomes a buffer of its own.
#include "formats/gltf/write/gltf_container.h"

#include "base/memory.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static size_t round_up(size_t size)
{
    return (size + 3) / 4 * 4;
}

static bool first_buffer_is_bin(const alpi_gltf_document *document)
{
    return document->bin != NULL && document->buffer_count > 0 &&
           document->buffers[0].bytes == document->bin;
}

alpi_gltf_home alpi_gltf_choose_home(const alpi_gltf_document *document, bool to_glb)
{
    if (!to_glb) {
        return ALPI_HOME_FILE;
    }
    if (!document->is_glb) {
        return ALPI_HOME_MERGED;
    }
    return document->buffer_count == 0 || first_buffer_is_bin(document) ? ALPI_HOME_BIN
                                                                        : ALPI_HOME_DATA_URI;
}

alp_result alpi_gltf_prepare_home(alpi_gltf_patcher *p, alpi_gltf_home home)
{
    const alpi_gltf_document *document = p->document;
    p->data_buffer =
        home == ALPI_HOME_FILE || home == ALPI_HOME_DATA_URI ? document->buffer_count : 0;
    p->data_base = home == ALPI_HOME_BIN ? round_up(document->bin_size) : 0;
    for (size_t i = 0; home == ALPI_HOME_MERGED && i < document->buffer_count; i++) {
        p->data_base += round_up(document->buffers[i].size); // all of them are in memory
    }
    ALPI_TRY_NEW(p->context, p->image_embedded, p->lists[ALPI_GLTF_IMAGES].count);
    return ALP_OK;
}

// --- the BIN chunk of a GLB ----------------------------------------------------------------------

static void settle_bin(alpi_gltf_patcher *p, alpi_bytes *bin)
{
    alpi_bytes_add(bin, p->document->bin, p->document->bin_size);
    if (p->data.size == 0) {
        return;
    }
    alpi_bytes_align(bin, '\0');
    alpi_bytes_add(bin, p->data.bytes, p->data.size);
    if (p->document->buffer_count > 0) {
        alpi_edits_set_index(&p->edits, p->lists[ALPI_GLTF_BUFFERS].spans[0], "byteLength",
                             bin->size);
    } else {
        char text[64];
        int length = snprintf(text, sizeof text, "{\"byteLength\":%zu}", bin->size);
        alpi_patcher_append(p, ALPI_GLTF_BUFFERS, text, (size_t)length);
    }
}

// --- .gltf → .glb --------------------------------------------------------------------------------

static const char *image_type(const uint8_t *bytes, size_t size)
{
    static const struct {
        const char *type, *magic;
        size_t at, length;
    } kinds[] = {{"image/png", "\x89PNG\r\n\x1a\n", 0, 8},
                 {"image/jpeg", "\xff\xd8\xff", 0, 3},
                 {"image/webp", "WEBP", 8, 4},
                 {"image/ktx2", "\xabKTX 20\xbb", 0, 8}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (size >= kinds[i].at + kinds[i].length &&
            memcmp(bytes + kinds[i].at, kinds[i].magic, kinds[i].length) == 0) {
            return kinds[i].type;
        }
    }
    return NULL;
}

/// Replaces the member "uri" by the view that holds the image now.
static void point_at_view(alpi_gltf_patcher *p, alpi_json_span image, const uint8_t *bytes,
                          size_t size)
{
    alpi_json_span old;
    bool has_type = alpi_json_find(p->document->text, image, "mimeType", &old);
    size_t view = alpi_patcher_add_view(p, bytes, size, 0, 0);
    alpi_json_cursor cursor = alpi_json_open(p->document->text, image);
    while (alpi_json_next(&cursor)) {
        if (alpi_json_key_is(p->document->text, cursor.key, "uri")) {
            alpi_json_span member = {cursor.key.begin, cursor.value.end};
            if (has_type) {
                alpi_edits_replace(&p->edits, member, "\"bufferView\":%zu", view);
            } else {
                alpi_edits_replace(&p->edits, member, "\"bufferView\":%zu,\"mimeType\":\"%s\"",
                                   view, image_type(bytes, size));
            }
        }
    }
}

static alp_result embed_image(alpi_gltf_patcher *p, size_t index)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "image %zu", index);
    const char *uri = alpi_gltf_text(alpi_gltf_item(p->document, "images", index), "uri");
    if (uri == NULL || strncasecmp(uri, "data:", 5) == 0) {
        return ALP_OK;
    }
    uint8_t *bytes = NULL;
    size_t size = 0;
    alp_result result = alpi_gltf_image_read(p->document, uri, owner, &bytes, &size);
    if (result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    if (result == ALP_OK && image_type(bytes, size) != NULL) {
        point_at_view(p, p->lists[ALPI_GLTF_IMAGES].spans[index], bytes, size);
        p->image_embedded[index] = true;
    } else {
        alpi_note(p->context, "image-not-embedded", owner,
                  "\"%.200s\" cannot be read or has an unknown format: it stays a reference", uri);
    }
    alpi_release(p->context, bytes);
    return ALP_OK;
}

/// Fallbacks for readers that do not decompress hold no bytes of ours: they stay buffers of their
/// own, behind the one that holds all others.
static bool is_fallback(const alpi_gltf_document *document, size_t buffer)
{
    return document->buffers[buffer].bytes == NULL;
}

static size_t count_fallbacks(const alpi_gltf_document *document, size_t end)
{
    size_t count = 0;
    for (size_t i = 0; i < end; i++) {
        count += is_fallback(document, i);
    }
    return count;
}

/// Moves a view (or what an extension says of its compressed form) to where its buffer went.
static alp_result move_view(alpi_gltf_patcher *p, json_t *view, alpi_json_span span,
                            const size_t *bases)
{
    size_t buffer, offset;
    ALP_TRY(alpi_gltf_index(p->document, view, "buffer", "buffers", "bufferViews", &buffer));
    ALP_TRY(alpi_gltf_size_or(p->document, view, "byteOffset", "bufferViews", 0, &offset));
    if (buffer != ALPI_GLTF_NONE && is_fallback(p->document, buffer)) {
        alpi_edits_set_index(&p->edits, span, "buffer", 1 + count_fallbacks(p->document, buffer));
    } else if (buffer != ALPI_GLTF_NONE && buffer != 0) {
        alpi_edits_set_index(&p->edits, span, "buffer", 0);
        alpi_edits_set_index(&p->edits, span, "byteOffset", offset + bases[buffer]);
    }
    return ALP_OK;
}

static alp_result move_views(alpi_gltf_patcher *p, const size_t *bases)
{
    static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
    const alpi_gltf_list *views = &p->lists[ALPI_GLTF_BUFFER_VIEWS];
    for (size_t i = 0; i < views->count; i++) {
        json_t *view = alpi_gltf_item(p->document, "bufferViews", i);
        ALP_TRY(move_view(p, view, views->spans[i], bases));
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
            json_t *extension = alpi_gltf_extension(view, names[k]);
            alpi_json_span span;
            if (extension != NULL &&
                alpi_json_find(p->document->text, views->spans[i], "extensions", &span) &&
                alpi_json_find(p->document->text, span, names[k], &span)) {
                ALP_TRY(move_view(p, extension, span, bases));
            }
        }
    }
    return ALP_OK;
}

/// The text of the buffers that are left.
static void print_buffers(alpi_gltf_patcher *p, size_t size, alpi_bytes *text)
{
    alpi_bytes_print(text, "[{\"byteLength\":%zu}", size);
    for (size_t i = 0; i < p->document->buffer_count; i++) {
        if (is_fallback(p->document, i)) {
            alpi_json_span span = p->lists[ALPI_GLTF_BUFFERS].spans[i];
            alpi_bytes_print(text, ",");
            alpi_bytes_add(text, p->document->text + span.begin, span.end - span.begin);
        }
    }
    alpi_bytes_print(text, "]");
}

/// The one buffer that is left, with fallbacks. A lone buffer keeps its name and extras.
static alp_result replace_buffers(alpi_gltf_patcher *p, size_t size)
{
    const char *text = p->document->text;
    alpi_json_span array;
    char fresh[64];
    int length = snprintf(fresh, sizeof fresh, "{\"byteLength\":%zu}", size);
    if (p->document->buffer_count == 1 && !is_fallback(p->document, 0)) {
        alpi_json_span buffer = p->lists[ALPI_GLTF_BUFFERS].spans[0];
        alpi_edits_set_index(&p->edits, buffer, "byteLength", size);
        alpi_edits_remove(&p->edits, buffer, "uri");
    } else if (p->document->buffer_count > 0 && alpi_json_find(text, p->root, "buffers", &array)) {
        alpi_bytes buffers = alpi_bytes_create(p->context);
        print_buffers(p, size, &buffers);
        p->data.failed |= buffers.failed;
        alpi_edits_set(&p->edits, p->root, "buffers", buffers.bytes, buffers.size);
        alpi_bytes_destroy(&buffers);
    } else if (size > 0) {
        alpi_patcher_append(p, ALPI_GLTF_BUFFERS, fresh, (size_t)length);
    }
    return ALP_OK;
}

static alp_result merge_with(alpi_gltf_patcher *p, size_t *bases, alpi_bytes *bin)
{
    for (size_t i = 0; i < p->document->buffer_count; i++) {
        bases[i] = bin->size;
        alpi_bytes_add(bin, p->document->buffers[i].bytes, p->document->buffers[i].size);
        alpi_bytes_align(bin, '\0');
    }
    alpi_bytes_add(bin, p->data.bytes, p->data.size);
    ALP_TRY(move_views(p, bases));
    return replace_buffers(p, bin->size);
}

static alp_result settle_merged(alpi_gltf_patcher *p, alpi_bytes *bin)
{
    for (size_t i = 0; i < p->lists[ALPI_GLTF_IMAGES].count; i++) {
        ALP_TRY(embed_image(p, i));
    }
    size_t *bases = ALPI_NEW(p->context, size_t, p->document->buffer_count);
    if (bases == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = merge_with(p, bases, bin);
    alpi_release(p->context, bases);
    return result;
}

// --- a buffer of its own -------------------------------------------------------------------------

/// @param uri of the file that gets the data, or NULL: the data goes into the text
static void add_buffer(alpi_gltf_patcher *p, const char *uri)
{
    if (p->data.size == 0) {
        return;
    }
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(&text, "{\"byteLength\":%zu,\"uri\":", p->data.size);
    if (uri != NULL) {
        alpi_bytes_quote(&text, uri);
    } else {
        alpi_bytes_print(&text, "\"data:application/octet-stream;base64,");
        alpi_bytes_base64(&text, p->data.bytes, p->data.size);
        alpi_bytes_print(&text, "\"");
    }
    alpi_bytes_print(&text, "}");
    p->data.failed |= text.failed;
    alpi_patcher_append(p, ALPI_GLTF_BUFFERS, text.bytes, text.size);
    alpi_bytes_destroy(&text);
}

/// Names the file that a GLB's BIN chunk becomes.
static void name_bin_file(alpi_gltf_patcher *p, const char *uri)
{
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_quote(&text, uri);
    p->data.failed |= text.failed;
    alpi_edits_set(&p->edits, p->lists[ALPI_GLTF_BUFFERS].spans[0], "uri", text.bytes, text.size);
    alpi_bytes_destroy(&text);
}

alp_result alpi_gltf_settle_home(alpi_gltf_patcher *p, alpi_gltf_home home,
                                 const alpi_gltf_names *names, alpi_bytes *bin)
{
    switch (home) {
    case ALPI_HOME_BIN:
        settle_bin(p, bin);
        break;
    case ALPI_HOME_MERGED:
        ALP_TRY(settle_merged(p, bin));
        break;
    case ALPI_HOME_FILE:
        add_buffer(p, names->data_uri);
        if (first_buffer_is_bin(p->document)) {
            name_bin_file(p, names->bin_uri);
        }
        break;
    case ALPI_HOME_DATA_URI:
        alpi_bytes_add(bin, p->document->bin, p->document->bin_size);
        add_buffer(p, NULL);
        break;
    }
    return bin->failed || p->data.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}
