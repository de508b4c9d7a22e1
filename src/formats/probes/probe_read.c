// SPDX-License-Identifier: MIT
// Files of probes to arrays. No array is allocated before the sizes of all files fit each other.
#include "formats/probes/probe_format.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/probes/probe_header.h"
#include "formats/probes/probe_layout.h"

#include <string.h>

/// A texture file: its bytes, and those that the JSON states.
typedef struct source {
    const char *name; // for messages
    const uint8_t *bytes;
    size_t size;
    const alpi_probe_texture *stated; // NULL: not compared
} source;

/// Catches textures of another bake before their numbers are used.
static alp_result check_source(alp_context *context, const source *from)
{
    if (from->stated == NULL) {
        return ALP_OK;
    }
    if (from->size != from->stated->bytes) {
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: has %zu bytes, its JSON states %llu: the file is cut off or of "
                         "another bake, copy all files of the probes together",
                         from->name, from->size, (unsigned long long)from->stated->bytes);
    }
    const uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, from->bytes, from->size);
    if (hash != from->stated->hash) {
        return alpi_fail(
            context, ALP_ERROR_INVALID_DATA,
            "%s: has checksum %016llx, its JSON states %016llx: the file is damaged or "
            "of another bake, copy all files of the probes together",
            from->name, (unsigned long long)hash, (unsigned long long)from->stated->hash);
    }
    return ALP_OK;
}

/// Reads a texture that must have the size of `wanted`.
static alp_result read_texture(alp_context *context, const source *from,
                               const alpi_half_texture *wanted, alpi_half_texture *texture)
{
    ALP_TRY(check_source(context, from));
    ALP_TRY(alpi_ktx2_read(context, from->name, from->bytes, from->size, texture));
    if (texture->width != wanted->width || texture->height != wanted->height ||
        texture->depth != wanted->depth || texture->channels != wanted->channels) {
        const alpi_half_texture t = *texture;
        alpi_release(context, texture->texels);
        *texture = (alpi_half_texture){0};
        return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                         "%s: has %u x %u x %u texels of %u channels, its JSON gives %u x %u x %u "
                         "of %u: copy all files of the probes together",
                         from->name, t.width, t.height, t.depth, t.channels, wanted->width,
                         wanted->height, wanted->depth, wanted->channels);
    }
    return ALP_OK;
}

/// The JSON and its text.
typedef struct document {
    alpi_probe_header header;
    const char *text;
    size_t size;
} document;

static alp_result fill_volume(const document *d, const source *coefficients, const source *moments,
                              const alpi_half_texture textures[2], alpi_probe_volume *volume)
{
    ALP_TRY(alpi_probe_header_fill(&d->header, d->text, d->size, volume));
    alp_result result =
        alpi_probe_unpack(&textures[0], coefficients->name, d->header.scale, volume);
    if (result == ALP_OK && volume->moments != NULL) {
        result = alpi_probe_unpack_moments(&textures[1], moments->name, volume);
    }
    if (result != ALP_OK) {
        alpi_probe_volume_destroy(volume);
    }
    return result;
}

static alp_result decode(const document *d, const source *coefficients, const source *moments,
                         alpi_probe_volume *volume)
{
    alp_context *context = d->header.context;
    alpi_half_texture wanted[2], textures[2] = {{0}, {0}};
    ALP_TRY(
        alpi_probe_texture_shapes(&d->header.volume, d->header.gradients, &wanted[0], &wanted[1]));
    alp_result result = read_texture(context, coefficients, &wanted[0], &textures[0]);
    if (result == ALP_OK && d->header.moments) {
        result = read_texture(context, moments, &wanted[1], &textures[1]);
    }
    if (result == ALP_OK) {
        result = fill_volume(d, coefficients, moments, textures, volume);
    }
    alpi_release(context, textures[0].texels);
    alpi_release(context, textures[1].texels);
    return result;
}

alp_result alpi_probes_decode(alp_context *context, const alpi_probe_bytes *files,
                              alpi_probe_volume *volume)
{
    document d = {.text = (const char *)files->json, .size = files->json_size};
    memset(volume, 0, sizeof *volume);
    ALP_TRY(alpi_probe_header_parse(context, files->name, d.text, d.size, &d.header));
    const alpi_probe_header *h = &d.header;
    const source coefficients = {h->coefficient_texture.file, files->coefficients,
                                 files->coefficients_size,
                                 files->unchecked ? NULL : &h->coefficient_texture};
    const source moments = {h->moments ? h->moment_texture.file : "", files->moments,
                            files->moments_size, files->unchecked ? NULL : &h->moment_texture};
    const alp_result result = decode(&d, &coefficients, &moments, volume);
    alpi_probe_header_destroy(&d.header);
    return result;
}

// --- files ---------------------------------------------------------------------------------------

/// A texture file that lies beside the JSON.
typedef struct loaded {
    char *path;
    uint8_t *bytes;
    size_t size;
} loaded;

static alp_result load_texture(const alpi_probe_header *h, const alpi_probe_texture *texture,
                               const alpi_half_texture *shape, loaded *to)
{
    // Zstandard adds less than this to data that it cannot compress.
    const uint64_t raw = alpi_half_texture_size(shape), most = raw + raw / 128 + (64 << 10);
    char *folder = alpi_path_folder(h->context, h->name);
    to->path = folder != NULL ? alpi_format(h->context, "%s%s", folder, texture->file) : NULL;
    alpi_release(h->context, folder);
    if (to->path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    return alpi_file_read(h->context, to->path, most, &to->bytes, &to->size);
}

static alp_result load_textures(const document *d, loaded files[2], alpi_probe_volume *volume)
{
    const alpi_probe_header *h = &d->header;
    alpi_half_texture shapes[2];
    ALP_TRY(alpi_probe_texture_shapes(&h->volume, h->gradients, &shapes[0], &shapes[1]));
    ALP_TRY(load_texture(h, &h->coefficient_texture, &shapes[0], &files[0]));
    if (h->moments) {
        ALP_TRY(load_texture(h, &h->moment_texture, &shapes[1], &files[1]));
    }
    const source coefficients = {files[0].path, files[0].bytes, files[0].size,
                                 &h->coefficient_texture};
    const source moments = {files[1].path, files[1].bytes, files[1].size, &h->moment_texture};
    return decode(d, &coefficients, &moments, volume);
}

alp_result alpi_probes_load(alp_context *context, const char *path, alpi_probe_volume *volume)
{
    uint8_t *json = NULL;
    loaded files[2] = {{0}, {0}};
    document d = {.text = NULL};
    memset(volume, 0, sizeof *volume);
    ALP_TRY(alpi_file_read(context, path, ALPI_PROBE_JSON_LIMIT, &json, &d.size));
    d.text = (const char *)json;
    alp_result result = alpi_probe_header_parse(context, path, d.text, d.size, &d.header);
    if (result == ALP_OK) {
        result = load_textures(&d, files, volume);
        alpi_probe_header_destroy(&d.header);
    }
    for (int i = 0; i < 2; i++) {
        alpi_release(context, files[i].path);
        alpi_release(context, files[i].bytes);
    }
    alpi_release(context, json);
    return result;
}
