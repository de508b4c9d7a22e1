// SPDX-License-Identifier: MIT
// Files of the layers of light: irradiance.NAME.exr, irradiance.NAME.1.exr …. The ending follows
// the format of the maps.
#include "bake/files/layer_files.h"

#include "bake/files/map_files.h"
#include "base/file.h"
#include "base/memory.h"

static bool is_written(const alpi_bake_job *job)
{
    return job->options.maps_folder != NULL && job->layers.light.count > 0;
}

static char *path_of(const alpi_bake_job *job, uint32_t layer, uint32_t page)
{
    const char *folder = job->options.maps_folder, *name = job->layers.names[layer];
    const char *ending = alpi_bake_map_ending(&job->options);
    return page == 0
               ? alpi_format(job->context, "%s/irradiance.%s%s", folder, name, ending)
               : alpi_format(job->context, "%s/irradiance.%s.%u%s", folder, name, page, ending);
}

static alp_result check_file(const alpi_bake_job *job, uint32_t layer, uint32_t page)
{
    char *path = path_of(job, layer, page);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result = alpi_file_check_writable(job->context, path, job->options.overwrite);
    alpi_release(job->context, path);
    return result;
}

alp_result alpi_bake_check_layer_files(const alpi_bake_job *job, uint32_t pages)
{
    for (uint32_t i = 0; is_written(job) && i < job->layers.light.count; i++) {
        for (uint32_t p = 0; p < pages; p++) {
            ALP_TRY(check_file(job, i, p));
        }
    }
    return ALP_OK;
}

static alp_result add_page(const alpi_bake_job *job, uint32_t layer, uint32_t page,
                           alpi_file_set *files)
{
    const alp_lightmap *l = job->lightmap;
    const alp_image view = {.context = job->context,
                            .info = {l->width, l->height, 4, ALP_COMPONENT_FLOAT},
                            .pixels = l->layer_pages[layer][page]};
    alpi_map_file file = {0};
    char *path = path_of(job, layer, page);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_bake_encode_map(job, &view, job->layers.names[layer], page, &file);
    if (result == ALP_OK) {
        result = alpi_file_set_add(files, path, file.bytes, file.size);
    }
    alpi_release(job->context, file.bytes);
    alpi_release(job->context, path);
    return result;
}

alp_result alpi_bake_add_layers(const alpi_bake_job *job, alpi_file_set *files)
{
    const uint32_t pages = job->lightmap->page_count;
    const uint32_t count = is_written(job) ? job->layers.light.count * pages : 0;
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(add_page(job, i / pages, i % pages, files));
    }
    return ALP_OK;
}
