// SPDX-License-Identifier: MIT
#include "lightmaps.h"

// Choices of --atlas, in its order.
static const struct {
    alp_atlas_mode mode;
    alp_blend blend;
} layouts[] = {{ALP_ATLAS_AUTO, ALP_BLEND_NORMAL},
               {ALP_ATLAS_KEEP, ALP_BLEND_NORMAL},
               {ALP_ATLAS_CHARTS, ALP_BLEND_NORMAL},
               {ALP_ATLAS_BLEND, ALP_BLEND_NORMAL},
               {ALP_ATLAS_BLEND, ALP_BLEND_AVERAGE}};

alp_blend lightmap_blend(const command_line *a)
{
    return layouts[a->values[OPTION_ATLAS].choice].blend;
}

alp_result lightmap_bake(session *s, const command_line *a, const alp_render_options *o,
                         alp_lightmap **lightmap)
{
    alp_bake_options bake = alp_bake_options_default();
    bake.maps = ALP_MAP_LIGHT;
    bake.atlas = o->atlas;
    bake.atlas.mode = layouts[a->values[OPTION_ATLAS].choice].mode;
    bake.stitch = a->values[OPTION_STITCH].choice == 1;
    bake.occlusion = o->occlusion;
    bake.light.lighting = o->lighting;
    bake.light.bounces = o->bounces;
    bake.light.samples = (uint32_t)a->values[OPTION_TEXEL_SAMPLES].whole;
    bake.progress = session_progress;
    bake.progress_user = s;
    const alp_result result = alp_bake(s->scene, &bake, lightmap, NULL);
    alp_lightmap_set_blend(*lightmap, lightmap_blend(a));
    return result;
}
