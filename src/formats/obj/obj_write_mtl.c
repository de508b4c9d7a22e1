// SPDX-License-Identifier: MIT
// The material library beside a written OBJ, and the pictures that it names. Occlusion is map_Ka,
// which scales ambient light; most viewers know map_Kd alone, so it is that too where no texture
// takes its place. "alpenglow_occlusion" marks it for our own reader; others pass what they do not
// know.
#include "formats/obj/obj_write.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/images/images.h"

#include <stdio.h>
#include <string.h>

bool alpi_obj_is_occluded(const alpi_obj_writer *w, alpi_obj_use use)
{
    const bool keeps = w->patch->existing_ao == ALPI_EXISTING_AO_KEEP &&
                       use.material != ALPI_NONE &&
                       w->scene->materials[use.material].occlusion_texture.image != ALPI_NONE;
    return use.page != ALPI_NONE && w->patch->page_pngs != NULL && !keeps;
}

bool alpi_obj_is_lit(const alpi_obj_writer *w, alpi_obj_use use)
{
    const bool clear =
        use.material != ALPI_NONE && w->scene->materials[use.material].transmission > 0.0f;
    return use.page != ALPI_NONE && w->patch->light != NULL && !clear;
}

char *alpi_obj_image_path(alp_context *context, const char *stem, const char *kind, uint32_t number,
                          const char *ending)
{
    return number == 0 ? alpi_format(context, "%s.%s%s", stem, kind, ending)
                       : alpi_format(context, "%s.%s.%u%s", stem, kind, number, ending);
}

// --- textures ------------------------------------------------------------------------------------

/// Whether the coordinates that a use is written with are those that a texture reads.
static bool has_coordinates(const alpi_obj_writer *w, alpi_obj_use use, const alpi_texture *texture)
{
    const bool mapped = alpi_obj_is_occluded(w, use) || alpi_obj_is_lit(w, use);
    if (mapped && w->patch->corner_uvs != NULL) {
        return false;
    }
    const uint32_t set = mapped ? w->patch->kept_uv_set : 0;
    return texture->uv_set == set ||
           (w->kept_is_first && texture->uv_set + set == w->patch->kept_uv_set);
}

static const char *const picture_kinds[] = {[ALPI_OBJ_PICTURE_WHOLE] = "image",
                                            [ALPI_OBJ_PICTURE_ROUGHNESS] = "roughness",
                                            [ALPI_OBJ_PICTURE_METALNESS] = "metalness"};

/// A picture, which is opened at its first use; NULL where it cannot be written.
static const alp_image *open_image(alpi_obj_writer *w, uint32_t index)
{
    if (w->images[index] == NULL &&
        alpi_scene_open_image(w->scene, index, &w->images[index]) != ALP_OK) {
        w->mtl.failed = true;
    }
    const alp_image *image = w->images[index];
    return image != NULL && image->info.component == ALP_COMPONENT_U8 ? image : NULL;
}

static void print_place(alpi_obj_writer *w, const alpi_texture *texture)
{
    if (texture->scale[0] != 1.0f || texture->scale[1] != 1.0f || texture->offset[0] != 0.0f ||
        texture->offset[1] != 0.0f) { // back to v from the bottom
        const float values[4] = {texture->scale[0], texture->scale[1], texture->offset[0],
                                 1.0f - texture->offset[1] - texture->scale[1]};
        for (int k = 0; k < 4; k++) {
            alpi_bytes_print(&w->mtl, k == 0 ? "-s " : k == 2 ? "1 -o " : "");
            alpi_bytes_float(&w->mtl, values[k]);
            alpi_bytes_print(&w->mtl, k == 3 ? " 0 " : " ");
        }
    }
    alpi_bytes_print(&w->mtl, "%s", texture->wrap_u == ALPI_WRAP_CLAMP ? "-clamp on " : "");
}

bool alpi_obj_print_texture(alpi_obj_writer *w, alpi_obj_use use, const char *what,
                            const alpi_texture *texture, alpi_obj_picture picture)
{
    if (texture->image == ALPI_NONE || texture->image >= w->scene->image_count) {
        return false;
    }
    const alp_image *image = open_image(w, texture->image);
    if (image == NULL && w->images[texture->image] == NULL) {
        return false; // the reader has warned of it
    }
    if (image == NULL || texture->rotation != 0.0f || texture->wrap_u == ALPI_WRAP_MIRROR ||
        texture->wrap_v == ALPI_WRAP_MIRROR || !has_coordinates(w, use, texture)) {
        w->texture_lost[use.material] = true;
        return false;
    }
    char *path =
        alpi_obj_image_path(w->context, w->stem, picture_kinds[picture], texture->image, ".png");
    if (path == NULL) {
        w->mtl.failed = true;
        return false;
    }
    w->image_used[picture][texture->image] = true;
    alpi_bytes_print(&w->mtl, "%s ", what);
    print_place(w, texture);
    alpi_bytes_print(&w->mtl, "%s\n", alpi_path_name(path));
    alpi_release(w->context, path);
    return true;
}

static bool print_texture(alpi_obj_writer *w, alpi_obj_use use, const char *what,
                          const alpi_texture *texture)
{
    return alpi_obj_print_texture(w, use, what, texture, ALPI_OBJ_PICTURE_WHOLE);
}

void alpi_obj_print_page(alpi_obj_writer *w, const char *what, const char *kind, uint32_t page,
                         const char *ending)
{
    char *path = alpi_obj_image_path(w->context, w->stem, kind, page, ending);
    w->mtl.failed = w->mtl.failed || path == NULL;
    if (path != NULL) {
        alpi_bytes_print(&w->mtl, "%s %s\n", what, alpi_path_name(path));
    }
    alpi_release(w->context, path);
}

// --- materials -----------------------------------------------------------------------------------

void alpi_obj_print_color(alpi_obj_writer *w, const char *what, const float color[3])
{
    alpi_bytes_print(&w->mtl, "%s", what);
    for (int k = 0; k < 3; k++) {
        alpi_bytes_print(&w->mtl, " ");
        alpi_bytes_float(&w->mtl, color[k]);
    }
    alpi_bytes_print(&w->mtl, "\n");
}

/// Diffuse colour, emission and alpha: of the material, or all light as emission.
static void print_colors(alpi_obj_writer *w, alpi_obj_use use, const alpi_material *m)
{
    const bool lit = alpi_obj_is_lit(w, use);
    float color[3], emission[3];
    for (int k = 0; k < 3; k++) {
        color[k] = lit ? 0.0f : m->base_color[k] * alpi_scene_diffuse_share(w->scene, m->metallic);
        emission[k] = m->emission[k];
    }
    if (lit) {
        const uint32_t index = use.material == ALPI_NONE ? w->scene->material_count : use.material;
        emission[0] = emission[1] = emission[2] = w->patch->light->scales[index];
    }
    alpi_obj_print_color(w, "Ka", (const float[3]){1.0f, 1.0f, 1.0f});
    alpi_obj_print_color(w, "Kd", color);
    if (emission[0] > 0.0f || emission[1] > 0.0f || emission[2] > 0.0f) {
        alpi_obj_print_color(w, "Ke", emission);
    }
    alpi_bytes_print(&w->mtl, "d ");
    alpi_bytes_float(&w->mtl, m->alpha_mode == ALPI_ALPHA_BLEND ? m->base_color[3] : 1.0f);
    alpi_bytes_print(&w->mtl, "\n");
    if (lit) {
        alpi_bytes_print(&w->mtl, "illum 1\n");
    } else {
        alpi_obj_print_shine(w, use, m);
    }
}

static void print_maps(alpi_obj_writer *w, alpi_obj_use use, const alpi_material *m)
{
    const bool lit = alpi_obj_is_lit(w, use), occluded = alpi_obj_is_occluded(w, use);
    if (lit) {
        alpi_obj_print_page(w, "map_Ke", "light", use.page, w->patch->light->ending);
        w->light_used[use.page] = true;
    } else {
        print_texture(w, use, "map_Ke", &m->emission_texture);
    }
    if (occluded) {
        alpi_bytes_print(&w->mtl, "alpenglow_occlusion map_Ka\n");
        alpi_obj_print_page(w, "map_Ka", "ao", use.page, ".png");
        w->page_used[use.page] = true;
    } else if (m->occlusion_texture.image != ALPI_NONE && use.page == ALPI_NONE) {
        alpi_bytes_print(&w->mtl, "alpenglow_occlusion map_Ka\n");
        print_texture(w, use, "map_Ka", &m->occlusion_texture);
    }
    const bool textured = !lit && print_texture(w, use, "map_Kd", &m->base_color_texture);
    if (textured && m->alpha_mode == ALPI_ALPHA_MASK) {
        print_texture(w, use, "map_d", &m->base_color_texture);
    } else if (occluded && !textured && !lit) {
        alpi_obj_print_page(w, "map_Kd", "ao", use.page, ".png");
    }
}

/// A name that no other written material has.
static alp_result choose_name(alpi_obj_writer *w, alpi_obj_use use, const alpi_material *m,
                              uint32_t number)
{
    bool added = false;
    uint32_t at;
    alpi_bytes name = alpi_bytes_create(w->context);
    alpi_bytes_print(&name, "%s", use.material == ALPI_NONE ? "none" : m->name);
    for (size_t i = 0; !name.failed && i < name.size; i++) {
        unsigned char c = name.bytes[i];
        const bool edge = i == 0 || i + 1 == name.size; // readers trim blanks there
        name.bytes[i] = c < 0x20 || c == 0x7f || (edge && strchr(" \\", c) != NULL) ? '_' : c;
    }
    if (name.size == 0) {
        alpi_bytes_print(&name, "material_%u", use.material);
    }
    while (!name.failed) {
        if (alpi_obj_names_add(&w->names, name.bytes, name.size, &at, &added) != ALP_OK) {
            name.failed = true;
        }
        if (added || name.failed) {
            break;
        }
        alpi_bytes_print(&name, "_%u", number);
    }
    const bool failed = name.failed;
    alpi_bytes_destroy(&name);
    return failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

void alpi_obj_print_material(alpi_obj_writer *w, alpi_obj_use use)
{
    alpi_material none = alpi_material_default();
    if (w->scene->colors == NULL) { // else viewers multiply by the colours of vertices
        none.base_color[0] = none.base_color[1] = none.base_color[2] = 0.5f;
    }
    const alpi_material *m = use.material == ALPI_NONE ? &none : &w->scene->materials[use.material];
    print_colors(w, use, m);
    print_maps(w, use, m);
}

void alpi_obj_warn_of_textures(alpi_obj_writer *w, const alpi_material *material)
{
    alpi_warn(w->context, "texture-lost", material->name,
              "an OBJ has one set of texture coordinates, which the bake takes, and no turned "
              "or mirrored textures: one of this material is left out; keep the scene's own "
              "set (--atlas keep) or write .glb");
}

alp_result alpi_obj_write_material(alpi_obj_writer *w, alpi_obj_use use, uint32_t *number)
{
    bool added;
    ALP_TRY(alpi_obj_names_add(&w->uses, &use, sizeof use, number, &added));
    if (!added) {
        return ALP_OK;
    }
    const alpi_material *m = use.material == ALPI_NONE ? NULL : &w->scene->materials[use.material];
    ALP_TRY(choose_name(w, use, m, *number));
    const bool lost = m != NULL && w->texture_lost[use.material];
    alpi_bytes_print(&w->mtl, "\nnewmtl %s\n", alpi_obj_name(&w->names, *number));
    alpi_obj_print_material(w, use);
    if (m != NULL && w->texture_lost[use.material] && !lost) {
        alpi_obj_warn_of_textures(w, m);
    }
    return w->mtl.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

// --- pictures ------------------------------------------------------------------------------------

/// One channel of a picture.
static alp_result take_channel(alp_context *context, const alp_image *from, int channel,
                               alp_image **image)
{
    alp_image_info info = from->info;
    info.channels = 1;
    ALP_TRY(alp_image_create(context, info, image));
    uint8_t *texel = (*image)->pixels;
    for (uint32_t y = 0; y < info.height; y++) {
        for (uint32_t x = 0; x < info.width; x++) {
            float rgba[4];
            alpi_image_pixel(from, x, y, rgba);
            *texel++ = (uint8_t)(rgba[channel] * 255.0f + 0.5f);
        }
    }
    return ALP_OK;
}

static alp_result add_picture(alpi_obj_writer *w, alpi_output_files *files, uint32_t index,
                              int kind)
{
    uint8_t *png = NULL;
    size_t size = 0;
    alp_image *channel = NULL;
    const alp_image *image = w->images[index];
    alp_result result = ALP_OK;
    if (kind != ALPI_OBJ_PICTURE_WHOLE) {
        result =
            take_channel(w->context, image, kind == ALPI_OBJ_PICTURE_ROUGHNESS ? 1 : 2, &channel);
        image = channel;
    }
    if (result == ALP_OK) {
        result = alpi_png_encode(image, &png, &size);
    }
    alp_image_destroy(channel);
    ALP_TRY(result);
    char *path = alpi_obj_image_path(w->context, w->stem, picture_kinds[kind], index, ".png");
    return alpi_output_files_add(files, (alpi_output_file){path, png, size, png});
}

alp_result alpi_obj_add_images(alpi_obj_writer *w, alpi_output_files *files)
{
    const alpi_mesh_patch *patch = w->patch;
    for (uint32_t p = 0; p < patch->page_count; p++) {
        if (w->page_used[p]) {
            ALP_TRY(alpi_output_files_add(
                files, (alpi_output_file){alpi_obj_image_path(w->context, w->stem, "ao", p, ".png"),
                                          patch->page_pngs[p], patch->page_png_sizes[p], NULL}));
        }
        if (w->light_used[p]) {
            ALP_TRY(alpi_output_files_add(
                files,
                (alpi_output_file){
                    alpi_obj_image_path(w->context, w->stem, "light", p, patch->light->ending),
                    patch->light->pages[p], patch->light->page_sizes[p], NULL}));
        }
    }
    for (uint32_t i = 0; i < w->scene->image_count; i++) {
        for (int kind = 0; kind < ALPI_OBJ_PICTURE_COUNT; kind++) {
            if (w->image_used[kind][i]) {
                ALP_TRY(add_picture(w, files, i, kind));
            }
        }
    }
    return ALP_OK;
}
