// SPDX-License-Identifier: MIT
#include "setup/lightmaps.h"

#include "setup/lighting.h"

#include <alpenglow/geometry.h>

#include <stdio.h>
#include <string.h>

/// Choices of --atlas, in its order.
static const lightmap_layout layouts[] = {{ALP_ATLAS_AUTO, ALP_BLEND_NORMAL},
                                          {ALP_ATLAS_KEEP, ALP_BLEND_NORMAL},
                                          {ALP_ATLAS_CHARTS, ALP_BLEND_NORMAL},
                                          {ALP_ATLAS_BLEND, ALP_BLEND_NORMAL},
                                          {ALP_ATLAS_BLEND, ALP_BLEND_AVERAGE}};

lightmap_layout lightmap_layout_of(const command_line *a)
{
    return layouts[a->values[OPTION_ATLAS].choice];
}

/// Whether a surface is black and emits by a texture, as bake --lightmap-as emissive leaves it.
static bool emits_baked_light(const alp_material_info *m)
{
    const float *color = m->base_color;
    return m->emission_texture.image != ALP_NONE && color[0] == 0.0f && color[1] == 0.0f &&
           color[2] == 0.0f;
}

/// Whether all surfaces are so, but for panes, which that bake leaves as they are.
static bool holds_emitted_light(const alp_scene *scene)
{
    const uint32_t count = alp_scene_get_info(scene).surfaces;
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        const alp_material_info m =
            alp_scene_get_material(scene, alp_scene_get_surface(scene, i).material_index);
        const bool emits = emits_baked_light(&m);
        if (!emits && m.transmission == 0.0f) {
            return false;
        }
        any = any || emits;
    }
    return any;
}

/// The first given option that asks for a new map, or NULL.
static const char *option_of_bake(const command_line *a)
{
    static const option_id of_bake[] = {
        OPTION_QUALITY, OPTION_ERROR, OPTION_GATHER, OPTION_BOUNCES, OPTION_LAMP,
        OPTION_SPOT,    OPTION_SIZE,  OPTION_ATLAS,  OPTION_STITCH,  OPTION_TEXEL_SAMPLES};
    return option_find_given(a, of_bake, sizeof of_bake / sizeof *of_bake);
}

static void note(session *s, const command_line *a, const char *text)
{
    messages_log(&s->messages,
                 &(alp_log_message){ALP_LOG_NOTE, "baked-light", a->operands[0], text});
}

/// Says what is shown of a file whose surfaces emit baked light.
static void note_emitted(session *s, const command_line *a)
{
    const char *asks = option_of_bake(a);
    char text[256] =
        "its surfaces are black and emit a baked light map: the picture shows that map";
    if (asks != NULL) {
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length,
                 ", and %s changes nothing; for a new map, give it with the scene before that bake",
                 asks);
    }
    note(s, a, text);
}

/// Says what is shown of a file that names baked light.
static void note_named(session *s, const command_line *a)
{
    const char *asks = option_of_bake(a);
    char text[160];
    if (asks == NULL) {
        note(s, a,
             "the picture shows the light map that the file holds; --quality medium bakes a new "
             "one");
        return;
    }
    snprintf(text, sizeof text,
             "it holds a baked light map, but %s asks for a new one; leave it out to see that of "
             "the file",
             asks);
    note(s, a, text);
}

/// Whether a material of the scene has a map of occlusion.
static bool holds_occlusion(const alp_scene *scene)
{
    const uint32_t count = alp_scene_get_info(scene).surfaces;
    for (uint32_t i = 0; i < count; i++) {
        const alp_material_info m =
            alp_scene_get_material(scene, alp_scene_get_surface(scene, i).material_index);
        if (m.occlusion_texture.image != ALP_NONE) {
            return true;
        }
    }
    return false;
}

alp_result lightmap_find(session *s, const command_line *a, bool *found)
{
    const bool named = alp_scene_get_info(s->scene).light_maps > 0;
    const bool emitted = !named && holds_emitted_light(s->scene);
    *found = emitted || (named && option_of_bake(a) == NULL);
    if (emitted) {
        note_emitted(s, a);
    } else if (named) {
        note_named(s, a);
    } else if (holds_occlusion(s->scene)) {
        note(s, a,
             "it holds occlusion, and no light map: a new one is baked; --with ao shows the "
             "occlusion");
    }
    return *found ? alp_scene_read_light_maps(s->scene) : ALP_OK;
}

/// Says of a file with baked light whether the picture shows that light.
static void note_baked_light(session *s, const command_line *a)
{
    if (alp_scene_get_info(s->scene).light_maps > 0) {
        note(s, a,
             "it names a baked light map (MOZ_lightmap or extras.lightmap), which view does not "
             "show: a new one is baked; render --with lightmap shows that of the file");
    } else if (holds_emitted_light(s->scene)) {
        note(s, a, "its surfaces are black and emit a baked light map: the picture shows that map");
    }
}

int lightmap_check(const command_line *a)
{
    float error;
    const int code = error_read(a, &error);
    return code == EXIT_DONE && error > 0.0f ? error_check_light(a, OPTION_TEXEL_SAMPLES) : code;
}

alp_result lightmap_bake(session *s, const command_line *a, const alp_render_options *o,
                         unsigned maps, lightmap_layout layout, alp_lightmap **lightmap)
{
    alp_bake_options bake = alp_bake_options_default();
    bake.maps = maps;
    bake.atlas = o->atlas;
    bake.atlas.mode = layout.mode;
    bake.stitch = a->values[OPTION_STITCH].choice == 1;
    bake.occlusion = o->occlusion;
    bake.occluders = o->occluders;
    bake.light.lighting = o->lighting;
    bake.light.bounces = o->bounces;
    bake.light.samples = (uint32_t)a->values[OPTION_TEXEL_SAMPLES].whole;
    bake.light.gather = (alp_gather)a->values[OPTION_GATHER].choice;
    (void)error_read(a, &bake.sampling.error); // lightmap_check found no fault
    bake.light.error = bake.sampling.error;
    bake.progress = session_progress;
    bake.progress_user = s;
    if ((maps & ALP_MAP_LIGHT) != 0 && a->command == COMMAND_VIEW) {
        note_baked_light(s, a);
    }
    const alp_result result = alp_bake(s->scene, &bake, lightmap, NULL);
    alp_lightmap_set_blend(*lightmap, layout.blend);
    return result;
}
