// SPDX-License-Identifier: MIT
// The JSON of a file of probes. Every member is checked for its kind and its range.
#include "formats/probes/probe_header.h"

#include "base/bytes.h"
#include "base/memory.h"
#include "formats/probes/probe_layout.h"
#include "formats/text/json_spans.h"

#include <jansson.h>

#include <float.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_LIMIT = 64, VALUES_A_PROBE = 4, OTHER_VALUES = 1 << 16 };
#define NEWER_REMEDY "read it with a newer Alpenglow, or bake the probes again"

const char *const alpi_probe_basis_names[3] = {"sh9", "sh4", "ambient-cube"};
const char *const alpi_probe_quantities[3] = {"radiance coefficients", "radiance coefficients",
                                              "irradiance"};

// --- members -------------------------------------------------------------------------------------

static alp_result fail_member(const alpi_probe_header *h, const char *member, const char *fault)
{
    return alpi_fail(h->context, ALP_ERROR_INVALID_DATA,
                     "%s: \"%s\" %s: the file is damaged, bake it again", h->name, member, fault);
}

static alp_result get_number(const alpi_probe_header *h, json_t *object, const char *member,
                             double least, double most, double *value)
{
    const json_t *found = json_object_get(object, member);
    if (found == NULL) {
        return ALP_OK; // stays as it is
    }
    const double number = json_is_number(found) ? json_number_value(found) : (double)NAN;
    if (!(number >= least && number <= most)) {
        return alpi_fail(h->context, ALP_ERROR_INVALID_DATA,
                         "%s: \"%s\" must be a number of %g to %g: the file is damaged, bake it "
                         "again",
                         h->name, member, least, most);
    }
    *value = number;
    return ALP_OK;
}

static alp_result get_triple(const alpi_probe_header *h, json_t *array, const char *member,
                             double most, double values[3])
{
    if (json_array_size(array) != 3) {
        return fail_member(h, member, "must have three numbers");
    }
    for (size_t k = 0; k < 3; k++) {
        const json_t *element = json_array_get(array, k);
        values[k] = json_is_number(element) ? json_number_value(element) : (double)NAN;
        if (!(fabs(values[k]) <= most)) {
            return fail_member(h, member, "must have three finite numbers");
        }
    }
    return ALP_OK;
}

static alp_result get_flag(const alpi_probe_header *h, json_t *object, const char *member,
                           bool *value)
{
    const json_t *found = json_object_get(object, member);
    if (found != NULL && !json_is_boolean(found)) {
        return fail_member(h, member, "must be true or false");
    }
    *value = json_is_true(found);
    return ALP_OK;
}

/// Digits of a number in a string: JSON numbers of 64 bits do not survive every reader.
static alp_result get_digits(const alpi_probe_header *h, json_t *object, const char *member,
                             int base, uint64_t *value)
{
    const json_t *found = json_object_get(object, member);
    const char *text = json_string_value(found);
    if (found == NULL) {
        return ALP_OK;
    }
    const char *digits = base == 16 ? "0123456789abcdef" : "0123456789";
    const size_t length = text != NULL ? strlen(text) : 0;
    if (length == 0 || strspn(text, digits) != length || (base == 16 && length != 16) ||
        length > 20) {
        return fail_member(h, member,
                           base == 16 ? "must be a string of 16 hexadecimal digits"
                                      : "must be a string of digits");
    }
    *value = strtoull(text, NULL, base);
    return ALP_OK;
}

static json_t *get_object(const alpi_probe_header *h, const char *member)
{
    json_t *found = json_object_get(h->root, member);
    return json_is_object(found) ? found : NULL;
}

// --- the text ------------------------------------------------------------------------------------

/// The tree takes up to a hundred times the bytes of the text.
static alp_result check_size(const alpi_probe_header *h, const char *text, size_t size)
{
    const alpi_json_size found = alpi_json_measure(text, size);
    const size_t most = (size_t)ALPI_PROBE_LIST_LIMIT * VALUES_A_PROBE + OTHER_VALUES;
    if (found.depth > DEPTH_LIMIT || found.values > most) {
        return alpi_fail(
            h->context, ALP_ERROR_LIMIT,
            "%s: JSON: %zu values in %zu levels; the limits are %zu and %d: bake fewer "
            "probes",
            h->name, found.values, found.depth, most, DEPTH_LIMIT);
    }
    return ALP_OK;
}

static alp_result parse_text(alpi_probe_header *h, const char *text, size_t size)
{
    json_error_t error;
    ALP_TRY(check_size(h, text, size));
    h->root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    if (h->root == NULL) {
        const bool memory = json_error_code(&error) == json_error_out_of_memory;
        return alpi_fail(h->context, memory ? ALP_ERROR_OUT_OF_MEMORY : ALP_ERROR_INVALID_DATA,
                         "%s: JSON, line %d column %d: %s", h->name, error.line, error.column,
                         error.text);
    }
    const char *format = json_string_value(json_object_get(h->root, "format"));
    if (format == NULL || strcmp(format, ALPI_PROBE_FORMAT) != 0) {
        return alpi_fail(h->context, ALP_ERROR_INVALID_DATA,
                         "%s: is no file of probes: \"format\" is not \"%s\"", h->name,
                         ALPI_PROBE_FORMAT);
    }
    const json_t *version = json_object_get(h->root, "version");
    if (!json_is_integer(version) || json_integer_value(version) < 1) {
        return fail_member(h, "version", "must be a whole number from 1");
    }
    if (json_integer_value(version) > ALPI_PROBE_VERSION) {
        return alpi_fail(h->context, ALP_ERROR_UNSUPPORTED,
                         "%s: has version %lld of the format, this program reads version %d: %s",
                         h->name, (long long)json_integer_value(version), ALPI_PROBE_VERSION,
                         NEWER_REMEDY);
    }
    return ALP_OK;
}

// --- places and basis ----------------------------------------------------------------------------

static alp_result check_count(const alpi_probe_header *h, double count)
{
    const int most = h->volume.is_list ? ALPI_PROBE_LIST_LIMIT : ALPI_PROBE_COUNT_LIMIT;
    if (count > most) {
        return alpi_fail(h->context, ALP_ERROR_LIMIT,
                         "%s: has %.0f probes, the limit is %d: bake fewer, or several volumes",
                         h->name, count, most);
    }
    return ALP_OK;
}

static alp_result parse_list(alpi_probe_header *h)
{
    const json_t *places = json_object_get(h->root, "positions");
    const size_t count = json_array_size(places);
    if (count == 0) {
        return fail_member(h, "positions", "must be an array of places, one a probe");
    }
    ALP_TRY(check_count(h, (double)count));
    h->volume.count = h->volume.size[0] = (uint32_t)count;
    h->volume.size[1] = h->volume.size[2] = 1;
    return ALP_OK;
}

static alp_result parse_grid(alpi_probe_header *h)
{
    double size[3], spacing[3], count = 1.0;
    alpi_probe_volume *v = &h->volume;
    ALP_TRY(get_triple(h, json_object_get(h->root, "size"), "size", UINT32_MAX, size));
    ALP_TRY(get_triple(h, json_object_get(h->root, "origin"), "origin", DBL_MAX, v->origin));
    ALP_TRY(
        get_triple(h, json_object_get(h->root, "spacing"), "spacing", (double)FLT_MAX, spacing));
    for (int k = 0; k < 3; k++) {
        if (!(size[k] >= 1.0) || size[k] != floor(size[k])) {
            return fail_member(h, "size", "must have whole numbers from 1");
        }
        if (!(spacing[k] >= (double)FLT_MIN)) {
            return fail_member(h, "spacing", "must be above 0");
        }
        v->size[k] = (uint32_t)size[k];
        v->spacing[k] = (float)spacing[k];
        count *= size[k];
    }
    ALP_TRY(check_count(h, count));
    v->count = (uint32_t)count;
    return ALP_OK;
}

static alp_result parse_places(alpi_probe_header *h)
{
    const char *layout = json_string_value(json_object_get(h->root, "layout"));
    h->volume.is_list = layout != NULL && strcmp(layout, "list") == 0;
    if (layout == NULL || (!h->volume.is_list && strcmp(layout, "grid") != 0)) {
        return fail_member(h, "layout", "must be \"grid\" or \"list\"");
    }
    ALP_TRY(h->volume.is_list ? parse_list(h) : parse_grid(h));
    double count = h->volume.count;
    ALP_TRY(get_number(h, h->root, "count", 1.0, UINT32_MAX, &count));
    return count == h->volume.count ? ALP_OK
                                    : fail_member(h, "count", "does not fit the number of places");
}

static alp_result parse_basis(alpi_probe_header *h)
{
    const char *basis = json_string_value(json_object_get(h->root, "basis"));
    const char *quantity = json_string_value(json_object_get(h->root, "quantity"));
    int found = 0;
    while (basis != NULL && found < 3 && strcmp(basis, alpi_probe_basis_names[found]) != 0) {
        found++;
    }
    if (basis == NULL || found == 3) {
        return fail_member(h, "basis", "must be \"sh9\", \"sh4\" or \"ambient-cube\"");
    }
    if (quantity == NULL || strcmp(quantity, alpi_probe_quantities[found]) != 0) {
        return fail_member(h, "quantity", "does not fit the basis");
    }
    h->volume.basis = (alpi_probe_basis)found;
    h->scale = 1.0;
    ALP_TRY(get_number(h, h->root, "scale", 0x1p-149, 0x1p128, &h->scale));
    int exponent = 0;
    return frexp(h->scale, &exponent) == 0.5 ? ALP_OK
                                             : fail_member(h, "scale", "must be a power of two");
}

static alp_result parse_layers(alpi_probe_header *h)
{
    const json_t *layers = json_object_get(h->root, "layers");
    const size_t count = json_array_size(layers);
    if (layers != NULL && !json_is_array(layers)) {
        return fail_member(h, "layers", "must be an array");
    }
    if (count > ALPI_PROBE_LAYER_LIMIT) {
        return alpi_fail(h->context, ALP_ERROR_LIMIT, "%s: has %zu layers, the limit is %d",
                         h->name, count, ALPI_PROBE_LAYER_LIMIT);
    }
    for (size_t i = 0; i < count; i++) {
        if (!json_is_string(json_object_get(json_array_get(layers, i), "name"))) {
            return fail_member(h, "layers", "must have objects with a \"name\"");
        }
    }
    h->volume.layer_count = (uint32_t)count;
    return get_flag(h, h->root, "gradients", &h->gradients);
}

// --- textures and content ------------------------------------------------------------------------

/// A file in the same folder, and nothing else.
static bool is_plain_name(const char *name)
{
    return name != NULL && name[0] != '\0' && strpbrk(name, "/\\:" ALPI_PROBE_CONTROLS) == NULL &&
           strcmp(name, ".") != 0 && strcmp(name, "..") != 0;
}

static alp_result parse_texture(const alpi_probe_header *h, json_t *object,
                                alpi_probe_texture *texture)
{
    double bytes = 0.0;
    texture->file = json_string_value(json_object_get(object, "file"));
    if (!is_plain_name(texture->file)) {
        return alpi_fail(h->context, ALP_ERROR_INVALID_DATA,
                         "%s: \"file\" of a texture must be a plain name: textures lie beside the "
                         "JSON, in the same folder",
                         h->name);
    }
    if (!json_is_string(json_object_get(object, "fnv1a64"))) {
        return fail_member(h, "fnv1a64", "is missing");
    }
    ALP_TRY(get_number(h, object, "bytes", 0.0, 0x1p53, &bytes));
    texture->bytes = (uint64_t)bytes;
    return get_digits(h, object, "fnv1a64", 16, &texture->hash);
}

static alp_result parse_textures(alpi_probe_header *h)
{
    json_t *textures = get_object(h, "textures");
    json_t *moments = json_object_get(textures, "moments");
    double reach = 0.0;
    ALP_TRY(parse_texture(h, json_object_get(textures, "coefficients"), &h->coefficient_texture));
    h->moments = moments != NULL;
    if (!h->moments) {
        return ALP_OK;
    }
    ALP_TRY(parse_texture(h, moments, &h->moment_texture));
    ALP_TRY(get_number(h, moments, "reach", (double)FLT_MIN, (double)FLT_MAX, &reach));
    h->volume.reach = (float)reach;
    return reach > 0.0 ? ALP_OK : fail_member(h, "reach", "is missing");
}

static alp_result parse_content(alpi_probe_header *h)
{
    alpi_probe_volume *v = &h->volume;
    double error = 0.0, mean = 0.0, between = 0.0, rays = 0.0, noise = 0.0, factor = 0.0;
    json_t *errors = get_object(h, "error");
    ALP_TRY(get_flag(h, get_object(h, "content"), "direct", &v->direct));
    ALP_TRY(get_digits(h, get_object(h, "scene"), "hash", 16, &v->scene_hash));
    ALP_TRY(get_number(h, errors, "relative", 0.0, (double)FLT_MAX, &error));
    ALP_TRY(get_number(h, errors, "mean", 0.0, (double)FLT_MAX, &mean));
    ALP_TRY(get_number(h, errors, "interpolation", 0.0, (double)FLT_MAX, &between));
    ALP_TRY(get_number(h, h->root, "rays", 0.0, UINT32_MAX, &rays));
    ALP_TRY(get_digits(h, h->root, "seed", 10, &v->seed));
    v->relative_error = (float)error;
    ALP_TRY(get_number(h, errors, "noise", 0.0, (double)FLT_MAX, &noise));
    ALP_TRY(get_number(h, errors, "factor", 0.0, (double)FLT_MAX, &factor));
    v->noise = (float)noise;
    v->factor = (float)factor;
    v->mean = (float)mean;
    v->interpolation = (float)between;
    v->rays = (uint32_t)rays;
    const json_t *options = json_object_get(h->root, "options");
    return options == NULL || json_is_object(options)
               ? ALP_OK
               : fail_member(h, "options", "must be an object");
}

static alp_result parse_all(alpi_probe_header *h, const char *text, size_t size)
{
    alpi_half_texture coefficients, moments;
    ALP_TRY(parse_text(h, text, size));
    ALP_TRY(parse_places(h));
    ALP_TRY(parse_basis(h));
    ALP_TRY(parse_layers(h));
    ALP_TRY(parse_textures(h));
    ALP_TRY(parse_content(h));
    return alpi_probe_texture_shapes(&h->volume, h->gradients, &coefficients, &moments);
}

alp_result alpi_probe_header_parse(alp_context *context, const char *name, const char *text,
                                   size_t size, alpi_probe_header *header)
{
    *header = (alpi_probe_header){.context = context, .name = name, .volume.context = context};
    const alp_result result = parse_all(header, text, size);
    if (result != ALP_OK) {
        alpi_probe_header_destroy(header);
    }
    return result;
}

void alpi_probe_header_destroy(alpi_probe_header *header)
{
    json_decref(header->root);
    header->root = NULL;
}

// --- arrays --------------------------------------------------------------------------------------

static alp_result fill_places(const alpi_probe_header *h, alpi_probe_volume *v)
{
    const json_t *places = json_object_get(h->root, "positions");
    for (uint32_t i = 0; v->is_list && i < v->count; i++) {
        double place[3];
        ALP_TRY(get_triple(h, json_array_get(places, i), "positions", (double)FLT_MAX, place));
        for (int k = 0; k < 3; k++) {
            v->places[i][k] = (float)place[k];
        }
    }
    return ALP_OK;
}

/// The text of the options as it stands in the file.
static alp_result fill_options(const alpi_probe_header *h, const char *text, size_t size,
                               alpi_probe_volume *v)
{
    alpi_json_span root, span;
    if (json_object_get(h->root, "options") == NULL || !alpi_json_value(text, 0, size, &root) ||
        !alpi_json_find(text, root, "options", &span)) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(h->context, v->options, span.end - span.begin + 1);
    memcpy(v->options, text + span.begin, span.end - span.begin);
    return ALP_OK;
}

static alp_result fill_all(const alpi_probe_header *h, const char *text, size_t size,
                           alpi_probe_volume *v)
{
    const json_t *layers = json_object_get(h->root, "layers");
    ALP_TRY(alpi_probe_volume_allocate(h->context, h->gradients, h->moments, v));
    ALP_TRY(fill_places(h, v));
    for (uint32_t i = 0; i < v->layer_count; i++) {
        const json_t *name = json_object_get(json_array_get(layers, i), "name");
        v->layers[i].name = alpi_copy_string(h->context, json_string_value(name));
        if (v->layers[i].name == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        for (char *c = v->layers[i].name; (c = strpbrk(c, ALPI_PROBE_CONTROLS)) != NULL;) {
            *c = '?'; // names reach terminals
        }
    }
    return fill_options(h, text, size, v);
}

alp_result alpi_probe_header_fill(const alpi_probe_header *header, const char *text, size_t size,
                                  alpi_probe_volume *volume)
{
    *volume = header->volume;
    const alp_result result = fill_all(header, text, size, volume);
    if (result != ALP_OK) {
        alpi_probe_volume_destroy(volume);
    }
    return result;
}
