// SPDX-License-Identifier: MIT
// URIs and buffer views of a glTF asset. An asset may name files, so this is where it is kept from
// reading outside its own folder.
#include "formats/gltf/gltf_bytes.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/gltf/gltf_tree.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

// --- base64 (RFC 4648, section 4) ---------------------------------------------------------------

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Decodes into `bytes` (room for length / 4 · 3 + 3). False when it is no base64.
static bool base64_decode(const char *text, size_t length, uint8_t *bytes, size_t *size)
{
    if (length >= 4 && length % 4 == 0) { // only a last group of four may be padded
        length -= text[length - 1] == '=';
        length -= length % 4 == 3 && text[length - 1] == '=';
    }
    uint32_t bits = 0;
    size_t count = 0;
    for (size_t i = 0; i < length; i++) {
        int value = base64_value(text[i]);
        if (value < 0) {
            return false;
        }
        bits = bits << 6 | (uint32_t)value;
        if (i % 4 != 0) {
            bytes[count++] = (uint8_t)(bits >> (6 - 2 * (i % 4)) & 0xff);
        }
    }
    *size = count;
    return length % 4 != 1;
}

static alp_result read_data_uri(const alpi_gltf_document *document, const char *uri,
                                const char *owner, uint8_t **bytes, size_t *size)
{
    const char *comma = strchr(uri, ',');
    static const char marker[] = ";base64";
    size_t marker_length = sizeof marker - 1;
    if (comma == NULL || (size_t)(comma - uri) < marker_length ||
        strncasecmp(comma - marker_length, marker, marker_length) != 0) {
        return alpi_gltf_fail(document, owner, "its data: URI does not say ;base64");
    }
    size_t length = strlen(comma + 1);
    uint8_t *data = ALPI_NEW(document->context, uint8_t, length / 4 * 3 + 3);
    if (data == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (!base64_decode(comma + 1, length, data, size)) {
        alpi_release(document->context, data);
        return alpi_gltf_fail(document, owner, "the data: URI is not valid base64");
    }
    *bytes = data;
    return ALP_OK;
}

// --- files beside the asset ---------------------------------------------------------------------

/// "http:", "file:", "C:" … : letters before the first colon and before any slash.
static bool has_scheme(const char *uri)
{
    size_t length = strcspn(uri, ":/?#");
    return length > 0 && uri[length] == ':';
}

/// A backslash is no character of a URI: programs of Windows write it between folders. One that is
/// part of a name is written %5C.
static void turn_backslashes(char *uri)
{
    for (char *c = uri; *c != '\0'; c++) {
        *c = *c == '\\' ? '/' : *c;
    }
}

static bool is_data(const char *uri)
{
    return strncasecmp(uri, "data:", 5) == 0;
}

alp_result alpi_gltf_uri_path(const alpi_gltf_document *document, const char *uri,
                              const char *owner, char **path)
{
    *path = NULL;
    if (is_data(uri)) {
        return ALP_OK;
    }
    if (alpi_path_is_foreign(uri)) {
        return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                         "%s: %s: its uri \"%.200s\" is a path of another machine; put the file "
                         "beside the asset",
                         document->path, owner, uri);
    }
    if (has_scheme(uri) && !alpi_outside_takes(document->context, uri)) {
        return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                         "%s: %s: its uri \"%.200s\" has a scheme; only data: and files beside the "
                         "asset are read, with --allow-outside file: too",
                         document->path, owner, uri);
    }
    char *name = alpi_copy_string(document->context, uri);
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    turn_backslashes(name);
    if (alpi_uri_decode(name)) {
        result = alpi_outside_path(document->context, document->folder, name, path);
    }
    if (result == ALP_OK && *path == NULL) {
        result =
            alpi_gltf_fail(document, owner,
                           "its uri \"%.200s\" leaves the asset's folder; " ALPI_OUTSIDE_HINT, uri);
    }
    alpi_release(document->context, name);
    return result;
}

/// The bytes of a file; takes over the path.
static alp_result read_path(const alpi_gltf_document *document, char *path, const char *owner,
                            uint8_t **bytes, size_t *size)
{
    alp_result result = alpi_file_read(document->context, path, ALPI_GLTF_FILE_LIMIT, bytes, size);
    if (result == ALP_ERROR_IO || result == ALP_ERROR_LIMIT) { // say which asset wanted it
        char reason[512];
        snprintf(reason, sizeof reason, "%s", alp_context_message(document->context));
        result = alpi_fail(document->context, result, "%s: %s: %s", document->path, owner, reason);
    }
    alpi_release(document->context, path);
    return result;
}

alp_result alpi_gltf_uri_read(const alpi_gltf_document *document, const char *uri,
                              const char *owner, uint8_t **bytes, size_t *size)
{
    char *path = NULL;
    *bytes = NULL;
    *size = 0;
    ALP_TRY(alpi_gltf_uri_path(document, uri, owner, &path));
    if (path == NULL) {
        return read_data_uri(document, uri, owner, bytes, size);
    }
    return read_path(document, path, owner, bytes, size);
}

alp_result alpi_gltf_image_path(const alpi_gltf_document *document, const char *uri,
                                const char *owner, char **path, alpi_found *found)
{
    *path = NULL;
    *found = ALPI_FOUND_NOTHING;
    char *name = is_data(uri) ? NULL : alpi_copy_string(document->context, uri);
    if (name == NULL) {
        return is_data(uri) ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    }
    turn_backslashes(name);
    alp_result result = ALP_OK;
    if (alpi_uri_decode(name)) {
        result = alpi_find_uri(document->context, document->folder, name, path, found);
    }
    alpi_release(document->context, name);
    return result == ALP_OK && *path == NULL ? alpi_gltf_uri_path(document, uri, owner, path)
                                             : result;
}

alp_result alpi_gltf_reference_path(const alpi_gltf_document *document, const char *kind,
                                    const char *uri, char **path)
{
    alpi_found found;
    return strcmp(kind, "images") == 0 ? alpi_gltf_image_path(document, uri, kind, path, &found)
                                       : alpi_gltf_uri_path(document, uri, kind, path);
}

alp_result alpi_gltf_image_read(const alpi_gltf_document *document, const char *uri,
                                const char *owner, uint8_t **bytes, size_t *size)
{
    char *path = NULL;
    alpi_found found;
    *bytes = NULL;
    *size = 0;
    ALP_TRY(alpi_gltf_image_path(document, uri, owner, &path, &found));
    return path == NULL ? read_data_uri(document, uri, owner, bytes, size)
                        : read_path(document, path, owner, bytes, size);
}

alp_result alpi_gltf_note_image(const alpi_gltf_document *document, const char *uri)
{
    char *path = NULL, shown[256];
    alpi_found found;
    const alp_result result = alpi_gltf_image_path(document, uri, "images", &path, &found);
    if (result == ALP_OK && path != NULL) {
        const size_t length = strlen(document->folder);
        const bool below = strncmp(path, document->folder, length) == 0;
        snprintf(shown, sizeof shown, "%s", uri);
        alpi_gltf_clean(shown);
        alpi_note_found(document->context, shown, path + (below ? length : 0), found);
    }
    alpi_release(document->context, path);
    return result == ALP_ERROR_OUT_OF_MEMORY ? result : ALP_OK;
}

// --- buffer views -------------------------------------------------------------------------------

alp_result alpi_gltf_view_read(const alpi_gltf_document *document, size_t index,
                               alpi_gltf_view *view)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "bufferView %zu", index);
    json_t *object = alpi_gltf_item(document, "bufferViews", index);
    size_t buffer, offset, length;
    ALP_TRY(alpi_gltf_needed_index(document, object, "buffer", "buffers", owner, &buffer));
    ALP_TRY(alpi_gltf_size_or(document, object, "byteOffset", owner, 0, &offset));
    ALP_TRY(alpi_gltf_size(document, object, "byteLength", owner, &length));
    ALP_TRY(alpi_gltf_size_or(document, object, "byteStride", owner, 0, &view->stride));
    if (index < document->decoded_view_count && document->decoded_views[index] != NULL) {
        view->bytes = document->decoded_views[index];
        view->size = length; // what it decodes to, checked then
        return ALP_OK;
    }
    if (document->buffers[buffer].bytes == NULL) {
        return alpi_gltf_fail(document, owner,
                              "lies in buffer %zu, which is a fallback for other readers", buffer);
    }
    size_t available = document->buffers[buffer].size;
    if (offset > available || length > available - offset) {
        return alpi_gltf_fail(document, owner,
                              "byteOffset %zu + byteLength %zu pass the end of buffer %zu (%zu "
                              "bytes)",
                              offset, length, buffer, available);
    }
    view->bytes = document->buffers[buffer].bytes + offset;
    view->size = length;
    return ALP_OK;
}
