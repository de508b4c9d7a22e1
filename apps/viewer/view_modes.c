// SPDX-License-Identifier: MIT
#include "view_modes.h"

#include "mode_fields.h"
#include "passes/shader_list.h"
#include "setup/lightmaps.h"
#include "shaders/bindings.h"

#include <stdlib.h>

/// @param map of the mode
static int prepare_map(session *s, const command_line *a, const alp_render_options *o, alp_map map,
                       lightmap_layout layout, mode_light *light)
{
    alp_lightmap *lightmap = NULL;
    const unsigned maps = map == ALP_MAP_SH ? ALP_MAP_LIGHT | ALP_MAP_SH : (unsigned)map;
    const alp_result result = lightmap_bake(s, a, o, maps, layout, &lightmap);
    const int code = result == ALP_OK ? gl_lightmap_create(s->scene, lightmap, map, layout.blend,
                                                           &light->lightmap)
                                      : session_end(s, result);
    alp_lightmap_destroy(lightmap);
    return code;
}

static int prepare_lightmap(session *s, const command_line *a, alp_render_options *o,
                            mode_light *light)
{
    return prepare_map(s, a, o, ALP_MAP_LIGHT, lightmap_layout_of(a), light);
}

static int prepare_blend(session *s, const command_line *a, alp_render_options *o,
                         mode_light *light)
{
    const lightmap_layout layout = {ALP_ATLAS_BLEND, ALP_BLEND_NORMAL};
    return prepare_map(s, a, o, ALP_MAP_LIGHT, layout, light);
}

static int prepare_sh(session *s, const command_line *a, alp_render_options *o, mode_light *light)
{
    return prepare_map(s, a, o, ALP_MAP_SH, lightmap_layout_of(a), light);
}

static int prepare_ao(session *s, const command_line *a, alp_render_options *o, mode_light *light)
{
    return prepare_map(s, a, o, ALP_MAP_AO, lightmap_layout_of(a), light);
}

static void bind_lightmap(const mode_light *light, GLuint program)
{
    (void)program;
    gl_lightmap_bind(&light->lightmap);
}

static int prepare_ambient(session *s, const command_line *a, alp_render_options *o,
                           mode_light *light)
{
    field_source source = {0};
    const alp_result result =
        field_fit(s, a, view_mode_of(a)->field.ambient, &o->lighting, &source);
    if (result == ALP_OK) {
        gl_ambient_create(source.field, &light->ambient);
    }
    field_source_clear(&source);
    return result == ALP_OK ? EXIT_DONE : session_end(s, result);
}

static int prepare_direct(session *s, const command_line *a, alp_render_options *o,
                          mode_light *light)
{
    (void)a;
    (void)light;
    const bool sun = o->lighting.sun.illuminance > 0.0f;
    if (alp_scene_get_info(s->scene).lights == 0 && o->lighting.lamp_count == 0 && !sun) {
        session_warn(s, "no-light", "--with direct",
                     "no lamp and no sun shines, and surfaces have their emission alone; give "
                     "--sun, --lamp or --spot");
    }
    return EXIT_DONE;
}

static int prepare_paths(session *s, const command_line *a, alp_render_options *o,
                         mode_light *light)
{
    (void)s;
    light->paths =
        (path_picture){.options = *o, .samples = (uint32_t)a->values[OPTION_SAMPLES].whole};
    light->paths.options.method = ALP_RENDER_REFERENCE;
    light->paths.options.without_direct = a->values[OPTION_DIRECT].choice == 0;
    return EXIT_DONE;
}

static void bind_lights(const mode_light *light, GLuint program)
{
    (void)program;
    gl_lights_bind(&light->lights);
}

static void bind_ambient(const mode_light *light, GLuint program)
{
    (void)program;
    gl_ambient_bind(&light->ambient);
    mode_light_bind_ssao(light);
    gl_lights_bind(&light->lights);
}

enum {
    LIT = USES_METALS | USES_BACKGROUND | USES_LIGHTS | USES_PANES,
    MAPPED = LIT | USES_BOUNCES | USES_ATLAS | USES_TEXELS | USES_SEED,
    FITTED = LIT | USES_BOUNCES | USES_SEED | USES_SWITCH | USES_DIRECT | USES_NORMALS | USES_SSAO |
             USES_OBJECT,
    FLOWN = FITTED & ~USES_BOUNCES,
    TRACED = LIT | USES_BOUNCES | USES_SEED | USES_SWITCH | USES_PATHS
};

/// In the order of the choices of --with.
static const view_mode modes[] = {
    {.name = "none",
     .fragment = &shader_none_frag,
     .uses = USES_BACKGROUND | USES_PANES,
     .method = ALP_RENDER_LIGHTMAP},
    {.name = "albedo",
     .fragment = &shader_albedo_frag,
     .uses = USES_METALS,
     .method = ALP_RENDER_ALBEDO},
    {.name = "lightmap",
     .fragment = &shader_lightmap_frag,
     .uses = MAPPED | USES_LAYOUT,
     .method = ALP_RENDER_LIGHTMAP,
     .prepare = prepare_lightmap,
     .bind = bind_lightmap},
    {.name = "direct",
     .fragment = &shader_direct_frag,
     .uses = LIT | USES_DIRECT | USES_NORMALS | USES_OBJECT,
     .method = ALP_RENDER_FIELD,
     .prepare = prepare_direct,
     .bind = bind_lights},
    {.name = "constant",
     .fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .field = {FIELD_OTHER, ALP_AMBIENT_CONSTANT},
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.name = "hemisphere",
     .fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .field = {FIELD_OTHER, ALP_AMBIENT_HEMISPHERE},
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.name = "ground-map",
     .fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .field = {FIELD_OTHER, ALP_AMBIENT_GROUND_MAP},
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.name = "ambient-cube",
     .fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .field = {FIELD_OTHER, ALP_AMBIENT_CUBE},
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.name = "environment",
     .fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .field = {FIELD_OTHER, ALP_AMBIENT_ENVIRONMENT},
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.name = "probes",
     .fragment = &shader_field_frag,
     .uses = FITTED | USES_FIELD | USES_PROBES,
     .method = ALP_RENDER_FIELD,
     .field = {.model = FIELD_PROBES},
     .prepare = mode_field_prepare,
     .bind = mode_field_bind},
    {.name = "ambience",
     .fragment = &shader_field_frag,
     .uses = FLOWN | USES_FIELD,
     .method = ALP_RENDER_FIELD,
     .field = {.model = FIELD_AMBIENCE},
     .prepare = mode_field_prepare,
     .bind = mode_field_bind,
     .move = mode_ambience_move},
    {.name = "lpv",
     .fragment = &shader_field_frag,
     .uses = FITTED | USES_FIELD,
     .method = ALP_RENDER_FIELD,
     .field = {.model = FIELD_LPV},
     .prepare = mode_field_prepare,
     .bind = mode_field_bind,
     .move = mode_lpv_move},
    {.name = "ao",
     .fragment = &shader_ao_frag,
     .uses = USES_ATLAS | USES_LAYOUT | USES_SEED | USES_OCCLUSION,
     .method = ALP_RENDER_AO,
     .prepare = prepare_ao,
     .bind = bind_lightmap},
    {.name = "sh",
     .fragment = &shader_sh_frag,
     .uses = MAPPED | USES_LAYOUT | USES_NORMALS,
     .method = ALP_RENDER_LIGHTMAP,
     .prepare = prepare_sh,
     .bind = bind_lightmap},
    {.name = "blend",
     .fragment = &shader_lightmap_frag,
     .uses = MAPPED,
     .method = ALP_RENDER_LIGHTMAP,
     .prepare = prepare_blend,
     .bind = bind_lightmap},
    {.name = "reference",
     .fragment = &shader_none_frag,
     .uses = TRACED,
     .method = ALP_RENDER_REFERENCE,
     .prepare = prepare_paths},
};

const view_mode *view_mode_of(const command_line *a)
{
    return &modes[a->values[OPTION_WITH].choice];
}

/// The models of --with and --beside. @return set of 1u << field_model
static unsigned models_of(const command_line *a)
{
    const option_value *beside = &a->values[OPTION_BESIDE];
    const unsigned own = 1u << view_mode_of(a)->field.model;
    return beside->given ? own | 1u << modes[beside->choice].field.model : own;
}

int view_mode_check(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
        unsigned use;
    } read_by[] = {{"--metals", OPTION_METALS, USES_METALS},
                   {"--sky", OPTION_SKY, USES_BACKGROUND},
                   {"--sky-turn", OPTION_SKY_TURN, USES_BACKGROUND},
                   {"--sky-strength", OPTION_SKY_STRENGTH, USES_BACKGROUND},
                   {"--sun", OPTION_SUN, USES_BACKGROUND},
                   {"--sun-size", OPTION_SUN_SIZE, USES_BACKGROUND},
                   {"--lamp", OPTION_LAMP, USES_LIGHTS},
                   {"--spot", OPTION_SPOT, USES_LIGHTS},
                   {"--bounces", OPTION_BOUNCES, USES_BOUNCES},
                   {"--direct", OPTION_DIRECT, USES_SWITCH},
                   {"--size", OPTION_SIZE, USES_ATLAS},
                   {"--atlas", OPTION_ATLAS, USES_LAYOUT},
                   {"--stitch", OPTION_STITCH, USES_ATLAS},
                   {"--texel-samples", OPTION_TEXEL_SAMPLES, USES_TEXELS},
                   {"--seed", OPTION_SEED, USES_SEED},
                   {"--one-sided", OPTION_ONE_SIDED, USES_ATLAS},
                   {"--occluders", OPTION_OCCLUDERS, USES_OCCLUSION},
                   {"--ao-samples", OPTION_AO_SAMPLES, USES_OCCLUSION},
                   {"--ao-distance", OPTION_AO_DISTANCE, USES_OCCLUSION},
                   {"--ao-falloff", OPTION_AO_FALLOFF, USES_OCCLUSION},
                   {"--ao-cone", OPTION_AO_CONE, USES_OCCLUSION},
                   {"--ao-distribution", OPTION_AO_DISTRIBUTION, USES_OCCLUSION},
                   {"--samples", OPTION_SAMPLES, USES_PATHS},
                   {"--ssao", OPTION_SSAO, USES_SSAO},
                   {"--ssao-radius", OPTION_SSAO_RADIUS, USES_SSAO},
                   {"--read", OPTION_READ, USES_FIELD},
                   {"--object", OPTION_OBJECT, USES_OBJECT},
                   {"--object-path", OPTION_OBJECT_PATH, USES_OBJECT},
                   {"--normal-maps", OPTION_NORMAL_MAPS, USES_NORMALS},
                   {"--probes", OPTION_PROBES, USES_PROBES},
                   {"--spacing", OPTION_SPACING, USES_PROBES},
                   {"--bounds", OPTION_BOUNDS, USES_PROBES},
                   {"--lookup", OPTION_LOOKUP, USES_PROBES}};
    const option_value *beside = &a->values[OPTION_BESIDE];
    const unsigned uses = view_mode_of(a)->uses | (beside->given ? modes[beside->choice].uses : 0u);
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by; i++) {
        if ((read_by[i].use & uses) == 0 && a->values[read_by[i].id].given) {
            return usage_error(COMMAND_VIEW, "%s: does not apply to --with %s%s%s", read_by[i].name,
                               a->values[OPTION_WITH].text, beside->given ? " --beside " : "",
                               beside->given ? beside->text : "");
        }
    }
    const bool card = a->values[OPTION_READ].choice == READ_PIXEL;
    if (!card && (a->values[OPTION_GLOSS].given || a->values[OPTION_MEDIA].given)) {
        return usage_error(COMMAND_VIEW, "%s: needs --read pixel",
                           a->values[OPTION_GLOSS].given ? "--gloss" : "--media");
    }
    return field_check(a, models_of(a));
}

bool view_mode_flies(const command_line *a)
{
    return (models_of(a) >> FIELD_AMBIENCE & 1u) != 0;
}

void mode_light_bind_ssao(const mode_light *light)
{
    glBindTextureUnit(TEXTURE_SSAO, light->ssao);
    glUniform1i(UNIFORM_SSAO, light->ssao != 0);
}

void mode_light_destroy(mode_light *light)
{
    gl_lightmap_destroy(&light->lightmap);
    gl_ambient_destroy(&light->ambient);
    gl_lights_destroy(&light->lights);
    gl_field_destroy(&light->field);
    if (light->lpv != NULL) {
        lpv_frame_destroy(light->lpv);
        free(light->lpv);
    }
    field_source_clear(&light->source);
}
