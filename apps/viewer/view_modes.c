// SPDX-License-Identifier: MIT
#include "view_modes.h"

#include "fields.h"
#include "lightmaps.h"
#include "shader_list.h"
#include "shaders/bindings.h"

static int prepare_lightmap(session *s, const command_line *a, const alp_render_options *o,
                            mode_light *light)
{
    alp_lightmap *lightmap = NULL;
    const alp_result result = lightmap_bake(s, a, o, &lightmap);
    const int code = result == ALP_OK ? gl_lightmap_create(s->scene, lightmap, lightmap_blend(a),
                                                           &light->lightmap)
                                      : session_end(s, result);
    alp_lightmap_destroy(lightmap);
    return code;
}

static void bind_lightmap(const mode_light *light)
{
    gl_lightmap_bind(&light->lightmap);
}

static int prepare_ambient(session *s, const command_line *a, const alp_render_options *o,
                           mode_light *light)
{
    field_source source = {0};
    const alp_result result = field_fit(s, a, view_mode_of(a)->model, &o->lighting, &source);
    if (result == ALP_OK) {
        gl_ambient_create(source.field, &light->ambient);
    }
    field_source_clear(&source);
    return result == ALP_OK ? EXIT_DONE : session_end(s, result);
}

static int prepare_direct(session *s, const command_line *a, const alp_render_options *o,
                          mode_light *light)
{
    (void)a;
    (void)o;
    if (light->lights.count == 0) {
        session_warn(s, "no-light", "--with direct",
                     "no lamp and no sun shines, and surfaces have their emission alone; give "
                     "--sun, --lamp or --spot");
    }
    return EXIT_DONE;
}

static int prepare_paths(session *s, const command_line *a, const alp_render_options *o,
                         mode_light *light)
{
    (void)s;
    light->paths =
        (path_picture){.options = *o, .samples = (uint32_t)a->values[OPTION_SAMPLES].whole};
    light->paths.options.method = ALP_RENDER_REFERENCE;
    light->paths.options.without_direct = a->values[OPTION_DIRECT].choice == 0;
    return EXIT_DONE;
}

static void bind_lights(const mode_light *light)
{
    gl_lights_bind(&light->lights);
}

static void bind_ambient(const mode_light *light)
{
    gl_ambient_bind(&light->ambient);
    glBindTextureUnit(TEXTURE_SSAO, light->ssao);
    glUniform1i(UNIFORM_SSAO, light->ssao != 0);
    gl_lights_bind(&light->lights);
}

enum {
    LIT = USES_METALS | USES_BACKGROUND | USES_LIGHTS | USES_PANES,
    MAPPED = LIT | USES_BOUNCES | USES_ATLAS | USES_SEED,
    FITTED = LIT | USES_BOUNCES | USES_SEED | USES_SWITCH | USES_DIRECT | USES_SSAO,
    TRACED = LIT | USES_BOUNCES | USES_SEED | USES_SWITCH | USES_PATHS
};

/// In the order of the choices of --with.
static const view_mode modes[] = {
    {.fragment = &shader_none_frag,
     .uses = USES_BACKGROUND | USES_PANES,
     .method = ALP_RENDER_LIGHTMAP},
    {.fragment = &shader_albedo_frag, .uses = USES_METALS, .method = ALP_RENDER_ALBEDO},
    {.fragment = &shader_lightmap_frag,
     .uses = MAPPED,
     .method = ALP_RENDER_LIGHTMAP,
     .prepare = prepare_lightmap,
     .bind = bind_lightmap},
    {.fragment = &shader_direct_frag,
     .uses = LIT | USES_DIRECT,
     .method = ALP_RENDER_FIELD,
     .prepare = prepare_direct,
     .bind = bind_lights},
    {.fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .model = ALP_AMBIENT_CONSTANT,
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .model = ALP_AMBIENT_HEMISPHERE,
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .model = ALP_AMBIENT_GROUND_MAP,
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .model = ALP_AMBIENT_CUBE,
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.fragment = &shader_ambient_frag,
     .uses = FITTED,
     .method = ALP_RENDER_FIELD,
     .model = ALP_AMBIENT_ENVIRONMENT,
     .prepare = prepare_ambient,
     .bind = bind_ambient},
    {.fragment = &shader_none_frag,
     .uses = TRACED,
     .method = ALP_RENDER_REFERENCE,
     .prepare = prepare_paths},
};

const view_mode *view_mode_of(const command_line *a)
{
    return &modes[a->values[OPTION_WITH].choice];
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
                   {"--atlas", OPTION_ATLAS, USES_ATLAS},
                   {"--stitch", OPTION_STITCH, USES_ATLAS},
                   {"--texel-samples", OPTION_TEXEL_SAMPLES, USES_ATLAS},
                   {"--samples", OPTION_SAMPLES, USES_PATHS},
                   {"--ssao", OPTION_SSAO, USES_SSAO},
                   {"--ssao-radius", OPTION_SSAO_RADIUS, USES_SSAO},
                   {"--seed", OPTION_SEED, USES_SEED}};
    const option_value *beside = &a->values[OPTION_BESIDE];
    const unsigned uses = view_mode_of(a)->uses | (beside->given ? modes[beside->choice].uses : 0u);
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by; i++) {
        if ((read_by[i].use & uses) == 0 && a->values[read_by[i].id].given) {
            return usage_error(COMMAND_VIEW, "%s: does not apply to --with %s%s%s", read_by[i].name,
                               a->values[OPTION_WITH].text, beside->given ? " --beside " : "",
                               beside->given ? beside->text : "");
        }
    }
    return EXIT_DONE;
}

void mode_light_destroy(mode_light *light)
{
    gl_lightmap_destroy(&light->lightmap);
    gl_ambient_destroy(&light->ambient);
    gl_lights_destroy(&light->lights);
}
