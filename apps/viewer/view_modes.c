// SPDX-License-Identifier: MIT
#include "view_modes.h"

#include "lightmaps.h"
#include "shader_list.h"

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

/// In the order of the choices of --with.
static const view_mode modes[] = {
    {&shader_none_frag, USES_BACKGROUND | USES_PANES, ALP_RENDER_LIGHTMAP, NULL, NULL},
    {&shader_albedo_frag, USES_METALS, ALP_RENDER_ALBEDO, NULL, NULL},
    {&shader_lightmap_frag, USES_METALS | USES_BACKGROUND | USES_LIGHTS | USES_ATLAS | USES_PANES,
     ALP_RENDER_LIGHTMAP, prepare_lightmap, bind_lightmap},
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
                   {"--bounces", OPTION_BOUNCES, USES_LIGHTS},
                   {"--size", OPTION_SIZE, USES_ATLAS},
                   {"--atlas", OPTION_ATLAS, USES_ATLAS},
                   {"--stitch", OPTION_STITCH, USES_ATLAS},
                   {"--texel-samples", OPTION_TEXEL_SAMPLES, USES_ATLAS},
                   {"--seed", OPTION_SEED, USES_ATLAS}};
    const unsigned uses = view_mode_of(a)->uses;
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by; i++) {
        if ((read_by[i].use & uses) == 0 && a->values[read_by[i].id].given) {
            return usage_error(COMMAND_VIEW, "%s: does not apply to --with %s", read_by[i].name,
                               a->values[OPTION_WITH].text);
        }
    }
    return EXIT_DONE;
}

void mode_light_destroy(mode_light *light)
{
    gl_lightmap_destroy(&light->lightmap);
}
