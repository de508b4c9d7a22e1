// SPDX-License-Identifier: MIT
// What a bake leaves on the disk: maps as EXR and PNG, and the patched asset.
#include "bake/job.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

enum { FILES_PER_PAGE = 2 }; // .exr and .png

/// "ao.exr", "ao.1.exr" …
static char *map_path(alp_context *context, const char *folder, uint32_t page, const char *ending)
{
    if (page == 0) {
        return alpi_format(context, "%s/ao%s", folder, ending);
    }
    return alpi_format(context, "%s/ao.%u%s", folder, page, ending);
}

static bool is_gltf_path(const char *path)
{
    return alpi_path_has_ending(path, ".glb") || alpi_path_has_ending(path, ".gltf");
}

static alp_result check_map(alp_context *context, const char *folder, uint32_t page,
                            const char *ending, bool overwrite)
{
    char *path = map_path(context, folder, page, ending);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_check_writable(context, path, overwrite);
    alpi_release(context, path);
    return result;
}

alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages)
{
    const alp_bake_options *o = &job->options;
    if (o->output != NULL) {
        if (!is_gltf_path(o->output)) {
            return alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                             "%s: only .glb and .gltf are written so far", o->output);
        }
        ALP_TRY(alpi_gltf_check_packed_output(job->scene, pages, job->packing.count, o->output,
                                              o->overwrite));
    }
    if (o->maps_folder != NULL) {
        ALP_TRY(alpi_folder_create(job->context, o->maps_folder));
        for (uint32_t p = 0; p < pages; p++) {
            ALP_TRY(check_map(job->context, o->maps_folder, p, ".exr", o->overwrite));
            ALP_TRY(check_map(job->context, o->maps_folder, p, ".png", o->overwrite));
        }
    }
    return ALP_OK;
}

// --- what made it --------------------------------------------------------------------------------

static const char *falloff_name(alp_falloff falloff)
{
    static const char *const names[] = {"none", "linear", "smooth", "exp"};
    return names[falloff];
}

static const char *atlas_name(alp_atlas_mode mode)
{
    return mode == ALP_ATLAS_KEEP ? "keep" : "charts";
}

/// The object that goes to asset.extras.alpenglow: version, options, quantity, input hash.
static char *make_extras(const alpi_bake_job *job)
{
    const alp_occlusion_options *ao = &job->options.occlusion;
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)job->scene->input_hash);
    json_t *distance = job->report.ao_distance < 1e30f ? json_real((double)job->report.ao_distance)
                                                       : json_string("inf");
    json_t *object = json_pack(
        "{s:s, s:s, s:{s:s, s:s, s:i, s:o, s:s, s:f, s:s, s:b, s:I, s:s, s:i, s:i, s:i}}",
        "version", alp_version(), "input_hash", hash, "occlusion", "quantity",
        "accessibility: 1 open, 0 closed", "unit", "1", "samples", (int)ao->samples, "distance_m",
        distance, "falloff", falloff_name(ao->falloff), "cone_rad", (double)ao->cone,
        "distribution", ao->distribution == ALP_DISTRIBUTION_COSINE ? "cosine" : "uniform",
        "one_sided", (int)ao->one_sided, "seed", (json_int_t)ao->seed, "atlas",
        atlas_name(job->report.atlas.mode), "size", (int)job->report.atlas.width, "pages",
        (int)job->report.atlas.pages, "padding", (int)job->options.atlas.padding);
    char *text = object ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    char *copy = text ? alpi_copy_string(job->context, text) : NULL;
    free(text);
    return copy;
}

// --- encoding ------------------------------------------------------------------------------------

typedef struct encoded_page {
    uint8_t *png, *exr;
    size_t png_size, exr_size;
} encoded_page;

static alp_result encode_page(const alpi_bake_job *job, uint32_t page, encoded_page *out)
{
    alp_image *image = NULL;
    ALP_TRY(alpi_lightmap_page_image(job->lightmap, page, ALP_COMPONENT_U8, &image));
    alp_result result = alpi_png_encode(image, &out->png, &out->png_size);
    alp_image_destroy(image);
    if (result != ALP_OK || job->options.maps_folder == NULL) {
        return result;
    }
    const alp_lightmap *l = job->lightmap; // encoded where it lies: a copy of it may be gigabytes
    const alp_image view = {.context = job->context,
                            .info = {l->width, l->height, 4, ALP_COMPONENT_FLOAT},
                            .pixels = l->pages[page]};
    return alpi_exr_encode(&view, &out->exr, &out->exr_size);
}

static alp_result append_map(const alpi_bake_job *job, uint32_t page, const char *ending,
                             const uint8_t *bytes, size_t size, alpi_file_writer *writer)
{
    char *path = map_path(job->context, job->options.maps_folder, page, ending);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_open(job->context, path, job->options.overwrite, writer);
    if (result == ALP_OK) {
        result = alpi_file_append(writer, bytes, size);
    }
    alpi_release(job->context, path);
    return result;
}

/// Writes every map to its temporary file; the caller commits or abandons the writers.
static alp_result append_maps(const alpi_bake_job *job, const encoded_page *pages,
                              alpi_file_writer *writers)
{
    for (uint32_t p = 0; p < job->lightmap->page_count; p++) {
        alpi_file_writer *w = writers + FILES_PER_PAGE * p;
        ALP_TRY(append_map(job, p, ".exr", pages[p].exr, pages[p].exr_size, w));
        ALP_TRY(append_map(job, p, ".png", pages[p].png, pages[p].png_size, w + 1));
    }
    return ALP_OK;
}

static alp_result write_asset(const alpi_bake_job *job, const encoded_page *pages)
{
    uint32_t count = job->lightmap->page_count;
    const uint8_t **pngs = ALPI_NEW(job->context, const uint8_t *, count);
    size_t *sizes = ALPI_NEW(job->context, size_t, count);
    const alpi_packing *packing = &job->packing;
    alpi_packed_image *packed = ALPI_NEW(job->context, alpi_packed_image, packing->count);
    char *extras = make_extras(job);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (pngs != NULL && sizes != NULL && packed != NULL && extras != NULL) {
        for (uint32_t i = 0; i < packing->count; i++) {
            const alpi_pack_target *target = &packing->targets[i];
            packed[i] = (alpi_packed_image){target->image, target->png, target->png_size};
        }
        for (uint32_t p = 0; p < count; p++) {
            pngs[p] = pages[p].png;
            sizes[p] = pages[p].png_size;
        }
        const alp_atlas *atlas = job->lightmap->atlas;
        bool keep = atlas->info.mode == ALP_ATLAS_KEEP;
        alpi_mesh_patch patch = {
            .page_count = count,
            .corner_uvs = keep ? NULL : (const float(*)[3][2])atlas->corner_uvs,
            .kept_uv_set = 1,
            .triangle_pages = atlas->triangle_pages,
            .page_pngs = pngs,
            .page_png_sizes = sizes,
            .existing_ao = job->options.existing_ao == ALP_EXISTING_AO_KEEP
                               ? ALPI_EXISTING_AO_KEEP
                               : ALPI_EXISTING_AO_REPLACE,
            .packed_count = packing->count,
            .packed_images = packed,
            .material_packed = packing->material_targets,
            .occlusion_strength = 1.0f,
            .extras_json = extras,
        };
        result = alpi_gltf_write_patched(job->scene, &patch, job->options.output,
                                         job->options.overwrite);
    }
    alpi_release(job->context, pngs);
    alpi_release(job->context, sizes);
    alpi_release(job->context, packed);
    alpi_release(job->context, extras);
    return result;
}

/// All maps to temporary files, then the asset, then the maps to their places.
static alp_result write_files(const alpi_bake_job *job, const encoded_page *pages)
{
    uint32_t count = job->options.maps_folder ? FILES_PER_PAGE * job->lightmap->page_count : 0;
    alpi_file_writer *writers = ALPI_NEW(job->context, alpi_file_writer, count);
    if (writers == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        writers[i] = (alpi_file_writer){.context = job->context, .descriptor = -1};
    }
    alp_result result = count > 0 ? append_maps(job, pages, writers) : ALP_OK;
    if (result == ALP_OK && job->options.output != NULL) {
        result = write_asset(job, pages);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (result == ALP_OK) {
            result = alpi_file_commit(&writers[i]);
        }
        alpi_file_abandon(&writers[i]);
    }
    alpi_release(job->context, writers);
    return result;
}

alp_result alpi_bake_write_outputs(alpi_bake_job *job)
{
    uint32_t count = job->lightmap->page_count;
    encoded_page *pages = ALPI_NEW(job->context, encoded_page, count);
    if (pages == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    for (uint32_t p = 0; p < count && result == ALP_OK; p++) {
        result = encode_page(job, p, &pages[p]);
    }
    if (result == ALP_OK) {
        result = write_files(job, pages);
    }
    for (uint32_t p = 0; p < count; p++) {
        alpi_release(job->context, pages[p].png);
        alpi_release(job->context, pages[p].exr);
    }
    alpi_release(job->context, pages);
    return result;
}
