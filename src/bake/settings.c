// SPDX-License-Identifier: MIT
// Choices that follow from the options of a bake.
#include "bake/settings.h"

#include "base/file.h"

bool alpi_bake_wants_occlusion(const alp_bake_options *o)
{
    return (o->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
}

bool alpi_bake_wants_light(const alp_bake_options *o)
{
    return (o->maps & ALP_MAP_LIGHT) != 0;
}

bool alpi_bake_lights_apart(const alp_bake_options *o)
{
    return alpi_bake_wants_light(o) && o->light.direct == ALP_DIRECT_APART;
}

// --- files ---------------------------------------------------------------------------------------

bool alpi_bake_is_viewer_file(const alp_bake_options *o)
{
    return o->lightmap_as == ALP_LIGHTMAP_AS_THREE || o->lightmap_as == ALP_LIGHTMAP_AS_BABYLON;
}

const char *alpi_bake_viewer_ending(const alp_bake_options *o)
{
    return o->lightmap_as == ALP_LIGHTMAP_AS_THREE ? ".json" : ".babylon";
}

bool alpi_bake_is_gltf(const alp_bake_options *o)
{
    return alpi_path_has_ending(o->output, ".glb") || alpi_path_has_ending(o->output, ".gltf");
}

bool alpi_bake_exports(const alp_bake_options *o, const alp_scene *scene)
{
    const alpi_attachment *from = scene->attachments;
    if (o->output == NULL) {
        return false;
    }
    return alpi_path_has_ending(o->output, ".dae")
               ? from[ALPI_ATTACHMENT_COLLADA].data == NULL
               : !alpi_bake_is_gltf(o) || from[ALPI_ATTACHMENT_DOCUMENT].data == NULL;
}

alp_light_units alpi_bake_light_units(const alp_bake_options *o)
{
    if (o->light_units != ALP_LIGHT_UNITS_AUTO) {
        return o->light_units;
    }
    return o->lightmap_as == ALP_LIGHTMAP_AS_EMISSIVE ? ALP_LIGHT_RADIANCE : ALP_LIGHT_IRRADIANCE;
}
