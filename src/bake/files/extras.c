// SPDX-License-Identifier: MIT
#include "bake/files/extras.h"

#include "bake/files/light_units.h"
#include "base/memory.h"
#include "transport/occlusion/falloff.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/// A name of the scene. Scenes from arrays may have names in any bytes.
static json_t *name_text(const char *name)
{
    json_t *text = json_string(name);
    return text != NULL ? text : json_string("(no UTF-8)");
}

/// Adds the surfaces that were baked and their occluders, where these are not all surfaces.
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

/// The distance limit: metres, "inf", or a share of each object's size.
static json_t *distance_value(const alpi_bake_job *job)
{
    if (job->options.ao_self && job->options.occlusion.distance == 0.0f) {
        return json_string("0.2 of each object's diagonal");
    }
    return job->report.ao_distance < 1e30f ? json_real((double)job->report.ao_distance)
                                           : json_string("inf");
}

/// Adds how texels were chosen and when sampling was to stop. `occlusion` may be NULL.
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
    const bool packed = job->packing.count > 0; // asked for, and an image holds it
    json_object_set_new(occlusion, "ao_into",
                        json_string(into[packed ? ALP_AO_INTO_ORM : ALP_AO_INTO_SEPARATE]));
}

/// Describes the light in the asset.
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
    const char *units = alpi_bake_light_units_name(o);
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
    if (job->scene->metals_black) {
        json_object_set_new(object, "metals", json_string("black"));
    }
    if (r->light_direct) {
        json_object_del(object, "gather"); // nothing was gathered
    }
    return object;
}

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
    if (job->report.atlas.mode == ALP_ATLAS_BLEND) { // the asset says elsewhere which sets
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
