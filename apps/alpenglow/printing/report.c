// SPDX-License-Identifier: MIT
// The --json report of a bake.
#include "printing/report.h"

#include "output.h"
#include "printing/findings.h"

#include <math.h>
#include <stdlib.h>

/// Bounds of one surface on one page, in texture coordinates.
typedef struct rectangle {
    bool used;
    float u0, v0, u1, v1;
} rectangle;

static void grow(rectangle *r, const float uvs[6])
{
    if (!r->used) {
        *r = (rectangle){true, INFINITY, INFINITY, -INFINITY, -INFINITY};
    }
    for (int corner = 0; corner < 3; corner++) {
        r->u0 = fminf(r->u0, uvs[2 * corner]);
        r->u1 = fmaxf(r->u1, uvs[2 * corner]);
        r->v0 = fminf(r->v0, uvs[2 * corner + 1]);
        r->v1 = fmaxf(r->v1, uvs[2 * corner + 1]);
    }
}

static json_t *make_object(const alp_surface_info *surface, uint32_t page, uint32_t uv_set,
                           const rectangle *r)
{
    return json_pack("{s:o, s:I, s:I, s:[o, o, o, o]}", "name", json_text(surface->name), "page",
                     (json_int_t)page, "uv_set", (json_int_t)uv_set, "rectangle",
                     json_number((double)r->u0), json_number((double)r->v0),
                     json_number((double)r->u1), json_number((double)r->v1));
}

/// One entry for every page that the surface has triangles on. `pages` is scratch, all unused.
static void add_surface(json_t *objects, const alp_atlas *atlas, const alp_surface_info *surface,
                        rectangle *pages)
{
    alp_atlas_info info = alp_atlas_get_info(atlas);
    const float *uvs = alp_atlas_corner_uvs(atlas);
    const uint32_t *triangle_pages = alp_atlas_triangle_pages(atlas);
    // Charts go into the first free set; keep uses the second set.
    uint32_t uv_set = info.mode == ALP_ATLAS_KEEP ? 1 : surface->uv_sets;
    uint32_t first = info.pages, last = 0;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        uint32_t triangle = surface->first_triangle + i, page = triangle_pages[triangle];
        if (page < info.pages) {
            grow(&pages[page], &uvs[(size_t)triangle * 6]);
            first = page < first ? page : first;
            last = page > last ? page : last;
        }
    }
    for (uint32_t page = first; page <= last && page < info.pages; page++) {
        if (pages[page].used) {
            json_array_append_new(objects, make_object(surface, page, uv_set, &pages[page]));
            pages[page].used = false;
        }
    }
}

/// Without an atlas: number of values of each surface.
static json_t *make_vertex_objects(const alp_scene *scene, const alp_lightmap *lightmap)
{
    json_t *objects = json_array();
    uint32_t surface_count = alp_scene_get_info(scene).surfaces;
    for (uint32_t i = 0; i < surface_count; i++) {
        uint32_t count = 0;
        alp_lightmap_vertex_values(lightmap, i, &count);
        json_array_append_new(objects, json_pack("{s:o, s:I}", "name",
                                                 json_text(alp_scene_get_surface(scene, i).name),
                                                 "vertices", (json_int_t)count));
    }
    return objects;
}

static json_t *make_objects(const alp_scene *scene, const alp_lightmap *lightmap)
{
    const alp_atlas *atlas = alp_lightmap_atlas(lightmap);
    if (atlas == NULL) {
        return make_vertex_objects(scene, lightmap);
    }
    uint32_t page_count = alp_atlas_get_info(atlas).pages;
    rectangle *pages = allocate_or_exit(NULL, (size_t)page_count * sizeof *pages);
    for (uint32_t i = 0; i < page_count; i++) {
        pages[i].used = false;
    }
    json_t *objects = json_array();
    uint32_t surface_count = alp_scene_get_info(scene).surfaces;
    for (uint32_t i = 0; i < surface_count; i++) {
        alp_surface_info surface = alp_scene_get_surface(scene, i);
        add_surface(objects, atlas, &surface, pages);
    }
    free(pages);
    return objects;
}

json_t *report_warnings(const message_log *messages)
{
    json_t *list = json_array();
    for (size_t i = 0; i < messages->warnings.count; i++) {
        const message *m = &messages->warnings.items[i];
        json_array_append_new(list,
                              json_pack("{s:o, s:o, s:o}", "code", json_text(m->code), "object",
                                        json_text(m->object), "text", json_text(m->text)));
    }
    return list;
}

const char *atlas_mode_name(alp_atlas_mode mode)
{
    return mode == ALP_ATLAS_KEEP     ? "kept"
           : mode == ALP_ATLAS_BLEND  ? "blend"
           : mode == ALP_ATLAS_VERTEX ? "vertex"
                                      : "charts";
}

static json_t *make_atlas(const alp_atlas_info *atlas)
{
    return json_pack(
        "{s:s, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:I, s:I, s:I}", "mode",
        atlas_mode_name(atlas->mode), "pages", (json_int_t)atlas->pages, "width",
        (json_int_t)atlas->width, "height", (json_int_t)atlas->height, "charts",
        (json_int_t)atlas->charts, "texels", (json_int_t)atlas->texels, "utilisation",
        json_number(atlas->utilisation), "texels_per_metre", json_number(atlas->texels_per_metre),
        "stretch_mean", json_number(atlas->stretch_mean), "stretch_worst",
        json_number(atlas->stretch_worst), "density_spread", json_number(atlas->density_spread),
        "flipped_triangles", (json_int_t)atlas->flipped_triangles, "sliver_triangles",
        (json_int_t)atlas->sliver_triangles, "overlapping_texels",
        (json_int_t)atlas->overlapping_texels);
}

static json_t *make_seconds(const alp_bake_report *r, double load)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "load", json_number(load), "atlas",
                     json_number(r->seconds_atlas), "build", json_number(r->seconds_build), "bake",
                     json_number(r->seconds_bake), "seams", json_number(r->seconds_seams), "write",
                     json_number(r->seconds_write), "total", json_number(load + r->seconds_total));
}

/// Texels by the source of their value, and whether sampling was completed.
static json_t *make_sampling(const alp_bake_report *r)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:b}", "samples", (json_int_t)r->ao_samples,
                     "traced", (json_int_t)r->traced, "interpolated", (json_int_t)r->interpolated,
                     "moved", (json_int_t)r->moved, "dropped", (json_int_t)r->dropped, "unknown",
                     (json_int_t)r->unknown, "cut_off", (int)r->cut_off);
}

/// Names of the layers of light: irradiance.NAME.exr, in the order in which they add up.
static json_t *make_layers(const alp_lightmap *lightmap)
{
    json_t *names = json_array();
    for (uint32_t i = 0; i < alp_lightmap_layer_count(lightmap); i++) {
        json_array_append_new(names, json_text(alp_lightmap_layer_name(lightmap, i)));
    }
    return names;
}

/// Energy balance of the light, in W.
static json_t *make_energy(const alp_light_energy *e)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "emitted", json_number(e->emitted), "absorbed",
                     json_number(e->absorbed), "escaped", json_number(e->escaped), "behind",
                     json_number(e->behind), "unshot", json_number(e->unshot));
}

static json_t *make_light(const alp_bake_report *r)
{
    const char *samples = r->light_direct       ? "samples_per_light"
                          : r->light_passes > 0 ? "rays_per_texel"
                                                : "paths_per_texel";
    json_t *light = json_pack("{s:I, s:o}", samples, (json_int_t)r->light_samples,
                              "mean_irradiance", json_number(r->light_mean));
    if (r->light_passes > 0) {
        json_object_set_new(light, "passes", json_integer((json_int_t)r->light_passes));
        json_object_set_new(light, "rounds", json_integer((json_int_t)r->light_rounds));
        json_object_set_new(light, "traced", json_integer((json_int_t)r->light_traced));
        json_object_set_new(light, "interpolated", json_integer((json_int_t)r->light_interpolated));
    }
    if (r->light_energy.known) {
        json_object_set_new(light, "energy", make_energy(&r->light_energy));
    }
    return light;
}

/// @param noise the map's stated error over its mean, for comparison; not finite: null
static void add_seam_error(json_t *maps, const char *map, bool stitched, const alp_seam_error *e,
                           double noise)
{
    json_t *object =
        json_pack("{s:o, s:o}", "mean", json_number(e->mean), "p99", json_number(e->p99));
    if (stitched) {
        json_object_set_new(object, "stitched_mean", json_number(e->stitched_mean));
        json_object_set_new(object, "stitched_p99", json_number(e->stitched_p99));
        json_object_set_new(object, "change_rms", json_number(e->change_rms));
        json_object_set_new(object, "change_max", json_number(e->change_max));
    }
    json_object_set_new(object, "noise", json_number(noise));
    json_object_set_new(maps, map, object);
}

/// Difference across seams, over the mean of each map.
static json_t *make_seams(const alp_bake_report *r)
{
    json_t *maps = json_object();
    if ((r->maps & ALP_MAP_AO) != 0) {
        add_seam_error(maps, "ao", r->seams.stitched, &r->seams.ao, r->ao_relative_error);
    }
    if ((r->maps & ALP_MAP_OBSCURANCE) != 0) {
        add_seam_error(maps, "obscurance", r->seams.stitched, &r->seams.obscurance, (double)NAN);
    }
    if ((r->maps & ALP_MAP_LIGHT) != 0) {
        add_seam_error(maps, "irradiance", r->seams.stitched, &r->seams.light,
                       r->light_relative_error);
    }
    return json_pack("{s:I, s:o, s:o}", "edges", (json_int_t)r->seams.count, "length",
                     json_number(r->seams.length), "maps", maps);
}

json_t *report_make(const session *s, const alp_lightmap *lightmap, const alp_bake_report *r,
                    const alp_diagnosis *diagnosis)
{
    // Readers that keep numbers as doubles lose bits of 64, so the hash is text.
    char hash[24];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)r->input_hash);
    json_t *document = json_pack(
        "{s:s, s:{s:I, s:I, s:I}, s:o, s:o, s:I, s:I, s:I, s:s, s:{s:{s:o, s:o}}, s:I, s:o, s:o}",
        "version", alp_version(), "scene", "triangles", (json_int_t)r->scene.triangles, "surfaces",
        (json_int_t)r->scene.surfaces, "surfaces_baked", (json_int_t)r->surfaces_baked, "atlas",
        make_atlas(&r->atlas), "seconds", make_seconds(r, s->load_seconds), "rays",
        (json_int_t)r->rays, "threads", (json_int_t)r->threads, "seed", (json_int_t)r->seed,
        "input_hash", hash, "error", "ao", "relative", json_number(r->ao_relative_error), "p99",
        json_number(r->ao_p99_error), "peak_memory_bytes", (json_int_t)r->peak_memory_bytes,
        "objects", make_objects(s->scene, lightmap), "warnings", report_warnings(&s->messages));
    json_t *error = json_object_get(document, "error");
    if (r->atlas.mode == ALP_ATLAS_VERTEX) { // no error is stated
        json_object_clear(error);
    }
    if ((r->maps & ALP_MAP_LIGHT) != 0) {
        json_object_set_new(document, "light", make_light(r));
        if (alp_lightmap_layer_count(lightmap) > 0) {
            json_object_set_new(json_object_get(document, "light"), "layers",
                                make_layers(lightmap));
        }
        json_object_set_new(
            error, "irradiance",
            json_pack("{s:o, s:o, s:o}", "relative", json_number(r->light_relative_error), "p99",
                      json_number(r->light_p99_error), "relative_to", json_number(r->light_scale)));
    }
    if ((r->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) == 0) {
        json_object_del(error, "ao");
    }
    if (r->atlas.mode != ALP_ATLAS_VERTEX) {
        json_object_set_new(document, "seams", make_seams(r));
    }
    json_object_set_new(document, "sampling", make_sampling(r));
    json_object_set_new(document, "uv_sets", findings_uv_sets_json(diagnosis));
    json_object_set_new(document, "findings", findings_json(diagnosis));
    return document;
}
