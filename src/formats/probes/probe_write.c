// SPDX-License-Identifier: MIT
// Probes to files: a JSON text, a texture of coefficients, and one of moments if there are any.
#include "formats/probes/probe_format.h"

#include "base/bytes.h"
#include "base/file.h"
#include "base/half.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/probes/probe_header.h"
#include "formats/probes/probe_layout.h"

#include <jansson.h>

#include <float.h>
#include <string.h>

#define JSON_ENDING ".json"

/// A texture file that is written.
typedef struct output {
    char *path;
    uint8_t *bytes;
    size_t size;
} output;

// --- checks --------------------------------------------------------------------------------------

static alp_result check_values(const alpi_probe_volume *v, const char *kind, const float *values,
                               size_t a_probe, float most)
{
    for (size_t i = 0; i < v->count * a_probe; i++) {
        if (!(fabsf(values[i]) <= most)) {
            return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                             "probe %zu: %s: %g cannot be written", i / a_probe, kind,
                             (double)values[i]);
        }
    }
    return ALP_OK;
}

static alp_result check_arrays(const alpi_probe_volume *v)
{
    const size_t values = (size_t)3 * v->coefficient_count;
    ALP_TRY(check_values(v, "coefficient", v->coefficients, values, FLT_MAX));
    ALP_TRY(check_values(v, "move", v->moves[0], 3, ALPI_HALF_MAX));
    if (v->is_list) {
        ALP_TRY(check_values(v, "place", v->places[0], 3, FLT_MAX));
    }
    if (v->gradients != NULL) {
        ALP_TRY(check_values(v, "gradient", v->gradients, 3 * values, FLT_MAX));
    }
    for (uint32_t i = 0; i < v->layer_count; i++) {
        ALP_TRY(
            check_values(v, "coefficient of a layer", v->layers[i].coefficients, values, FLT_MAX));
    }
    if (v->moments != NULL) {
        const size_t moments = (size_t)ALPI_PROBE_MOMENT_SIDE * ALPI_PROBE_MOMENT_SIDE * 2;
        ALP_TRY(check_values(v, "moment", v->moments[0], moments, FLT_MAX));
    }
    return ALP_OK;
}

static alp_result check_volume(const alpi_probe_volume *v)
{
    const uint32_t most = v->is_list ? ALPI_PROBE_LIST_LIMIT : ALPI_PROBE_COUNT_LIMIT;
    if (v->count == 0 || v->coefficient_count != alpi_probe_basis_count(v->basis) ||
        (!v->is_list && (uint64_t)v->size[0] * v->size[1] * v->size[2] != v->count)) {
        return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                         "%u probes do not fit their lattice or their basis", v->count);
    }
    if (v->count > most || v->layer_count > ALPI_PROBE_LAYER_LIMIT) {
        return alpi_fail(
            v->context, ALP_ERROR_LIMIT,
            "%u probes with %u layers; the limits of a file are %u and %d: bake fewer, "
            "or several volumes",
            v->count, v->layer_count, most, ALPI_PROBE_LAYER_LIMIT);
    }
    for (int k = 0; k < 3 && !v->is_list; k++) {
        if (!(v->spacing[k] >= FLT_MIN && v->spacing[k] <= FLT_MAX) || !isfinite(v->origin[k])) {
            return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                             "probes %g m apart from %g cannot be written", (double)v->spacing[k],
                             v->origin[k]);
        }
    }
    if (v->moments != NULL && !(v->reach >= FLT_MIN && v->reach <= FLT_MAX)) {
        return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                         "the reach of moments, %g m, must be above 0", (double)v->reach);
    }
    return check_arrays(v);
}

static alp_result check_options(const alpi_probe_volume *v)
{
    if (v->options == NULL || v->options[0] == '\0') {
        return ALP_OK;
    }
    json_t *parsed = json_loads(v->options, JSON_REJECT_DUPLICATES, NULL);
    const bool good = json_is_object(parsed);
    json_decref(parsed);
    return good ? ALP_OK
                : alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                            "the options of probes are no JSON object");
}

// --- JSON ----------------------------------------------------------------------------------------

/// A text that JSON can hold: UTF-8.
static const char *utf8(const char *text)
{
    json_t *string = json_string(text != NULL ? text : "");
    const bool good = string != NULL;
    json_decref(string);
    return !good ? "(no UTF-8)" : text != NULL ? text : "";
}

static void print_triple(alpi_bytes *text, const char *name, const double values[3], int digits)
{
    alpi_bytes_print(text, "%s\"%s\":[", ",\n", name);
    for (int k = 0; k < 3; k++) {
        alpi_bytes_print(text, "%s", k > 0 ? "," : "");
        alpi_bytes_number(text, values[k], digits);
    }
    alpi_bytes_print(text, "]");
}

static void print_float_triple(alpi_bytes *text, const float values[3])
{
    for (int k = 0; k < 3; k++) {
        alpi_bytes_print(text, "%s", k > 0 ? "," : "[");
        alpi_bytes_float(text, values[k]);
    }
    alpi_bytes_print(text, "]");
}

static void print_places(alpi_bytes *text, const alpi_probe_volume *v)
{
    alpi_bytes_print(text, ",\n\"layout\":\"%s\",\n\"count\":%u", v->is_list ? "list" : "grid",
                     v->count);
    if (!v->is_list) {
        alpi_bytes_print(text, ",\n\"size\":[%u,%u,%u]", v->size[0], v->size[1], v->size[2]);
        print_triple(text, "origin", v->origin, 17);
        alpi_bytes_print(text, ",\n\"spacing\":");
        print_float_triple(text, v->spacing);
        return;
    }
    alpi_bytes_print(text, ",\n\"positions\":[");
    for (uint32_t i = 0; i < v->count; i++) {
        alpi_bytes_print(text, "%s", i > 0 ? ",\n" : "\n");
        print_float_triple(text, v->places[i]);
    }
    alpi_bytes_print(text, "]");
}

static void print_layers(alpi_bytes *text, const alpi_probe_volume *v)
{
    alpi_bytes_print(text, ",\n\"layers\":[");
    for (uint32_t i = 0; i < v->layer_count; i++) {
        alpi_bytes_print(text, "%s{\"name\":", i > 0 ? "," : "");
        alpi_bytes_quote(text, utf8(v->layers[i].name));
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "],\n\"gradients\":%s", v->gradients != NULL ? "true" : "false");
}

static void print_texture(alpi_bytes *text, const output *texture)
{
    alpi_bytes_print(text, "{\"file\":");
    alpi_bytes_quote(text, alpi_path_name(texture->path));
    alpi_bytes_print(
        text, ",\"bytes\":%zu,\"fnv1a64\":\"%016llx\"", texture->size,
        (unsigned long long)alpi_hash_bytes(ALPI_HASH_START, texture->bytes, texture->size));
}

static void print_textures(alpi_bytes *text, const alpi_probe_volume *v, const output textures[2])
{
    alpi_bytes_print(text, ",\n\"textures\":{\n \"coefficients\":");
    print_texture(text, &textures[0]);
    alpi_bytes_print(text, "}");
    if (v->moments != NULL) {
        alpi_bytes_print(text, ",\n \"moments\":");
        print_texture(text, &textures[1]);
        alpi_bytes_print(text, ",\"reach\":");
        alpi_bytes_float(text, v->reach);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "\n}");
}

static void print_origin(alpi_bytes *text, const alpi_probe_volume *v)
{
    alpi_bytes_print(text,
                     ",\n\"content\":{\"sky\":%s,\"emission\":%s,\"reflected\":%s,"
                     "\"direct\":%s},\n\"scene\":{\"hash\":\"%016llx\"}",
                     v->without_sky ? "false" : "true", v->without_emission ? "false" : "true",
                     v->without_reflected ? "false" : "true", v->direct ? "true" : "false",
                     (unsigned long long)v->scene_hash);
    if (v->relative_error > 0.0f && isfinite(v->relative_error)) {
        alpi_bytes_print(text, ",\n\"error\":{\"relative\":");
        alpi_bytes_float(text, v->relative_error);
        alpi_bytes_print(text, ",\"mean\":");
        alpi_bytes_float(text, v->mean);
        alpi_bytes_print(text, ",\"interpolation\":");
        alpi_bytes_float(text, v->interpolation);
        alpi_bytes_print(text, ",\"noise\":");
        alpi_bytes_float(text, v->noise);
        alpi_bytes_print(text, ",\"factor\":");
        alpi_bytes_float(text, v->factor);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, ",\n\"rays\":%u,\n\"seed\":\"%llu\"", v->rays,
                     (unsigned long long)v->seed);
    if (v->options != NULL && v->options[0] != '\0') {
        alpi_bytes_print(text, ",\n\"options\":");
        alpi_bytes_add(text, v->options, strlen(v->options));
    }
}

static void print_json(alpi_bytes *text, const alpi_probe_volume *v, double scale,
                       const output textures[2])
{
    alpi_bytes_print(text,
                     "{\"format\":\"" ALPI_PROBE_FORMAT "\",\n\"version\":%d,\n"
                     "\"generator\":\"Alpenglow %s\"",
                     ALPI_PROBE_VERSION, alp_version());
    print_places(text, v);
    alpi_bytes_print(text,
                     ",\n\"basis\":\"%s\",\n\"quantity\":\"%s\",\n\"units\":\"W/m2\",\n"
                     "\"scale\":",
                     alpi_probe_basis_names[v->basis], alpi_probe_quantities[v->basis]);
    alpi_bytes_number(text, scale, 17);
    print_layers(text, v);
    print_textures(text, v, textures);
    print_origin(text, v);
    alpi_bytes_print(text, "\n}\n");
}

// --- files ---------------------------------------------------------------------------------------

/// PATH.json → PATH.ktx2 and PATH.moments.ktx2.
static alp_result name_textures(alp_context *context, const char *path, output textures[2])
{
    static const char *const endings[2] = {".ktx2", ".moments.ktx2"};
    if (!alpi_path_has_ending(path, JSON_ENDING)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: probes are written as .json, best as NAME.probes.json", path);
    }
    if (strcmp(utf8(path), path) != 0 || strpbrk(path, ALPI_PROBE_CONTROLS) != NULL) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: the name is no UTF-8 or has control characters: choose another",
                         path);
    }
    const int stem = (int)(strlen(path) - (sizeof JSON_ENDING - 1));
    for (int i = 0; i < 2; i++) {
        textures[i].path = alpi_format(context, "%.*s%s", stem, path, endings[i]);
        if (textures[i].path == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    return ALP_OK;
}

static alp_result encode_texture(const alpi_probe_volume *v, bool moments, double scale,
                                 output *texture)
{
    alpi_half_texture shapes[2];
    ALP_TRY(alpi_probe_texture_shapes(v, v->gradients != NULL, &shapes[0], &shapes[1]));
    alpi_half_texture *shape = &shapes[moments];
    ALPI_TRY_NEW(v->context, shape->texels, alpi_half_texture_size(shape));
    if (moments) {
        alpi_probe_pack_moments(v, shape);
    } else {
        alpi_probe_pack(v, scale, shape);
    }
    const alp_result result =
        alpi_ktx2_write(v->context, shape, true, &texture->bytes, &texture->size);
    alpi_release(v->context, shape->texels);
    return result;
}

static alp_result add_files(const alpi_probe_volume *v, const char *path, output textures[2],
                            alpi_bytes *text, alpi_file_set *files)
{
    const double scale = alpi_probe_scale(v);
    ALP_TRY(name_textures(v->context, path, textures));
    ALP_TRY(encode_texture(v, false, scale, &textures[0]));
    ALP_TRY(alpi_file_set_add(files, textures[0].path, textures[0].bytes, textures[0].size));
    if (v->moments != NULL) {
        ALP_TRY(encode_texture(v, true, scale, &textures[1]));
        ALP_TRY(alpi_file_set_add(files, textures[1].path, textures[1].bytes, textures[1].size));
    }
    print_json(text, v, scale, textures);
    return text->failed ? ALP_ERROR_OUT_OF_MEMORY
                        : alpi_file_set_add(files, path, text->bytes, text->size);
}

static void release_outputs(alp_context *context, const output textures[2])
{
    for (int i = 0; i < 2; i++) {
        alpi_release(context, textures[i].path);
        alpi_release(context, textures[i].bytes);
    }
}

alp_result alpi_probes_add_files(const alpi_probe_volume *volume, const char *path,
                                 alpi_file_set *files)
{
    output textures[2] = {{0}, {0}};
    ALP_TRY(check_volume(volume));
    ALP_TRY(check_options(volume));
    alpi_bytes text = alpi_bytes_create(volume->context);
    const alp_result result = add_files(volume, path, textures, &text, files);
    alpi_bytes_destroy(&text);
    release_outputs(volume->context, textures);
    return result;
}

alp_result alpi_probes_save(const alpi_probe_volume *volume, const char *path, bool overwrite)
{
    alpi_file_set files = alpi_file_set_create(volume->context, overwrite);
    return alpi_file_set_end(&files, alpi_probes_add_files(volume, path, &files));
}

alp_result alpi_probes_check_outputs(alp_context *context, const char *path, bool moments,
                                     bool overwrite)
{
    output textures[2] = {{0}, {0}};
    alp_result result = name_textures(context, path, textures);
    if (result == ALP_OK) {
        result = alpi_file_check_writable(context, path, overwrite);
    }
    for (int i = 0; i < 1 + moments && result == ALP_OK; i++) {
        result = alpi_file_check_writable(context, textures[i].path, overwrite);
    }
    release_outputs(context, textures);
    return result;
}
