// SPDX-License-Identifier: MIT
#include "lightmaps.h"

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
    const alp_result result = alp_bake(s->scene, &bake, lightmap, NULL);
    alp_lightmap_set_blend(*lightmap, layout.blend);
    return result;
}
