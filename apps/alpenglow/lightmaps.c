// SPDX-License-Identifier: MIT
#include "lightmaps.h"

#include <alpenglow/geometry.h>

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

/// Says of a file with baked light whether the picture shows that light.
static void note_baked_light(session *s, const command_line *a)
{
    const char *text = NULL;
    if (alp_scene_get_info(s->scene).light_maps > 0) {
        text =
            "it names a baked light map (MOZ_lightmap or extras.lightmap), which pictures do not "
            "read: a new one is baked";
    } else if (holds_emitted_light(s->scene)) {
        text = "its surfaces are black and emit a baked light map: the picture shows that map";
    }
    if (text != NULL) {
        const alp_log_message note = {ALP_LOG_NOTE, "baked-light", a->operands[0], text};
        messages_log(&s->messages, &note);
    }
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
    bake.progress = session_progress;
    bake.progress_user = s;
    if ((maps & ALP_MAP_LIGHT) != 0) {
        note_baked_light(s, a);
    }
    const alp_result result = alp_bake(s->scene, &bake, lightmap, NULL);
    alp_lightmap_set_blend(*lightmap, layout.blend);
    return result;
}
