// SPDX-License-Identifier: MIT
// Probes for three.js: a KTX2 texture as LightProbeGrid (r184, r185) and LightProbeGridWebGL (r186
// and later) lay it out, and a module that loads it.
//
// The texture has nx × ny × 7 (nz + 2) texels of RGBA16F. Sub-volume t holds floats 4 t to 4 t + 3
// of the 27 of every probe, between copies of its first and its last slice. Up to r186 the
// outermost probes lie on the box, from r187 half a cell inside it; the module knows which one
// runs.
#include "formats/viewers/viewers.h"

#include "base/bytes.h"
#include "base/file_set.h"
#include "base/half.h"
#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/images/images.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

enum { VALUES = 27, CHANNELS = 4, SUB_VOLUMES = 7, HALF_SIZE = 2 };

typedef struct exporter {
    const alpi_probe_volume *volume;
    double scale;
    float (*light)[VALUES]; // [count] of each probe, times the scale
    uint32_t size[3];       // probes of the grid: at least two along each axis
    double first[3];        // the place of the first of them
    alpi_half_texture texture;
    uint8_t *bytes; // of the KTX2 file
    size_t bytes_size;
    char *texture_path;
    alpi_bytes module;
} exporter;

// --- light ---------------------------------------------------------------------------------------

static alp_result check_kind(const alpi_probe_volume *v, double scale)
{
    if (v->is_list || v->basis == ALPI_PROBE_AMBIENT_CUBE) {
        return alpi_fail(v->context, ALP_ERROR_UNSUPPORTED,
                         "three.js reads lattices of spherical harmonics, not %s: bake a lattice "
                         "with the basis sh9",
                         v->is_list ? "lists of probes" : "ambient cubes");
    }
    if (!(scale > 0.0 && isfinite(scale))) {
        return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                         "--export-scale %g: must be above 0", scale);
    }
    return ALP_OK;
}

static alp_result fill_light(exporter *e)
{
    const alpi_probe_volume *v = e->volume;
    const size_t width = (size_t)3 * v->coefficient_count; // with sh4 the others stay 0
    double most = 0.0;
    ALPI_TRY_NEW(v->context, e->light, v->count);
    for (size_t i = 0; i < width * v->count; i++) {
        const double value = (double)v->coefficients[i] * e->scale;
        if (!isfinite(value)) {
            return alpi_fail(v->context, ALP_ERROR_INVALID_ARGUMENT,
                             "probe %zu: a coefficient is no finite number", i / width);
        }
        e->light[i / width][i % width] = (float)value;
        most = fmax(most, fabs(value));
    }
    if (most > (double)ALPI_HALF_MAX) {
        const double fits = exp2(floor(log2((double)ALPI_HALF_MAX / most))) * e->scale;
        return alpi_fail(v->context, ALP_ERROR_LIMIT,
                         "a coefficient is %g, the half floats of three.js end at %g: give "
                         "--export-scale %g or less, and scale the other lights of the viewer "
                         "alike",
                         most, (double)ALPI_HALF_MAX, fits);
    }
    return ALP_OK;
}

// --- probes without light ------------------------------------------------------------------------

/// three.js interpolates between all probes of a cell: black ones inside solids would darken the
/// walls. They take light from their neighbours, nearest first.
static alp_result fill_dark_probes(exporter *e)
{
    return alpi_probe_volume_spread(e->volume, VALUES, e->light[0]);
}

// --- the texture ---------------------------------------------------------------------------------

/// A single probe along an axis becomes two, half a cell to either side: up to r186 three.js
/// divides by the number of cells between probes.
static void place_grid(exporter *e)
{
    const alpi_probe_volume *v = e->volume;
    for (int k = 0; k < 3; k++) {
        const bool single = v->size[k] == 1;
        e->size[k] = single ? 2 : v->size[k];
        e->first[k] = v->origin[k] - (single ? 0.5 * (double)v->spacing[k] : 0.0);
    }
}

static uint32_t clamp_index(uint32_t index, uint32_t count)
{
    return index < count ? index : count - 1;
}

static void put_slice(exporter *e, uint32_t sub_volume, uint32_t slice)
{
    const alpi_probe_volume *v = e->volume;
    const uint32_t z = clamp_index(slice > 0 ? slice - 1 : 0, v->size[2]);
    size_t at = (size_t)sub_volume * (e->size[2] + 2) + slice;
    at *= (size_t)e->size[0] * e->size[1] * CHANNELS * HALF_SIZE;
    for (uint32_t i = 0; i < e->size[0] * e->size[1]; i++) {
        const uint32_t x = clamp_index(i % e->size[0], v->size[0]);
        const uint32_t y = clamp_index(i / e->size[0], v->size[1]);
        const float *light = e->light[x + v->size[0] * (y + v->size[1] * z)];
        for (uint32_t k = 0; k < CHANNELS; k++, at += HALF_SIZE) {
            const uint32_t value = CHANNELS * sub_volume + k;
            const uint16_t half = alpi_half_from_float(value < VALUES ? light[value] : 0.0f);
            e->texture.texels[at] = (uint8_t)half;
            e->texture.texels[at + 1] = (uint8_t)(half >> 8);
        }
    }
}

static alp_result make_texture(exporter *e)
{
    alp_context *context = e->volume->context;
    place_grid(e);
    const uint64_t depth = SUB_VOLUMES * ((uint64_t)e->size[2] + 2);
    e->texture = (alpi_half_texture){
        .width = e->size[0], .height = e->size[1], .depth = (uint32_t)depth, .channels = CHANNELS};
    if (depth > UINT32_MAX || alpi_half_texture_size(&e->texture) == 0) {
        return alpi_fail(context, ALP_ERROR_LIMIT,
                         "%u x %u x %u probes make a texture that is too large", e->size[0],
                         e->size[1], e->size[2]);
    }
    ALPI_TRY_NEW(context, e->texture.texels, alpi_half_texture_size(&e->texture));
    for (uint32_t t = 0; t < SUB_VOLUMES; t++) {
        for (uint32_t slice = 0; slice < e->size[2] + 2; slice++) {
            put_slice(e, t, slice);
        }
    }
    return alpi_ktx2_write(context, &e->texture, true, &e->bytes, &e->bytes_size);
}

// --- the module ----------------------------------------------------------------------------------

static alp_result name_texture(exporter *e, const char *path)
{
    static const char *const endings[2] = {".mjs", ".js"};
    alp_context *context = e->volume->context;
    for (int i = 0; i < 2; i++) {
        if (alpi_path_has_ending(path, endings[i])) {
            const int stem = (int)(strlen(path) - strlen(endings[i]));
            e->texture_path = alpi_format(context, "%.*s.ktx2", stem, path);
            return e->texture_path != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                     "%s: probes for three.js are written as a module, .mjs or .js", path);
}

static void print_triple(alpi_bytes *text, const char *name, const double values[3])
{
    alpi_bytes_print(text, "%s = [", name);
    for (int k = 0; k < 3; k++) {
        alpi_bytes_print(text, "%s", k > 0 ? ", " : "");
        alpi_bytes_number(text, values[k], 12);
    }
    alpi_bytes_print(text, "]");
}

static void print_head(exporter *e)
{
    const float *s = e->volume->spacing;
    const double spacing[3] = {(double)s[0], (double)s[1], (double)s[2]};
    const double size[3] = {e->size[0], e->size[1], e->size[2]};
    alpi_bytes *text = &e->module;
    alpi_bytes_print(text, "// Light times ");
    alpi_bytes_number(text, e->scale, 17);
    alpi_bytes_print(text,
                     " for three.js r184 and later with WebGLRenderer. By Alpenglow %s.\n"
                     "// scene.add(await loadProbes(LightProbeGridWebGL, ktx2Loader, "
                     "THREE.REVISION)); r184, r185: LightProbeGrid\n",
                     alp_version());
    print_triple(text, "const size", size);
    print_triple(text, ", first", e->first);
    print_triple(text, ", spacing", spacing);
    alpi_bytes_print(text, ";\n");
}

static alp_result print_module(exporter *e)
{
    alp_context *context = e->volume->context;
    char *name = alpi_uri_encode(context, alpi_path_name(e->texture_path));
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    print_head(e);
    alpi_bytes_print(
        &e->module,
        "export async function loadProbes(Grid, loader, revision) {\n"
        "  const cells = size.map((n) => (parseInt(revision) < 187 ? n - 1 : n));\n"
        "  const grid = new Grid(...cells.map((n, k) => n * spacing[k]), ...size);\n"
        "  grid.position.set(...size.map((n, k) => first[k] + ((n - 1) / 2) * spacing[k]));\n"
        "  grid.texture = await loader.loadAsync(new URL('./%s', import.meta.url).href);\n"
        "  grid.texture.minFilter = grid.texture.magFilter = 1006; // LinearFilter, unlike the "
        "loader\n"
        "  grid.updateBoundingBox();\n"
        "  return grid;\n"
        "}\n",
        name);
    alpi_release(context, name);
    return e->module.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result make_files(exporter *e, const char *path, alpi_file_set *files)
{
    ALP_TRY(check_kind(e->volume, e->scale));
    ALP_TRY(name_texture(e, path));
    ALP_TRY(fill_light(e));
    ALP_TRY(fill_dark_probes(e));
    ALP_TRY(make_texture(e));
    ALP_TRY(print_module(e));
    ALP_TRY(alpi_file_set_add(files, e->texture_path, e->bytes, e->bytes_size));
    return alpi_file_set_add(files, path, e->module.bytes, e->module.size);
}

alp_result alpi_probes_export_three(const alpi_probe_volume *volume, const char *path, double scale,
                                    bool overwrite)
{
    alp_context *context = volume->context;
    alpi_file_set files = alpi_file_set_create(context, overwrite);
    exporter e = {.volume = volume, .scale = scale, .module = alpi_bytes_create(context)};
    const alp_result result = make_files(&e, path, &files);
    alpi_bytes_destroy(&e.module);
    alpi_release(context, e.light);
    alpi_release(context, e.texture.texels);
    alpi_release(context, e.bytes);
    alpi_release(context, e.texture_path);
    return alpi_file_set_end(&files, result);
}
