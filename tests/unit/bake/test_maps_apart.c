// SPDX-License-Identifier: MIT
// A map has the same values whatever other maps are baked with it, and whatever is asked of those.
#include "test_support.h"

#include "scene/scene.h"

#include <string.h>

enum { SIZE = 96, TEXELS = SIZE * SIZE };

/// Bakes maps of a scene and gives the page of its light.
static void bake(const alp_scene *scene, unsigned maps, const alp_occlusion_options *occlusion,
                 float *out)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.maps = maps;
    options.occlusion = *occlusion;
    options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    options.light.samples = 16;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alp_bake(scene, &options, &lightmap, NULL));
    const float *page = alp_lightmap_map_page(lightmap, ALP_MAP_LIGHT, 0, NULL, NULL);
    assert_non_null(page);
    memcpy(out, page, (size_t)4 * TEXELS * sizeof *page);
    alp_lightmap_destroy(lightmap);
}

/// Texels that light looks for closely are found by short rays: of the cone, the numbers and the
/// quickness of the occlusion's they were others.
TEST_WITH_CONTEXT(light_is_what_it_is_alone, 2)
{
    static float alone[4 * TEXELS], beside[4 * TEXELS];
    alp_scene *scene = test_load(context, "builtin:torus-plane");
    alp_occlusion_options options[4];
    for (int i = 0; i < 4; i++) {
        options[i] = alp_occlusion_options_default();
        options[i].samples = 32;
    }
    options[1].samples = 20; // not squares of cells
    options[2].cone = 0.7f;
    options[3].distribution = ALP_DISTRIBUTION_UNIFORM;
    const alp_occlusion_options none = alp_occlusion_options_default();
    bake(scene, ALP_MAP_LIGHT, &none, alone);
    for (int i = 0; i < 4; i++) {
        bake(scene, ALP_MAP_AO | ALP_MAP_LIGHT, &options[i], beside);
        for (int k = 0; k < 4 * TEXELS; k++) {
            if (!(alone[k] == beside[k])) {
                fail_msg("case %d: light is another one with occlusion beside it", i);
            }
        }
    }
    alp_scene_destroy(scene);
}
