// SPDX-License-Identifier: MIT
// Pictures of every method that works in parallel have the same bits for any workers.
#include "test_support.h"

#include <stdlib.h>

enum { WIDTH = 24, HEIGHT = 16 };

typedef float picture[WIDTH * HEIGHT][4];

static void draw(uint32_t workers, const void *wanted, void *pixels)
{
    const alp_render_method method = *(const alp_render_method *)wanted;
    alp_context *context = test_context(workers);
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alp_image *image = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:cornell", &scene));
    alp_render_options o = alp_render_options_default();
    o.method = method;
    o.width = WIDTH;
    o.height = HEIGHT;
    o.samples = 16;
    o.occlusion.samples = 32;
    o.atlas.size = 32;
    if (method == ALP_RENDER_LIGHTMAP) {
        alp_bake_options bake = alp_bake_options_default();
        bake.maps = ALP_MAP_LIGHT;
        bake.atlas.size = 32;
        bake.light.samples = 16;
        ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL));
        o.lightmap = lightmap;
    }
    ASSERT_OK(context, alp_render(scene, &o, &image));
    memcpy(pixels, alp_image_floats(image), sizeof(picture));
    alp_image_destroy(image);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(workers_change_no_bit)
{
    static const alp_render_method methods[] = {ALP_RENDER_AO, ALP_RENDER_REFERENCE,
                                                ALP_RENDER_RADIOSITY, ALP_RENDER_LIGHTMAP};
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        free(test_any_workers(draw, &methods[m], sizeof(picture)));
    }
}
