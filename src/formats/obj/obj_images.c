// SPDX-License-Identifier: MIT
// Pictures that materials name. One that cannot be read costs a warning, because its material still
// has a colour.
#include "formats/obj/obj.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/images/images.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define IMAGE_FILE_LIMIT ((uint64_t)1 << 30)

static void mark(const alpi_texture *texture, bool *needed)
{
    if (texture->image != ALPI_NONE) {
        needed[texture->image] = true;
    }
}

static void mark_images(const alp_scene *scene, bool *needed)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (scene->surfaces[s].material != ALPI_NONE) {
            const alpi_material *m = &scene->materials[scene->surfaces[s].material];
            mark(&m->base_color_texture, needed);
            mark(&m->metallic_texture, needed);
            mark(&m->emission_texture, needed);
            mark(&m->occlusion_texture, needed);
        }
    }
}

/// Decodes a file; NULL, with a warning, where it cannot be read.
static alp_result read_file(const alpi_obj *obj, const char *name, alp_image **image)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    *image = NULL;
    char *path = alpi_obj_path(obj, name);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_file_read(obj->context, path, IMAGE_FILE_LIMIT, &bytes, &size);
    if (result == ALP_OK) {
        result = alpi_image_decode(obj->context, path, bytes, size, image);
    }
    alpi_release(obj->context, bytes);
    alpi_release(obj->context, path);
    if (result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY) {
        return result;
    }
    char reason[512];
    snprintf(reason, sizeof reason, "%s", alp_context_message(obj->context));
    alpi_warn(obj->context, "image", name, "%s; its materials are read without this texture",
              reason);
    return ALP_OK;
}

// --- masks ---------------------------------------------------------------------------------------

/// Whether a picture has alpha that is not 1 everywhere: the mask then, else red is.
static bool has_alpha(const alp_image *mask)
{
    for (uint32_t y = 0; y < mask->info.height; y++) {
        for (uint32_t x = 0; x < mask->info.width; x++) {
            float rgba[4];
            alpi_image_pixel(mask, x, y, rgba);
            if (rgba[3] < 1.0f) {
                return true;
            }
        }
    }
    return false;
}

static uint8_t to_byte(float value)
{
    return (uint8_t)(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f + 0.5f);
}

/// Colours (NULL: white) with a mask as alpha, in the larger size of both.
static alp_result join(alp_context *context, const alp_image *colors, const alp_image *mask,
                       alp_image **image)
{
    const alpi_sampler sampler = {ALPI_WRAP_REPEAT, ALPI_WRAP_REPEAT, false};
    const int channel = has_alpha(mask) ? 3 : 0;
    alp_image_info info = mask->info;
    if (colors != NULL) {
        info.width = colors->info.width > info.width ? colors->info.width : info.width;
        info.height = colors->info.height > info.height ? colors->info.height : info.height;
    }
    info.channels = 4;
    info.component = ALP_COMPONENT_U8;
    ALP_TRY(alp_image_create(context, info, image));
    uint8_t *texel = (*image)->pixels;
    for (uint32_t y = 0; y < info.height; y++) {
        for (uint32_t x = 0; x < info.width; x++, texel += 4) {
            const float u = ((float)x + 0.5f) / (float)info.width;
            const float v = ((float)y + 0.5f) / (float)info.height;
            float color[4] = {1.0f, 1.0f, 1.0f, 1.0f}, cut[4];
            if (colors != NULL) {
                alpi_image_sample(colors, u, v, sampler, color);
            }
            alpi_image_sample(mask, u, v, sampler, cut);
            for (int k = 0; k < 3; k++) {
                texel[k] = to_byte(color[k]);
            }
            texel[3] = to_byte(cut[channel]);
        }
    }
    return ALP_OK;
}

/// "COLOURS\nMASK": a picture of both. Without a mask the colours stay alone, without colours the
/// mask does.
static alp_result read_joined(const alpi_obj *obj, const char *name, const char *mask_name,
                              alp_image **image)
{
    alp_image *colors = NULL, *mask = NULL;
    char *color_name = alpi_format(obj->context, "%.*s", (int)(mask_name - name - 1), name);
    alp_result result = color_name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK && color_name[0] != '\0') {
        result = read_file(obj, color_name, &colors);
    }
    if (result == ALP_OK) {
        result = read_file(obj, mask_name, &mask);
    }
    if (result == ALP_OK && mask != NULL) {
        result = join(obj->context, colors, mask, image);
    } else if (result == ALP_OK) {
        *image = alpi_image_share(colors);
    }
    alpi_release(obj->context, color_name);
    alp_image_destroy(colors);
    alp_image_destroy(mask);
    return result;
}

alp_result alpi_obj_read_image(const alpi_obj *obj, const char *name, alp_image **image)
{
    const char *line = strchr(name, '\n');
    *image = NULL;
    return line != NULL ? read_joined(obj, name, line + 1, image) : read_file(obj, name, image);
}

alp_result alpi_obj_read_images(const alpi_obj *obj, const alpi_obj_names *images, alp_scene *scene)
{
    bool *needed = ALPI_NEW(obj->context, bool, images->count);
    scene->images = ALPI_NEW(obj->context, alp_image *, images->count);
    alp_result result = needed == NULL || scene->images == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK) {
        scene->image_count = images->count;
        mark_images(scene, needed);
    }
    for (uint32_t i = 0; result == ALP_OK && i < images->count; i++) {
        if (needed[i]) {
            result = alpi_obj_read_image(obj, alpi_obj_name(images, i), &scene->images[i]);
        }
    }
    alpi_release(obj->context, needed);
    return result;
}
