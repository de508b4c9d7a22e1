// SPDX-License-Identifier: MIT
// The options of alpenglow bake. The library refuses options that make no sense together
// (src/bake/check.c). This file refuses one itself only where the message has to name an option of
// the command, or where the option exists in the command alone.
#include "bake_options.h"

#include "bake_defaults.h"
#include "output.h"
#include "setup/lighting.h"

#include <string.h>

static int check_output_name(const char *path, alp_lightmap_as as)
{
    const bool viewer = as == ALP_LIGHTMAP_AS_THREE || as == ALP_LIGHTMAP_AS_BABYLON;
    const char *ending = as == ALP_LIGHTMAP_AS_THREE ? ".json" : ".babylon";
    if (viewer && path != NULL && !path_ends(path, ending)) {
        return usage_error(COMMAND_BAKE, "-o %s: with --lightmap-as %s the name must end in %s",
                           path, as == ALP_LIGHTMAP_AS_THREE ? "three" : "babylon", ending);
    }
    if (path == NULL || viewer || path_ends(path, ".glb") || path_ends(path, ".gltf") ||
        path_ends(path, ".obj") || path_ends(path, ".dae")) {
        return EXIT_DONE;
    }
    if (path_ends(path, ".json") || path_ends(path, ".babylon")) {
        return usage_error(COMMAND_BAKE, "-o %s: needs --maps light --lightmap-as %s", path,
                           path_ends(path, ".json") ? "three" : "babylon");
    }
    return usage_error(COMMAND_BAKE, "-o %s: the name must end in .glb, .gltf, .dae or .obj", path);
}

/// Refuses options that do not apply to values at vertices, or only to them.
static int check_vertex_options(const command_line *a)
{
    static const option_id of_maps[] = {OPTION_SIZE,         OPTION_TEXELS_PER_METRE,
                                        OPTION_PADDING,      OPTION_BLOCK,
                                        OPTION_MIPS,         OPTION_DENSITY,
                                        OPTION_EXISTING_AO,  OPTION_AO_INTO,
                                        OPTION_QUALITY,      OPTION_ERROR,
                                        OPTION_ADAPTIVE,     OPTION_TIME_LIMIT,
                                        OPTION_KEEP_PARTIAL, OPTION_AO_BLEED,
                                        OPTION_MAPS_FOLDER,  OPTION_MAPS_AS,
                                        OPTION_STITCH};
    const option_value *values = a->values;
    const bool at_vertices = values[OPTION_ATLAS].choice == (int)ALP_ATLAS_VERTEX;
    const char *name = option_find_given(a, of_maps, sizeof of_maps / sizeof *of_maps);
    if (at_vertices && name != NULL) {
        return usage_error(COMMAND_BAKE,
                           "%s: not with --atlas vertex, which makes no map and traces all rays "
                           "at every vertex",
                           name);
    }
    if (!at_vertices && values[OPTION_VERTEX_ATTRIBUTE].given) {
        return usage_error(COMMAND_BAKE, "--vertex-attribute: needs --atlas vertex");
    }
    return EXIT_DONE;
}

/// Options of light need light, those of occlusion need occlusion.
static int check_light(const command_line *a, bool light, bool occlusion)
{
    static const option_id not_of_light[] = {OPTION_AO_SELF, OPTION_OCCLUDERS};
    const option_value *values = a->values;
    const char *name = bake_light_option(a);
    if (name == NULL && values[OPTION_SAMPLES].given) {
        name = "--samples";
    }
    if (name != NULL && !light) {
        return usage_error(COMMAND_BAKE, "%s: needs --maps light%s", name,
                           values[OPTION_MAPS].given ? "" : "; occlusion has --ao-samples");
    }
    name = bake_occlusion_option(a);
    if (name != NULL && !occlusion) {
        return usage_error(COMMAND_BAKE, "%s: applies to occlusion only; for light give --samples",
                           name);
    }
    name = option_find_given(a, not_of_light, sizeof not_of_light / sizeof *not_of_light);
    if (name != NULL && light) {
        return usage_error(COMMAND_BAKE, "--maps light: is baked for the whole scene; leave out %s",
                           name);
    }
    return EXIT_DONE;
}

/// Refuses forms of light that their options or other maps exclude.
static int check_form(const option_value *values, const alp_bake_options *o)
{
    const option_value *as = &values[OPTION_LIGHTMAP_AS];
    const bool viewer = o->lightmap_as >= ALP_LIGHTMAP_AS_THREE;
    if (values[OPTION_LIGHTMAP_FORMAT].given && o->lightmap_as != ALP_LIGHTMAP_AS_EXTRAS) {
        return usage_error(COMMAND_BAKE,
                           "--lightmap-format: applies to --lightmap-as extras; %s %s", as->text,
                           viewer ? "has a format of its own" : "stores a PNG in the asset");
    }
    if (viewer && (bake_maps(values) & ALP_MAP_AO) != 0 && o->maps_folder == NULL) {
        return usage_error(COMMAND_BAKE,
                           "--maps ao: --lightmap-as %s stores light alone; give --maps-dir DIR",
                           as->text);
    }
    if (o->ao_into == ALP_AO_INTO_ORM) {
        return usage_error(COMMAND_BAKE,
                           "--ao-into orm: not with --lightmap-as, because occlusion shares the "
                           "coordinates of the light; leave one of them out");
    }
    if (o->lightmap_as == ALP_LIGHTMAP_AS_EMISSIVE && values[OPTION_DIRECT].given &&
        strcmp(values[OPTION_DIRECT].text, "off") == 0) {
        return usage_error(COMMAND_BAKE,
                           "--direct off: materials of --lightmap-as emissive are "
                           "black and reflect no direct light; use --lightmap-as moz or extras");
    }
    return EXIT_DONE;
}

/// Refuses --units that a form of light does not have.
static int check_units(const option_value *values, const alp_bake_options *o)
{
    const option_value *as = &values[OPTION_LIGHTMAP_AS], *units = &values[OPTION_UNITS];
    const bool radiance = o->light_units == ALP_LIGHT_RADIANCE;
    if (!units->given) {
        return EXIT_DONE;
    }
    if (o->lightmap_as >= ALP_LIGHTMAP_AS_THREE) {
        return usage_error(COMMAND_BAKE,
                           "--units: not with --lightmap-as %s, whose viewer needs fixed units",
                           as->text);
    }
    if (o->lightmap_as == ALP_LIGHTMAP_AS_EMISSIVE && !radiance) {
        return usage_error(COMMAND_BAKE,
                           "--units %s: --lightmap-as emissive stores radiance; leave out --units",
                           units->text);
    }
    if (o->lightmap_as == ALP_LIGHTMAP_AS_MOZ && radiance) {
        return usage_error(COMMAND_BAKE, "--units radiance: readers of MOZ_lightmap multiply it by "
                                         "the albedo; give irradiance or irradiance/pi");
    }
    return EXIT_DONE;
}

/// --lightmap-as with --units and --lightmap-format, and their needs.
static int read_lightmap(const option_value *values, alp_bake_options *o)
{
    const option_value *units = &values[OPTION_UNITS], *format = &values[OPTION_LIGHTMAP_FORMAT];
    o->lightmap_as = bake_form(values);
    if (o->lightmap_as == ALP_LIGHTMAP_AS_NONE) {
        return units->given || format->given
                   ? usage_error(COMMAND_BAKE, "%s: applies to light in -o; needs --lightmap-as",
                                 units->given ? "--units" : "--lightmap-format")
                   : EXIT_DONE;
    }
    o->light_units = units->given ? (alp_light_units)(units->choice + 1) : ALP_LIGHT_UNITS_AUTO;
    o->lightmap_format = (alp_lightmap_format)format->choice;
    if ((bake_maps(values) & ALP_MAP_LIGHT) == 0 || o->output == NULL) {
        return usage_error(COMMAND_BAKE, "--lightmap-as: writes light into -o; needs %s",
                           o->output == NULL ? "-o OUT.glb or -o OUT.gltf" : "--maps light");
    }
    const int code = check_form(values, o);
    return code == EXIT_DONE ? check_units(values, o) : code;
}

/// --maps-as: the format of --maps-dir.
static int read_maps_format(const option_value *values, alp_bake_options *o)
{
    const option_value *as = &values[OPTION_MAPS_AS];
    o->maps_format = (alp_maps_format)as->choice;
    if (as->given && o->maps_folder == NULL) {
        return usage_error(COMMAND_BAKE,
                           "--maps-as: is the format of --maps-dir; give --maps-dir DIR too");
    }
    const char *name = (o->maps & ALP_MAP_BENT) != 0        ? "bent"
                       : (o->maps & ALP_MAP_SH) != 0        ? "sh"
                       : (o->maps & ALP_MAP_DIRECTION) != 0 ? "direction"
                                                            : NULL;
    if (o->maps_format == ALP_MAPS_HDR && name != NULL) {
        return usage_error(
            COMMAND_BAKE,
            "--maps-as hdr: cannot store the negative values of --maps %s; use exr16 or ktx2",
            name);
    }
    return EXIT_DONE;
}

/// Refuses maps of light by direction without light, or by a gatherer that loses directions.
static int check_directions(const option_value *values, unsigned maps)
{
    const char *name = (maps & ALP_MAP_SH) != 0          ? "sh"
                       : (maps & ALP_MAP_DIRECTION) != 0 ? "direction"
                                                         : NULL;
    if (name != NULL && (maps & ALP_MAP_LIGHT) == 0) {
        return usage_error(COMMAND_BAKE, "--maps %s: needs light; give --maps light,%s", name,
                           name);
    }
    if (name != NULL && values[OPTION_GATHER].choice == (int)ALP_GATHER_PATHS) {
        return usage_error(
            COMMAND_BAKE,
            "--maps %s: --gather paths keeps no directions of light; use --gather rays or hemicube",
            name);
    }
    return EXIT_DONE;
}

/// Refuses probes without what they need, and their options without them.
static int check_probes(const option_value *values, const alp_bake_options *o)
{
    const bool probes = (o->maps & ALP_MAP_PROBES) != 0;
    if (probes && (o->maps & ALP_MAP_LIGHT) == 0) {
        return usage_error(COMMAND_BAKE, "--maps probes: shares the light of the map; give --maps "
                                         "light,probes, or use the command probes");
    }
    if (!probes && (values[OPTION_SPACING].given || values[OPTION_BOUNDS].given)) {
        return usage_error(COMMAND_BAKE, "%s: needs --maps light,probes",
                           values[OPTION_SPACING].given ? "--spacing" : "--bounds");
    }
    if (probes && o->maps_folder == NULL) {
        return usage_error(COMMAND_BAKE, "--maps probes: give --maps-dir DIR");
    }
    return EXIT_DONE;
}

/// Refuses maps that have no place in the outputs.
static int check_places(const alp_bake_options *o)
{
    const bool ao = (o->maps & ALP_MAP_AO) != 0, bent = (o->maps & ALP_MAP_BENT) != 0;
    const bool light = (o->maps & ALP_MAP_LIGHT) != 0, bleed = (o->maps & ALP_MAP_OBSCURANCE) != 0;
    const bool lit = o->lightmap_as != ALP_LIGHTMAP_AS_NONE;
    if (o->atlas.mode == ALP_ATLAS_VERTEX && (bent || light)) {
        return usage_error(COMMAND_BAKE, "--maps %s: not with --atlas vertex, which bakes ao only",
                           bent ? "bent" : "light");
    }
    if (o->maps_folder == NULL && (bent || bleed || (light && !lit))) {
        return usage_error(COMMAND_BAKE, "%s: glTF has no place for it; give --maps-dir DIR%s",
                           bent    ? "--maps bent"
                           : light ? "--maps light"
                                   : "--ao-bleed",
                           light && !bent && o->output != NULL ? " or --lightmap-as" : "");
    }
    if (o->output != NULL && !ao && !lit) {
        return usage_error(
            COMMAND_BAKE, "-o %s: glTF has a place for ao only; give %s, or --maps-dir alone",
            o->output, light ? "--lightmap-as or --maps ao,light" : "--maps ao,bent");
    }
    return EXIT_DONE;
}

/// --maps and --ao-bleed, and options that exclude them.
static int read_maps(const command_line *a, alp_bake_options *o)
{
    const option_value *values = a->values;
    const bool bleed = values[OPTION_AO_BLEED].given;
    o->maps = bake_maps(values) | (bleed ? ALP_MAP_OBSCURANCE : 0u);
    const bool ao = (o->maps & ALP_MAP_AO) != 0, bent = (o->maps & ALP_MAP_BENT) != 0;
    const bool light = (o->maps & ALP_MAP_LIGHT) != 0;
    if (values[OPTION_METALS].given && !light && !bleed) {
        return usage_error(COMMAND_BAKE, "--metals: needs --maps light or --ao-bleed");
    }
    int code = check_directions(values, o->maps);
    code = code == EXIT_DONE ? check_probes(values, o) : code;
    code = code == EXIT_DONE ? check_places(o) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (values[OPTION_EXISTING_AO].given && !ao) {
        return usage_error(COMMAND_BAKE, "--existing-ao: needs --maps ao");
    }
    if (bleed && (values[OPTION_TIME_LIMIT].given || values[OPTION_KEEP_PARTIAL].given)) {
        return usage_error(
            COMMAND_BAKE,
            "--ao-bleed: has no partial results; leave out --time-limit and --keep-partial");
    }
    return check_light(a, light, ao || bent || bleed);
}

/// --quality, --error and the limits. With a wanted error, --ao-samples is a limit with a high
/// default.
static int read_sampling(const command_line *a, alp_bake_options *o)
{
    enum { ADAPTIVE_AUTO = 0, ADAPTIVE_OFF = 1 }; // the choices of --adaptive
    enum { MOST_SAMPLES = 65536 };
    const option_value *values = a->values;
    const option_value *adaptive = &values[OPTION_ADAPTIVE];
    alp_sampling_options *s = &o->sampling;
    const int code = error_read(a, &s->error);
    if (code != EXIT_DONE) {
        return code;
    }
    if (s->error > 0.0f && o->maps == ALP_MAP_LIGHT) {
        const int refused = error_check_light(a, OPTION_SAMPLES);
        if (refused != EXIT_DONE) {
            return refused;
        }
    }
    s->time_limit = values[OPTION_TIME_LIMIT].given ? values[OPTION_TIME_LIMIT].real : 0.0;
    if (!values[OPTION_SAMPLES].given && o->light.gather == ALP_GATHER_RAYS &&
        o->light.bounces > 0) {
        const bool till_time = s->time_limit > 0.0 && !(s->error > 0.0f);
        o->light.error = s->error > 0.0f ? s->error : till_time ? 0.0f : 0.01f;
        o->light.bounded = s->error == 0.0f && !till_time;
        o->light.samples = till_time ? MOST_SAMPLES : o->light.samples;
    }
    if ((s->error > 0.0f || s->time_limit > 0.0) && !values[OPTION_AO_SAMPLES].given) {
        o->occlusion.samples = MOST_SAMPLES;
    }
    s->accuracy = adaptive->choice == ADAPTIVE_AUTO  ? ALP_ADAPTIVE_AUTO
                  : adaptive->choice == ADAPTIVE_OFF ? ALP_ADAPTIVE_OFF
                                                     : (float)adaptive->real;
    s->memory_limit = values[OPTION_MEMORY_LIMIT].given ? values[OPTION_MEMORY_LIMIT].whole : 0;
    s->keep_partial = values[OPTION_KEEP_PARTIAL].given;
    return EXIT_DONE;
}

/// --only, --occluders and --ao-self.
static int read_choice(const option_value *values, alp_bake_options *o)
{
    o->only = values[OPTION_ONLY].text;
    o->occluders = values[OPTION_OCCLUDERS].text;
    o->ao_self = values[OPTION_AO_SELF].given;
    if (o->ao_self && o->occluders != NULL) {
        return usage_error(COMMAND_BAKE, "--ao-self and --occluders: an object that is alone has "
                                         "no other occluders; leave one of them out");
    }
    if (o->atlas.mode == ALP_ATLAS_VERTEX && (o->ao_self || o->only != NULL)) {
        return usage_error(
            COMMAND_BAKE,
            "%s: not with --atlas vertex, which bakes all surfaces together; use --atlas charts",
            o->ao_self ? "--ao-self" : "--only");
    }
    return EXIT_DONE;
}

static int check_layers(const option_value *values, const alp_light_options *o)
{
    if (o->layers && o->gather == ALP_GATHER_PATHS && o->bounces > 0) {
        return usage_error(COMMAND_BAKE,
                           "--layers: --gather paths cannot separate lights; use rays or hemicube");
    }
    if (o->layers && o->denoise) {
        return usage_error(COMMAND_BAKE,
                           "--layers: do not add up to a denoised map; leave out --denoise");
    }
    if (o->layers && !values[OPTION_MAPS_FOLDER].given) {
        return usage_error(COMMAND_BAKE, "--layers: are written as files; give --maps-dir DIR");
    }
    return EXIT_DONE;
}

/// --emitters, and options that exclude counted ones.
static int check_emitters(const option_value *values, const alp_light_options *o)
{
    if (values[OPTION_EMITTERS].given && (o->gather != ALP_GATHER_HEMICUBE || o->bounces == 0)) {
        return usage_error(COMMAND_BAKE, "--emitters: needs --gather hemicube%s",
                           o->bounces == 0 ? " and bounces" : "");
    }
    if (o->emitters == ALP_EMITTERS_COUNTED && (o->layers || values[OPTION_ONLY].given)) {
        return usage_error(
            COMMAND_BAKE,
            "--emitters counted: counts all emitters together, for all surfaces; leave out %s",
            o->layers ? "--layers" : "--only");
    }
    return EXIT_DONE;
}

/// --gather, --direct, --bounces, --samples and --denoise.
static int read_light(const command_line *a, alp_light_options *o)
{
    enum { DIRECT_ON, DIRECT_OFF, DIRECT_ONLY, DIRECT_APART }; // the choices of --direct
    const option_value *values = a->values;
    const int direct = values[OPTION_DIRECT].choice;
    o->gather = (alp_gather)values[OPTION_GATHER].choice;
    o->bounces = direct == DIRECT_ONLY ? 0 : lighting_bounces(a);
    o->samples = (uint32_t)values[OPTION_SAMPLES].whole;
    o->hemicube = (uint32_t)values[OPTION_HEMICUBE].whole;
    o->emitters = (alp_emitters)values[OPTION_EMITTERS].choice;
    o->layers = values[OPTION_LAYERS].given;
    o->direct = direct == DIRECT_OFF     ? ALP_DIRECT_OFF
                : direct == DIRECT_APART ? ALP_DIRECT_APART
                                         : ALP_DIRECT_ON;
    o->denoise = values[OPTION_DENOISE].choice == 1;
    if (direct == DIRECT_ONLY && (values[OPTION_BOUNCES].given || values[OPTION_GATHER].given)) {
        return usage_error(COMMAND_BAKE, "--direct only: has no bounces; leave out %s",
                           values[OPTION_BOUNCES].given ? "--bounces" : "--gather");
    }
    if (o->direct != ALP_DIRECT_ON && o->gather == ALP_GATHER_PATHS) {
        return usage_error(
            COMMAND_BAKE,
            "--direct %s: --gather paths cannot separate direct light; use rays or hemicube",
            values[OPTION_DIRECT].text);
    }
    if (values[OPTION_HEMICUBE].given && o->gather != ALP_GATHER_HEMICUBE) {
        return usage_error(COMMAND_BAKE, "--hemicube: needs --gather hemicube");
    }
    if (o->gather == ALP_GATHER_HEMICUBE && o->hemicube % 2 != 0) {
        return usage_error(COMMAND_BAKE, "--hemicube %u: give an even number", o->hemicube);
    }
    if (o->gather == ALP_GATHER_HEMICUBE && values[OPTION_SAMPLES].given) {
        return usage_error(COMMAND_BAKE,
                           "--samples: not with --gather hemicube; set its pixels by --hemicube N");
    }
    const int code = check_emitters(values, o);
    return code == EXIT_DONE ? check_layers(values, o) : code;
}

static int read_atlas(const command_line *a, alp_atlas_options *o)
{
    static const option_id of_charts[] = {OPTION_BLOCK, OPTION_MIPS, OPTION_DENSITY};
    const option_value *values = a->values;
    const option_value *density = &values[OPTION_TEXELS_PER_METRE];
    const char *name = option_find_given(a, of_charts, sizeof of_charts / sizeof *of_charts);
    o->mode = (alp_atlas_mode)values[OPTION_ATLAS].choice;
    o->size = (uint32_t)values[OPTION_SIZE].whole;
    o->padding = (uint32_t)values[OPTION_PADDING].whole;
    o->block = (uint32_t)values[OPTION_BLOCK].whole;
    o->mips = (uint32_t)values[OPTION_MIPS].whole;
    o->densities = values[OPTION_DENSITY].text;
    o->texels_per_metre = density->choice < 0 ? density->real : 0.0;
    if (o->mode == ALP_ATLAS_KEEP && name != NULL) {
        return usage_error(COMMAND_BAKE, "%s: needs new charts; leave out --atlas keep", name);
    }
    if (o->size % (1u << o->mips) != 0) {
        return usage_error(COMMAND_BAKE, "--mips %u: --size must be a multiple of %u", o->mips,
                           1u << o->mips);
    }
    return EXIT_DONE;
}

int bake_options_read(const command_line *a, alp_bake_options *o, lamp_list *lamps)
{
    const option_value *values = a->values;
    *o = alp_bake_options_default();
    o->output = values[OPTION_OUTPUT].text;
    o->maps_folder = values[OPTION_MAPS_FOLDER].text;
    o->overwrite = values[OPTION_FORCE].given;
    o->stitch = values[OPTION_STITCH].choice == 1;
    o->existing_ao = (alp_existing_ao)values[OPTION_EXISTING_AO].choice;
    o->ao_into = (alp_ao_into)values[OPTION_AO_INTO].choice;
    o->vertex_attribute = (alp_vertex_attribute)values[OPTION_VERTEX_ATTRIBUTE].choice;
    int code = check_vertex_options(a);
    code = code == EXIT_DONE ? read_atlas(a, &o->atlas) : code;
    if (code == EXIT_DONE) {
        code = read_choice(values, o);
    }
    code = code == EXIT_DONE ? read_lightmap(values, o) : code;
    code = code == EXIT_DONE ? check_output_name(o->output, o->lightmap_as) : code;
    code = code == EXIT_DONE ? read_maps(a, o) : code;
    code = code == EXIT_DONE ? read_maps_format(values, o) : code;
    code = code == EXIT_DONE ? occlusion_read(a, &o->occlusion) : code;
    code = code == EXIT_DONE ? lighting_read(a, &o->light.lighting, lamps) : code;
    code = code == EXIT_DONE ? read_light(a, &o->light) : code;
    return code == EXIT_DONE ? read_sampling(a, o) : code;
}
