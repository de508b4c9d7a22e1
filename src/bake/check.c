// SPDX-License-Identifier: MIT
// Refusals of the options of a bake; those of light are in check_light.c. The rooms of occlusion,
// lights and atlas check their own options, and alpi_bake_check calls them.
#include "bake/check.h"

#include "atlas/choice.h"
#include "bake/bake_checkpoint.h"
#include "bake/settings.h"
#include "base/file.h"
#include "scene/lights/lighting_options.h"
#include "transport/occlusion/occlusion.h"

enum {
    ALL_MAPS = ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE | ALP_MAP_LIGHT |
               ALPI_MAPS_BY_DIRECTION | ALP_MAP_PROBES,
    SIGNED_MAPS = ALP_MAP_BENT | ALPI_MAPS_BY_DIRECTION
};

static const alp_result INVALID = ALP_ERROR_INVALID_ARGUMENT;

/// Refuses numbers that name no choice.
static alp_result check_choices(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if ((int)o->existing_ao < ALP_EXISTING_AO_REPLACE || o->existing_ao > ALP_EXISTING_AO_KEEP) {
        return alpi_fail(job->context, INVALID, "bake: unknown choice %d for existing occlusion",
                         (int)o->existing_ao);
    }
    if ((int)o->ao_into < ALP_AO_INTO_SEPARATE || o->ao_into > ALP_AO_INTO_ORM) {
        return alpi_fail(job->context, INVALID, "bake: unknown destination %d of occlusion",
                         (int)o->ao_into);
    }
    if ((int)o->vertex_attribute < ALP_VERTEX_COLOR || o->vertex_attribute > ALP_VERTEX_OCCLUSION) {
        return alpi_fail(job->context, INVALID, "bake: unknown choice %d for the vertex attribute",
                         (int)o->vertex_attribute);
    }
    if (o->maps == 0 || (o->maps & ~(unsigned)ALL_MAPS) != 0) {
        return alpi_fail(job->context, INVALID, "bake: unknown maps 0x%x, need bits of alp_map",
                         o->maps);
    }
    if ((int)o->maps_format < ALP_MAPS_EXR || o->maps_format > ALP_MAPS_KTX2) {
        return alpi_fail(job->context, INVALID, "bake: unknown format %d of maps",
                         (int)o->maps_format);
    }
    return ALP_OK;
}

static alp_result check_sampling(const alpi_bake_job *job)
{
    const alp_sampling_options *s = &job->options.sampling;
    const bool accuracy_is_valid =
        s->accuracy == ALP_ADAPTIVE_AUTO || (s->accuracy >= ALP_ADAPTIVE_OFF && s->accuracy < 1.0f);
    if (!accuracy_is_valid || !(s->error >= 0.0f) || !(s->time_limit >= 0.0)) {
        return alpi_fail(job->context, INVALID,
                         "bake: accuracy %g (need [0, 1), or AUTO), error %g or time limit %g s "
                         "(need 0 or more)",
                         (double)s->accuracy, (double)s->error, s->time_limit);
    }
    return ALP_OK;
}

/// Refuses options that make no sense with values at vertices, or only with them.
static alp_result check_vertices(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    const alp_sampling_options *s = &o->sampling;
    if (o->atlas.mode != ALP_ATLAS_VERTEX) {
        return o->vertex_attribute == ALP_VERTEX_COLOR
                   ? ALP_OK
                   : alpi_fail(job->context, INVALID,
                               "bake: a vertex attribute needs ALP_ATLAS_VERTEX");
    }
    if (o->ao_into == ALP_AO_INTO_ORM) {
        return alpi_fail(job->context, INVALID,
                         "bake: occlusion at vertices has no map to pack into an image");
    }
    if (o->maps_folder != NULL) {
        return alpi_fail(job->context, INVALID,
                         "%s: a bake at vertices has no maps; give an output only", o->maps_folder);
    }
    if (o->only != NULL || o->ao_self) {
        return alpi_fail(
            job->context, INVALID,
            "bake: at vertices all surfaces are baked together; leave out only and ao_self");
    }
    if (s->accuracy > 0.0f || s->error != 0.0f || s->time_limit != 0.0 || s->keep_partial) {
        return alpi_fail(job->context, INVALID,
                         "bake: at vertices every receiver gets all rays; leave out accuracy, "
                         "error, time_limit and keep_partial");
    }
    if (o->existing_ao != ALP_EXISTING_AO_REPLACE) {
        return alpi_fail(job->context, INVALID,
                         "bake: a bake at vertices keeps the materials' occlusion maps; set "
                         "existing_ao to REPLACE");
    }
    if (o->maps != ALP_MAP_AO) {
        return alpi_fail(job->context, INVALID, "bake: only occlusion is baked at vertices");
    }
    return ALP_OK;
}

static alp_result check_maps(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->output != NULL && (o->maps & ALP_MAP_AO) == 0 &&
        o->lightmap_as == ALP_LIGHTMAP_AS_NONE) {
        return alpi_fail(job->context, INVALID,
                         "%s: glTF has a place only for occlusion, and for light with lightmap_as; "
                         "bake one of them too, or give no output",
                         o->output);
    }
    const bool in_one_go = (o->maps & ALP_MAP_OBSCURANCE) != 0;
    const bool light_in_one_go =
        alpi_bake_wants_light(o) && (o->light.gather != ALP_GATHER_RAYS || o->light.bounces == 0);
    if ((in_one_go || light_in_one_go) &&
        (o->sampling.time_limit > 0.0 || o->sampling.keep_partial)) {
        return alpi_fail(job->context, INVALID,
                         "bake: %s gathered in one round; leave out time_limit and keep_partial",
                         in_one_go                             ? "coloured obscurance is"
                         : o->light.bounces == 0               ? "direct light alone is"
                         : o->light.gather == ALP_GATHER_PATHS ? "light by paths is"
                                                               : "light by hemicubes is");
    }
    if (alpi_bake_wants_light(o) && o->occluders != NULL) {
        return alpi_fail(job->context, INVALID, "bake: light takes no occluders; leave them out");
    }
    if (alpi_bake_wants_light(o) && o->ao_self) {
        return alpi_fail(job->context, INVALID,
                         "bake: light is baked for the whole scene; leave out ao_self");
    }
    if ((o->maps & ALPI_MAPS_BY_DIRECTION) != 0 && !alpi_bake_wants_light(o)) {
        return alpi_fail(job->context, INVALID, "bake: light by direction needs ALP_MAP_LIGHT");
    }
    if ((o->maps & ALP_MAP_PROBES) != 0 && (!alpi_bake_wants_light(o) || o->maps_folder == NULL)) {
        return alpi_fail(job->context, INVALID,
                         "bake: probes need ALP_MAP_LIGHT, whose light they share, and a "
                         "maps_folder");
    }
    if (o->ao_self && o->occluders != NULL) {
        return alpi_fail(job->context, INVALID,
                         "bake: ao_self bakes each object alone, without other occluders; leave "
                         "out ao_self or occluders");
    }
    return ALP_OK;
}

static alp_result check_maps_format(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->maps_format != ALP_MAPS_EXR && o->maps_folder == NULL) {
        return alpi_fail(job->context, INVALID,
                         "bake: maps_format applies to maps_folder; give one");
    }
    if (o->maps_format == ALP_MAPS_HDR && (o->maps & (unsigned)SIGNED_MAPS) != 0) {
        return alpi_fail(job->context, INVALID,
                         "bake: bent normals, directions and harmonics have negative values, which "
                         ".hdr cannot hold; use EXR or KTX2");
    }
    return ALP_OK;
}

// --- the output ----------------------------------------------------------------------------------

static alp_result check_viewer_file(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (!alpi_path_has_ending(o->output, alpi_bake_viewer_ending(o))) {
        return alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                         "%s: this form of light needs an output that ends in %s", o->output,
                         alpi_bake_viewer_ending(o));
    }
    if (o->atlas.mode == ALP_ATLAS_BLEND) {
        return alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                         "%s: this form of light has one coordinate set, and --atlas blend has "
                         "three; write .glb or .gltf, or use --atlas charts",
                         o->output);
    }
    return ALP_OK;
}

/// Finds the first result that an OBJ or COLLADA file has no place for, or NULL.
static const char *find_homeless(const alp_bake_options *o, bool is_obj)
{
    const bool lit_otherwise =
        o->lightmap_as != ALP_LIGHTMAP_AS_NONE && o->lightmap_as != ALP_LIGHTMAP_AS_EMISSIVE;
    return o->atlas.mode == ALP_ATLAS_VERTEX            ? "values at vertices"
           : is_obj && o->atlas.mode == ALP_ATLAS_BLEND ? "three coordinate sets"
           : o->ao_into == ALP_AO_INTO_ORM              ? "occlusion packed into an image"
           : lit_otherwise                              ? "a light map other than emission"
                                                        : NULL;
}

static alp_result check_output(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->output == NULL) {
        return ALP_OK;
    }
    if (alpi_bake_is_viewer_file(o)) {
        return check_viewer_file(job);
    }
    const bool is_obj = alpi_path_has_ending(o->output, ".obj");
    if (is_obj || alpi_path_has_ending(o->output, ".dae")) {
        const char *what = find_homeless(o, is_obj);
        return what == NULL ? ALP_OK
                            : alpi_fail(job->context, ALP_ERROR_UNSUPPORTED,
                                        "%s: %s has no place for %s; write .glb or .gltf",
                                        o->output, is_obj ? "an .obj" : "a .dae", what);
    }
    return alpi_bake_is_gltf(o)
               ? ALP_OK
               : alpi_fail(
                     job->context, ALP_ERROR_UNSUPPORTED,
                     "%s: its ending is not a format of output; use .glb, .gltf, .dae or .obj",
                     o->output);
}

// -------------------------------------------------------------------------------------------------

static alp_result check_scene(const alpi_bake_job *job)
{
    if (job->scene->usable_count > 0) {
        return ALP_OK;
    }
    return alpi_fail(
        job->context, ALP_ERROR_INVALID_DATA, "%s: nothing to bake: %s", job->scene->name,
        job->scene->triangle_count == 0 ? "the scene has no triangles"
                                        : "no triangle has area and finite coordinates");
}

alp_result alpi_bake_check(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(job->context, INVALID, "bake options are not from _default()");
    }
    ALP_TRY(check_choices(job));
    ALP_TRY(check_sampling(job));
    ALP_TRY(alpi_bake_check_checkpoint(job));
    ALP_TRY(check_vertices(job));
    ALP_TRY(check_maps(job));
    ALP_TRY(alpi_bake_check_light(job));
    ALP_TRY(check_maps_format(job));
    ALP_TRY(check_output(job));
    ALP_TRY(alpi_occlusion_check(job->scene, &o->occlusion));
    if (alpi_bake_wants_light(o)) {
        ALP_TRY(alpi_lighting_options_check(job->context, &o->light.lighting));
    }
    if (o->atlas.mode != ALP_ATLAS_VERTEX) {
        ALP_TRY(alpi_atlas_check(job->scene, &o->atlas));
    }
    return check_scene(job);
}
