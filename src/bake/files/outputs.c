// SPDX-License-Identifier: MIT
// What a bake leaves on the disk: maps as PNG and as what is asked for, and the patched asset.
#include "bake/layers.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"
#include "transport/occlusion/falloff.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// What a page leaves in the maps folder.
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
    alp_map map;               // that must be asked for
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

static bool is_gltf_path(const char *path)
{
    return alpi_path_has_ending(path, ".glb") || alpi_path_has_ending(path, ".gltf");
}

bool alpi_bake_exports(const alpi_bake_job *job)
{
    const char *output = job->options.output;
    const alpi_attachment *from = job->scene->attachments;
    if (output == NULL) {
        return false;
    }
    return alpi_path_has_ending(output, ".dae")
               ? from[ALPI_ATTACHMENT_COLLADA].data == NULL
               : !is_gltf_path(output) || from[ALPI_ATTACHMENT_DOCUMENT].data == NULL;
}

/// An OBJ holds occlusion maps, and light as emission.
static alp_result check_obj_options(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const char *what =
        o->atlas.mode == ALP_ATLAS_VERTEX  ? "values at vertices"
        : o->atlas.mode == ALP_ATLAS_BLEND ? "three coordinate sets"
        : job->packing.count > 0           ? "occlusion packed into an image"
        : o->lightmap_as == ALP_LIGHTMAP_AS_MOZ || o->lightmap_as == ALP_LIGHTMAP_AS_EXTRAS
            ? "a light map other than emission"
            : NULL;
    return what == NULL
               ? ALP_OK
               : alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                           "%s: an .obj has no place for %s; write .glb or .gltf", o->output, what);
}

/// A COLLADA document holds maps of occlusion, and light as emission.
static alp_result check_dae_options(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const bool lit_otherwise =
        o->lightmap_as != ALP_LIGHTMAP_AS_NONE && o->lightmap_as != ALP_LIGHTMAP_AS_EMISSIVE;
    const char *what = o->atlas.mode == ALP_ATLAS_VERTEX ? "values at vertices"
                       : o->ao_into == ALP_AO_INTO_ORM   ? "occlusion packed into an image"
                       : lit_otherwise                   ? "a light map other than emission"
                                                         : NULL;
    return what == NULL
               ? ALP_OK
               : alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                           "%s: a .dae has no place for %s; write .glb or .gltf", o->output, what);
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
    if (alpi_path_has_ending(o->output, ".obj")) {
        ALP_TRY(check_obj_options(job));
    } else if (alpi_path_has_ending(o->output, ".dae")) {
        ALP_TRY(check_dae_options(job));
    } else if (!is_gltf_path(o->output)) {
        return alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                         "%s: only .glb, .gltf, .dae and .obj are written so far", o->output);
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

alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages)
{
    const alp_bake_options *o = &job->options;
    ALP_TRY(alpi_bake_check_output(job, pages));
    if (o->maps_folder != NULL) {
        ALP_TRY(alpi_folder_create(job->context, o->maps_folder));
        ALP_TRY(alpi_bake_check_layer_files(job, pages));
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

// --- what made it --------------------------------------------------------------------------------

static const char *atlas_name(alp_atlas_mode mode)
{
    return mode == ALP_ATLAS_KEEP     ? "keep"
           : mode == ALP_ATLAS_VERTEX ? "vertex"
           : mode == ALP_ATLAS_BLEND  ? "blend"
                                      : "charts";
}

/// Values at vertices have an attribute instead of pages.
static void replace_pages(const alpi_bake_job *job, json_t *occlusion)
{
    bool in_color = job->options.vertex_attribute == ALP_VERTEX_COLOR;
    json_object_del(occlusion, "size");
    json_object_del(occlusion, "pages");
    json_object_del(occlusion, "padding");
    json_object_del(occlusion, "stated_relative_error"); // none is stated
    json_object_del(occlusion, "cut_off");
    json_object_set_new(occlusion, "vertex_attribute",
                        json_string(in_color ? "COLOR_0" : "_OCCLUSION"));
}

/// A name of the scene, which arrays may give in any bytes.
static json_t *name_text(const char *name)
{
    json_t *text = json_string(name);
    return text != NULL ? text : json_string("(no UTF-8)");
}

/// What was baked and what it saw, where that is not everything.
static void add_choice(const alpi_bake_job *job, json_t *object)
{
    const alp_bake_options *o = &job->options;
    if (o->ao_self) {
        json_object_set_new(object, "self", json_true());
    }
    if (o->occluders != NULL) {
        json_object_set_new(object, "occluders", name_text(o->occluders));
    }
    if (job->only == NULL) {
        return;
    }
    json_t *names = json_array();
    const char *last = NULL;
    for (uint32_t s = 0; s < job->scene->surface_count; s++) {
        const char *name = job->scene->surfaces[s].name;
        if (job->only[s] && (last == NULL || strcmp(last, name) != 0)) { // primitives of one node
            json_array_append_new(names, name_text(name));
            last = name;
        }
    }
    json_object_set_new(object, "only", name_text(o->only));
    json_object_set_new(object, "surfaces", names);
}

/// The distance limit: metres, "inf", or what it is of each object.
static json_t *distance_value(const alpi_bake_job *job)
{
    if (job->options.ao_self && job->options.occlusion.distance == 0.0f) {
        return json_string("0.2 of each object's diagonal");
    }
    return job->report.ao_distance < 1e30f ? json_real((double)job->report.ao_distance)
                                           : json_string("inf");
}

/// How texels were chosen and when sampling was to stop; `occlusion` may be NULL.
static void add_sampling(const alpi_bake_job *job, json_t *occlusion)
{
    static const char *const existing[] = {"replace", "multiply", "keep"};
    static const char *const into[] = {"separate", "orm"};
    const alp_sampling_options *s = &job->options.sampling;
    json_object_set_new(occlusion, "adaptive",
                        s->accuracy == ALP_ADAPTIVE_AUTO  ? json_string("auto")
                        : s->accuracy == ALP_ADAPTIVE_OFF ? json_string("off")
                                                          : json_real((double)s->accuracy));
    if (s->error > 0.0f) {
        json_object_set_new(occlusion, "wanted_relative_error", json_real((double)s->error));
    }
    json_object_set_new(occlusion, "existing_ao", json_string(existing[job->options.existing_ao]));
    const bool packed = job->packing.count > 0; // asked for, and there is an image that holds it
    json_object_set_new(occlusion, "ao_into",
                        json_string(into[packed ? ALP_AO_INTO_ORM : ALP_AO_INTO_SEPARATE]));
}

/// Light that the asset carries.
static json_t *describe_light(const alpi_bake_job *job)
{
    static const char *const names[] = {[ALP_LIGHTMAP_AS_EMISSIVE] = "emissive",
                                        [ALP_LIGHTMAP_AS_MOZ] = "moz",
                                        [ALP_LIGHTMAP_AS_EXTRAS] = "extras"};
    static const char *const gatherers[] = {[ALP_GATHER_RAYS] = "rays",
                                            [ALP_GATHER_HEMICUBE] = "hemicube",
                                            [ALP_GATHER_PATHS] = "paths"};
    const alp_bake_options *o = &job->options;
    const alp_bake_report *r = &job->report;
    const char *units = alpi_bake_light_units(o);
    json_t *object = json_pack(
        "{s:s, s:s, s:s, s:f, s:s, s:s, s:i, s:o, s:b, s:I, s:o, s:s, s:i, s:i, s:i}", "as",
        names[o->lightmap_as], "units", units, "unit",
        strcmp(units, "irradiance") == 0 ? "W/m2" : "W/(sr m2)", "largest_scale",
        (double)job->light_asset.scale, "gather", gatherers[o->light.gather], "direct",
        o->light.direct == ALP_DIRECT_OFF ? "off" : "on", "samples", (int)r->light_samples,
        "bounces",
        o->light.bounces == ALP_BOUNCES_CONVERGE ? json_string("converge")
                                                 : json_integer((json_int_t)o->light.bounces),
        "one_sided", (int)o->occlusion.one_sided, "seed", (json_int_t)o->occlusion.seed,
        "stated_relative_error",
        isfinite(r->light_relative_error) ? json_real(r->light_relative_error) : json_null(),
        "atlas", atlas_name(r->atlas.mode), "size", (int)r->atlas.width, "pages",
        (int)r->atlas.pages, "padding", (int)o->atlas.padding);
    if (o->light.emitters == ALP_EMITTERS_COUNTED) {
        json_object_set_new(object, "emitters", json_string("counted"));
    }
    if (r->light_direct) {
        json_object_del(object, "gather"); // nothing was
    }
    return object;
}

/// Version, options, quantity, input hash.
char *alpi_bake_make_extras(const alpi_bake_job *job)
{
    const alp_occlusion_options *ao = &job->options.occlusion;
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)job->scene->input_hash);
    json_t *object = json_pack(
        "{s:s, s:s, s:{s:s, s:s, s:i, s:o, s:s, s:f, s:s, s:b, s:I, s:o, s:b, s:s, s:i, s:i, s:i}}",
        "version", alp_version(), "input_hash", hash, "occlusion", "quantity",
        "accessibility: 1 open, 0 closed", "unit", "1", "samples", (int)job->report.ao_samples,
        "distance_m", distance_value(job), "falloff", alpi_falloff_name(ao->falloff), "cone_rad",
        (double)ao->cone, "distribution",
        ao->distribution == ALP_DISTRIBUTION_COSINE ? "cosine" : "uniform", "one_sided",
        (int)ao->one_sided, "seed", (json_int_t)ao->seed, "stated_relative_error",
        isfinite(job->report.ao_relative_error) ? json_real(job->report.ao_relative_error)
                                                : json_null(),
        "cut_off", (int)job->report.cut_off, "atlas", atlas_name(job->report.atlas.mode), "size",
        (int)job->report.atlas.width, "pages", (int)job->report.atlas.pages, "padding",
        (int)job->options.atlas.padding);
    add_sampling(job, json_object_get(object, "occlusion"));
    add_choice(job, object); // jansson takes NULL and does nothing
    if ((job->options.maps & ALP_MAP_AO) == 0) {
        json_object_del(object, "occlusion");
    }
    if (job->options.lightmap_as != ALP_LIGHTMAP_AS_NONE) {
        json_object_set_new(object, "light", describe_light(job));
    }
    if (job->report.atlas.mode == ALP_ATLAS_BLEND) { // which sets: said where they are
        json_object_set_new(
            object, "blend",
            json_pack("{s:i, s:s, s:s}", "sets", 3, "weights", "n*n", "frame", "object"));
    }
    if (job->options.atlas.mode == ALP_ATLAS_VERTEX) {
        replace_pages(job, json_object_get(object, "occlusion"));
    }
    char *text = object ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    char *copy = text ? alpi_copy_string(job->context, text) : NULL;
    free(text);
    return copy;
}

// --- encoding ------------------------------------------------------------------------------------

/// The files of one page, as bytes. Without a maps folder only the PNG.
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
    if (pages != NULL) { // encoded where it lies: a copy of it may be gigabytes
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
                                        .units = alpi_bake_light_units(&job->options)};
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
    if (job->options.output == NULL) {
        return ALP_OK;
    }
    return alpi_bake_is_viewer_file(&job->options) ? alpi_bake_add_viewer_file(job, files)
                                                   : add_asset(job, pages, files);
}

/// All of them beside their places, then all to their places.
static alp_result write_files(const alpi_bake_job *job, const encoded_page *pages)
{
    alpi_file_set files = alpi_file_set_create(job->context, job->options.overwrite);
    return alpi_file_set_end(&files, add_files(job, pages, &files));
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
        for (int kind = 0; kind < MAP_COUNT; kind++) {
            alpi_release(job->context, pages[p].files[kind].bytes);
        }
    }
    alpi_release(job->context, pages);
    return result;
}
