// SPDX-License-Identifier: MIT
// The files of a bake: maps as PNG and in the format asked for, and the patched asset.
#include "bake/files/outputs.h"

#include "bake/files/extras.h"
#include "bake/files/layer_files.h"
#include "bake/files/light_units.h"
#include "bake/files/map_files.h"
#include "bake/files/pack_orm.h"
#include "bake/files/viewer_file.h"
#include "bake/settings.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "base/tiles/rank_calls.h"
#include "fields/probes/probes.h"
#include "formats/formats.h"

#include <stdio.h>

/// The files of a page in the maps folder.
typedef enum map_kind {
    MAP_AO_PNG,
    MAP_AO,
    MAP_ERROR,
    MAP_SAMPLING,
    MAP_BENT_PNG,
    MAP_BENT,
    MAP_OBSCURANCE_PNG,
    MAP_OBSCURANCE,
    MAP_IRRADIANCE,
    MAP_IRRADIANCE_ERROR,
    MAP_DIRECT,
    MAP_BOUNCED,
    MAP_SH_0,
    MAP_SH_1,
    MAP_SH_2,
    MAP_SH_3,
    MAP_DIRECTION,
    MAP_COUNT
} map_kind;

static const struct {
    alp_map map;               // that the options must ask for
    const char *name, *ending; // NULL: as the format of the maps has it
} map_files[MAP_COUNT] = {[MAP_AO_PNG] = {ALP_MAP_AO, "ao", ".png"},
                          [MAP_AO] = {ALP_MAP_AO, "ao", NULL},
                          [MAP_ERROR] = {ALP_MAP_AO, "ao.error", NULL},
                          [MAP_SAMPLING] = {ALP_MAP_AO, "ao.sampling", ".png"},
                          [MAP_BENT_PNG] = {ALP_MAP_BENT, "bent", ".png"},
                          [MAP_BENT] = {ALP_MAP_BENT, "bent", NULL},
                          [MAP_OBSCURANCE_PNG] = {ALP_MAP_OBSCURANCE, "obscurance", ".png"},
                          [MAP_OBSCURANCE] = {ALP_MAP_OBSCURANCE, "obscurance", NULL},
                          [MAP_IRRADIANCE] = {ALP_MAP_LIGHT, "irradiance", NULL},
                          [MAP_IRRADIANCE_ERROR] = {ALP_MAP_LIGHT, "irradiance.error", NULL},
                          [MAP_DIRECT] = {ALP_MAP_DIRECT, "irradiance.direct", NULL},
                          [MAP_BOUNCED] = {ALP_MAP_BOUNCED, "irradiance.bounced", NULL},
                          [MAP_SH_0] = {ALP_MAP_SH, "sh.0", NULL},
                          [MAP_SH_1] = {ALP_MAP_SH, "sh.1", NULL},
                          [MAP_SH_2] = {ALP_MAP_SH, "sh.2", NULL},
                          [MAP_SH_3] = {ALP_MAP_SH, "sh.3", NULL},
                          [MAP_DIRECTION] = {ALP_MAP_DIRECTION, "direction", NULL}};

/// Whether a file of this kind goes to the maps folder.
static bool is_written(const alp_bake_options *options, int kind)
{
    return options->maps_folder != NULL && (options->maps & (unsigned)map_files[kind].map) != 0;
}

/// "ao.exr", "ao.1.exr" …
static char *map_path(const alpi_bake_job *job, uint32_t page, map_kind kind)
{
    const char *name = map_files[kind].name, *ending = map_files[kind].ending;
    const char *folder = job->options.maps_folder;
    ending = ending != NULL ? ending : alpi_bake_map_ending(&job->options);
    if (page == 0) {
        return alpi_format(job->context, "%s/%s%s", folder, name, ending);
    }
    return alpi_format(job->context, "%s/%s.%u%s", folder, name, page, ending);
}

static alp_result check_map(const alpi_bake_job *job, uint32_t page, map_kind kind)
{
    char *path = map_path(job, page, kind);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_check_writable(job->context, path, job->options.overwrite);
    alpi_release(job->context, path);
    return result;
}

alp_result alpi_bake_check_output(const alpi_bake_job *job, uint32_t pages)
{
    const alp_bake_options *o = &job->options;
    if (o->output == NULL) {
        return ALP_OK;
    }
    if (alpi_bake_is_viewer_file(o)) {
        return alpi_bake_check_viewer_file(job, pages);
    }
    const bool lit = o->lightmap_as != ALP_LIGHTMAP_AS_NONE;
    const alpi_output_images images = {
        .occlusion = (o->maps & ALP_MAP_AO) != 0 ? pages : 0,
        .packed = job->packing.count,
        .light = lit ? pages : 0,
        .light_ending = lit ? alpi_bake_light_ending(o) : NULL,
        .light_is_beside = o->lightmap_as == ALP_LIGHTMAP_AS_EXTRAS,
    };
    return alpi_scene_check_outputs(job->scene, &images, o->output, o->overwrite);
}

/// "scene.probes.json" in the maps folder.
static char *probes_path(const alpi_bake_job *job)
{
    return alpi_format(job->context, "%s/scene.probes.json", job->options.maps_folder);
}

static alp_result check_probes(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if ((o->maps & ALP_MAP_PROBES) == 0) {
        return ALP_OK;
    }
    char *path = probes_path(job);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const bool moments = o->probes == NULL || o->probes->visibility;
    const alp_result result = alpi_probes_check_outputs(job->context, path, moments, o->overwrite);
    alpi_release(job->context, path);
    return result;
}

static alp_result add_probes(const alpi_bake_job *job, alpi_file_set *files)
{
    if (job->probes == NULL) {
        return ALP_OK;
    }
    char *path = probes_path(job);
    const alp_result result = path != NULL
                                  ? alpi_probes_add_files(&job->probes->volume, path, files)
                                  : ALP_ERROR_OUT_OF_MEMORY;
    alpi_release(job->context, path);
    return result;
}

alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages)
{
    const alp_bake_options *o = &job->options;
    if (!alpi_ranks_write(job->context)) {
        return ALP_OK;
    }
    ALP_TRY(alpi_bake_check_output(job, pages));
    if (o->maps_folder != NULL) {
        ALP_TRY(alpi_folder_create(job->context, o->maps_folder));
        ALP_TRY(alpi_bake_check_layer_files(job, pages));
        ALP_TRY(check_probes(job));
        for (uint32_t p = 0; p < pages; p++) {
            for (int kind = 0; kind < MAP_COUNT; kind++) {
                if (is_written(o, kind)) {
                    ALP_TRY(check_map(job, p, (map_kind)kind));
                }
            }
        }
    }
    return ALP_OK;
}

// --- encoding ------------------------------------------------------------------------------------

/// The encoded files of one page. Without a maps folder only the PNG of occlusion.
typedef struct encoded_page {
    alpi_map_file files[MAP_COUNT];
} encoded_page;

static alp_result make_image(const alpi_bake_job *job, uint32_t page, map_kind kind,
                             alp_image **image)
{
    const alp_lightmap *l = job->lightmap;
    switch (kind) {
    case MAP_BENT_PNG:
        return alpi_lightmap_rgb_image(l, l->bent_pages[page], 0.5f, 0.5f, image);
    case MAP_OBSCURANCE_PNG:
        return alpi_lightmap_rgb_image(l, l->obscurance_pages[page], 1.0f, 0.0f, image);
    case MAP_ERROR:
        return alpi_lightmap_error_image(l, page, image);
    case MAP_SAMPLING:
        return alpi_lightmap_sampling_image(l, page, image);
    default:
        return alpi_lightmap_page_image(l, page, ALP_COMPONENT_U8, image);
    }
}

static alp_result encode_map(const alpi_bake_job *job, uint32_t page, map_kind kind,
                             alpi_map_file *file)
{
    const alp_lightmap *l = job->lightmap;
    const bool is_sh = kind >= MAP_SH_0 && kind <= MAP_SH_3;
    float *const *pages = kind == MAP_AO                 ? l->pages
                          : kind == MAP_BENT             ? l->bent_pages
                          : kind == MAP_OBSCURANCE       ? l->obscurance_pages
                          : kind == MAP_IRRADIANCE       ? l->irradiance_pages
                          : kind == MAP_IRRADIANCE_ERROR ? l->irradiance_error_pages
                          : kind == MAP_DIRECT           ? l->direct_pages
                          : kind == MAP_BOUNCED          ? l->bounced_pages
                          : is_sh                        ? l->sh_pages[kind - MAP_SH_0]
                          : kind == MAP_DIRECTION        ? l->direction_pages
                                                         : NULL;
    if (pages != NULL) { // encoded in place: a copy may take gigabytes
        const alp_image view = {.context = job->context,
                                .info = {l->width, l->height, 4, ALP_COMPONENT_FLOAT},
                                .pixels = pages[page]};
        return alpi_bake_encode_map(job, &view, map_files[kind].name, page, file);
    }
    alp_image *image = NULL;
    ALP_TRY(make_image(job, page, kind, &image));
    alp_result result = image->info.component == ALP_COMPONENT_FLOAT
                            ? alpi_bake_encode_map(job, image, map_files[kind].name, page, file)
                            : alpi_png_encode(image, &file->bytes, &file->size);
    alp_image_destroy(image);
    return result;
}

static alp_result encode_page(const alpi_bake_job *job, uint32_t page, encoded_page *out)
{
    for (int kind = 0; kind < MAP_COUNT; kind++) {
        const bool attached = kind == MAP_AO_PNG && job->options.output != NULL &&
                              (job->options.maps & ALP_MAP_AO) != 0;
        if (attached || is_written(&job->options, kind)) {
            ALP_TRY(encode_map(job, page, (map_kind)kind, &out->files[kind]));
        }
    }
    return ALP_OK;
}

static alp_result add_map(const alpi_bake_job *job, uint32_t page, map_kind kind,
                          const alpi_map_file *encoded, alpi_file_set *files)
{
    char *path = map_path(job, page, kind);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_set_add(files, path, encoded->bytes, encoded->size);
    alpi_release(job->context, path);
    return result;
}

static alp_result add_maps(const alpi_bake_job *job, const encoded_page *pages,
                           alpi_file_set *files)
{
    for (uint32_t p = 0; p < job->lightmap->page_count; p++) {
        for (int kind = 0; kind < MAP_COUNT; kind++) {
            if (is_written(&job->options, kind)) {
                ALP_TRY(add_map(job, p, (map_kind)kind, &pages[p].files[kind], files));
            }
        }
    }
    return ALP_OK;
}

static alpi_light_form light_form(alp_lightmap_as as)
{
    return as == ALP_LIGHTMAP_AS_MOZ      ? ALPI_LIGHT_FORM_MOZ
           : as == ALP_LIGHTMAP_AS_EXTRAS ? ALPI_LIGHT_FORM_EXTRAS
                                          : ALPI_LIGHT_FORM_EMISSIVE;
}

static alp_result add_asset(const alpi_bake_job *job, const encoded_page *pages,
                            alpi_file_set *files)
{
    uint32_t count = job->lightmap->page_count;
    const uint8_t **pngs = ALPI_NEW(job->context, const uint8_t *, count);
    size_t *sizes = ALPI_NEW(job->context, size_t, count);
    const alpi_packing *packing = &job->packing;
    alpi_packed_image *packed = ALPI_NEW(job->context, alpi_packed_image, packing->count);
    char *extras = alpi_bake_make_extras(job);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (pngs != NULL && sizes != NULL && packed != NULL && extras != NULL) {
        for (uint32_t i = 0; i < packing->count; i++) {
            const alpi_pack_target *target = &packing->targets[i];
            packed[i] = (alpi_packed_image){target->image, target->png, target->png_size};
        }
        for (uint32_t p = 0; p < count; p++) {
            pngs[p] = pages[p].files[MAP_AO_PNG].bytes;
            sizes[p] = pages[p].files[MAP_AO_PNG].size;
        }
        const alpi_light_patch light = {.form = light_form(job->options.lightmap_as),
                                        .pages = (const uint8_t *const *)job->light_asset.files,
                                        .page_sizes = job->light_asset.file_sizes,
                                        .ending = alpi_bake_light_ending(&job->options),
                                        .scales = job->light_asset.scales,
                                        .units = alpi_bake_light_units_name(&job->options)};
        const alp_atlas *atlas = job->lightmap->atlas;
        bool keep = atlas->info.mode == ALP_ATLAS_KEEP;
        alpi_mesh_patch patch = {
            .page_count = count,
            .corner_uvs = keep ? NULL : (const float(*)[3][2])atlas->corner_uvs,
            .kept_uv_set = 1,
            .set_uvs = (const float(*)[3][3][2])atlas->set_uvs,
            .triangle_pages = atlas->triangle_pages,
            .originals = job->originals,
            .page_pngs = (job->options.maps & ALP_MAP_AO) != 0 ? pngs : NULL,
            .page_png_sizes = sizes,
            .light = job->light_asset.files != NULL ? &light : NULL,
            .existing_ao = job->options.existing_ao == ALP_EXISTING_AO_KEEP
                               ? ALPI_EXISTING_AO_KEEP
                               : ALPI_EXISTING_AO_REPLACE,
            .packed_count = packing->count,
            .packed_images = packed,
            .material_packed = packing->material_targets,
            .occlusion_strength = 1.0f,
            .extras_json = extras,
        };
        result = alpi_scene_add_patched(job->scene, &patch, job->options.output, files);
    }
    alpi_release(job->context, pngs);
    alpi_release(job->context, sizes);
    alpi_release(job->context, packed);
    alpi_release(job->context, extras);
    return result;
}

static alp_result add_files(const alpi_bake_job *job, const encoded_page *pages,
                            alpi_file_set *files)
{
    ALP_TRY(add_maps(job, pages, files));
    ALP_TRY(alpi_bake_add_layers(job, files));
    ALP_TRY(add_probes(job, files));
    if (job->options.output == NULL) {
        return ALP_OK;
    }
    return alpi_bake_is_viewer_file(&job->options) ? alpi_bake_add_viewer_file(job, files)
                                                   : add_asset(job, pages, files);
}

/// Writes all files beside their places, then moves all to their places.
static alp_result write_files(const alpi_bake_job *job, const encoded_page *pages)
{
    alpi_file_set files = alpi_file_set_create(job->context, job->options.overwrite);
    return alpi_file_set_end(&files, add_files(job, pages, &files));
}

static alp_result write_outputs(const alpi_bake_job *job)
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
        for (int kind = 0; kind < MAP_COUNT; kind++) {
            alpi_release(job->context, pages[p].files[kind].bytes);
        }
    }
    alpi_release(job->context, pages);
    return result;
}

alp_result alpi_bake_write(alpi_bake_job *job)
{
    const double started = alpi_seconds();
    if (!alpi_ranks_write(job->context)) {
        return ALP_OK;
    }
    ALP_TRY(alpi_bake_begin_stage(job, "write"));
    ALP_TRY(alpi_bake_pack_images(job));
    ALP_TRY(alpi_bake_make_light_asset(job));
    ALP_TRY(write_outputs(job));
    job->report.seconds_write = alpi_seconds() - started;
    return ALP_OK;
}
