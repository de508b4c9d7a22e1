// SPDX-License-Identifier: MIT
// Writes the scene with its light as a viewer's own file, .json or .babylon, in place of an asset.
#include "bake/files/viewer_file.h"

#include "bake/settings.h"
#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <string.h>

/// "dir/a.babylon" → "dir/a.hdr", "dir/a.1.hdr" …
static char *page_path(alp_context *context, const alp_bake_options *options, uint32_t page)
{
    const int stem = (int)(strlen(options->output) - strlen(alpi_bake_viewer_ending(options)));
    return page == 0 ? alpi_format(context, "%.*s.hdr", stem, options->output)
                     : alpi_format(context, "%.*s.%u.hdr", stem, options->output, page);
}

/// Number of pictures beside the file.
static uint32_t beside_count(const alp_bake_options *options, uint32_t pages)
{
    return options->lightmap_as == ALP_LIGHTMAP_AS_BABYLON ? pages : 0;
}

alp_result alpi_bake_check_viewer_file(const alpi_bake_job *job, uint32_t pages)
{
    const alp_bake_options *o = &job->options;
    ALP_TRY(alpi_file_check_writable(job->context, o->output, o->overwrite));
    for (uint32_t p = 0; p < beside_count(o, pages); p++) {
        char *path = page_path(job->context, o, p);
        if (path == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        const alp_result result = alpi_file_check_writable(job->context, path, o->overwrite);
        alpi_release(job->context, path);
        ALP_TRY(result);
    }
    return ALP_OK;
}

static alpi_light_pages light_pages(const alpi_bake_job *job)
{
    const alp_lightmap *l = job->lightmap;
    return (alpi_light_pages){.page_count = l->page_count,
                              .width = l->width,
                              .height = l->height,
                              .corner_uvs = (const float(*)[3][2])l->atlas->corner_uvs,
                              .triangle_pages = l->atlas->triangle_pages,
                              .pages = (const float *const *)l->irradiance_pages,
                              .irradiance_per_unit = 1.0f};
}

static alp_result add_page(const alpi_bake_job *job, const alpi_light_pages *light, uint32_t page,
                           const char *path, alpi_file_set *files)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    ALP_TRY(alpi_babylon_encode_page(job->scene, light, page, &bytes, &size));
    const alp_result result = alpi_file_set_add(files, path, bytes, size);
    alpi_release(job->context, bytes);
    return result;
}

/// Adds the pictures first, then the file that names them.
static alp_result add_all(const alpi_bake_job *job, char **paths, const char **names,
                          alpi_file_set *files)
{
    const alp_bake_options *o = &job->options;
    const alpi_light_pages light = light_pages(job);
    uint8_t *bytes = NULL;
    size_t size = 0;
    for (uint32_t p = 0; p < beside_count(o, light.page_count); p++) {
        paths[p] = page_path(job->context, o, p);
        if (paths[p] == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        names[p] = alpi_path_name(paths[p]);
    }
    ALP_TRY(o->lightmap_as == ALP_LIGHTMAP_AS_THREE
                ? alpi_three_encode(job->scene, &light, &bytes, &size)
                : alpi_babylon_encode(job->scene, &light, names, &bytes, &size));
    alp_result result = ALP_OK;
    for (uint32_t p = 0; p < beside_count(o, light.page_count) && result == ALP_OK; p++) {
        result = add_page(job, &light, p, paths[p], files);
    }
    if (result == ALP_OK) {
        result = alpi_file_set_add(files, o->output, bytes, size);
    }
    alpi_release(job->context, bytes);
    return result;
}

alp_result alpi_bake_add_viewer_file(const alpi_bake_job *job, alpi_file_set *files)
{
    const uint32_t pages = job->lightmap->page_count;
    char **paths = ALPI_NEW(job->context, char *, pages);
    const char **names = ALPI_NEW(job->context, const char *, pages);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (paths != NULL && names != NULL) {
        result = add_all(job, paths, names, files);
    }
    for (uint32_t p = 0; paths != NULL && p < pages; p++) {
        alpi_release(job->context, paths[p]);
    }
    alpi_release(job->context, paths);
    alpi_release(job->context, names);
    return result;
}
