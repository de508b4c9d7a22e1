// SPDX-License-Identifier: MIT
// The maps of a bake as plain arrays: texture coordinates of every corner and a page of floats, for
// an engine that uploads them itself. The page is also saved as a picture to look at.
//
//     cc 03_maps_as_arrays.c -o maps $(pkg-config --cflags --libs alpenglow)
#include <alpenglow/alpenglow.h>
#include <stdio.h>

/// Texel that a texture coordinate in [0, 1] lies in.
static uint32_t texel_of(float coordinate, uint32_t size)
{
    uint32_t texel = (uint32_t)(coordinate * (float)size);
    return texel < size ? texel : size - 1;
}

/// Accessibility in the middle of a triangle, looked up as a shader would do it.
static float look_up(const alp_lightmap *lightmap, uint32_t triangle)
{
    const alp_atlas *atlas = alp_lightmap_atlas(lightmap);
    const float *uv = alp_atlas_corner_uvs(atlas) + 6 * (size_t)triangle;
    uint32_t width = 0, height = 0, page = alp_atlas_triangle_pages(atlas)[triangle];
    const float *texels = alp_lightmap_page(lightmap, page, &width, &height);
    uint32_t x = texel_of((uv[0] + uv[2] + uv[4]) / 3.0f, width);
    uint32_t y = texel_of((uv[1] + uv[3] + uv[5]) / 3.0f, height); // v = 0 is row 0
    return texels[4 * ((size_t)y * width + x)];                    // R = G = B, then coverage
}

/// Saves a page as an 8-bit grey picture.
static alp_result save_page(alp_context *context, const alp_lightmap *lightmap, const char *path)
{
    alp_image_info info = {.channels = 1, .component = ALP_COMPONENT_U8};
    const float *texels = alp_lightmap_page(lightmap, 0, &info.width, &info.height);
    alp_image *image = NULL;
    alp_result result = alp_image_create(context, info, &image);
    if (result != ALP_OK) {
        return result;
    }
    uint8_t *bytes = alp_image_bytes(image);
    for (size_t i = 0; i < (size_t)info.width * info.height; i++) {
        bytes[i] = (uint8_t)(255.0f * texels[4 * i] + 0.5f);
    }
    result = alp_image_save(image, path, true);
    alp_image_destroy(image);
    return result;
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, "builtin:cornell", &scene);
    }
    if (result == ALP_OK) {
        alp_bake_options options = alp_bake_options_default(); // no output: nothing is written
        options.atlas.size = 128;
        options.occlusion.samples = 64;
        result = alp_bake(scene, &options, &lightmap, NULL);
    }
    if (result == ALP_OK) {
        for (uint32_t i = 0; i < alp_scene_get_info(scene).surfaces; i++) {
            alp_surface_info surface = alp_scene_get_surface(scene, i);
            printf("%-12s accessibility %.3f\n", surface.name,
                   look_up(lightmap, surface.first_triangle));
        }
        result = save_page(context, lightmap, "page.png");
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result),
                context ? alp_context_message(context) : "no context");
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
