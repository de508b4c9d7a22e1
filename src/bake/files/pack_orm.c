// SPDX-License-Identifier: MIT
// --ao-into orm: packs occlusion into the red channel of an image that a material reads already.
// The image holds roughness (green) and metalness (blue), as glTF 2.0 packs them (section 3.9.3).
// It can hold occlusion if each of its texels belongs to one place of the scene at most.
#include "bake/files/pack_orm.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <string.h>

// --- which materials could -----------------------------------------------------------------------

/// The texture whose image and coordinates a material's occlusion could go to, or NULL.
static const alpi_texture *target_texture(const alpi_bake_job *job, uint32_t material)
{
    if (material == ALPI_NONE) {
        return NULL;
    }
    const alpi_material *m = &job->scene->materials[material];
    bool keeps = job->options.existing_ao == ALP_EXISTING_AO_KEEP;
    if (keeps && m->occlusion_texture.image != ALPI_NONE) {
        return NULL;
    }
    const alpi_texture *texture =
        m->metallic_texture.image != ALPI_NONE ? &m->metallic_texture : &m->occlusion_texture;
    return texture->image != ALPI_NONE ? texture : NULL;
}

/// Lists for every surface the texture by which it reads `image`; NULL = it does not.
/// @return false: no surface with triangles reads the image
static bool find_readers(const alpi_bake_job *job, uint32_t image, const alpi_texture **textures)
{
    const alp_scene *scene = job->scene;
    bool any = false;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        const alpi_texture *texture = target_texture(job, surface->material);
        textures[s] = texture != NULL && texture->image == image ? texture : NULL;
        for (uint32_t i = 0; textures[s] != NULL && !any && i < surface->triangle_count; i++) {
            any = scene->triangle_usable[surface->first_triangle + i];
        }
    }
    return any;
}

static alp_result give_reason(const alpi_bake_job *job, const char *text, char **reason)
{
    *reason = alpi_copy_string(job->context, text);
    return *reason == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result check_storage(const alpi_bake_job *job, uint32_t image, alpi_image_source *source,
                                char **reason)
{
    const alp_image *pixels = job->scene->images[image];
    ALP_TRY(alpi_gltf_image_source(job->scene, image, source));
    if (source->encoding == ALPI_IMAGE_ENCODING_PNG_16) {
        return give_reason(job, "16 bits a channel would become 8", reason);
    }
    if (pixels == NULL || pixels->info.component != ALP_COMPONENT_U8 ||
        source->encoding == ALPI_IMAGE_ENCODING_OTHER) {
        return give_reason(job, "it could not be read as PNG, JPEG or WebP", reason);
    }
    return ALP_OK;
}

/// Finds the reason why an image cannot hold the occlusion of the surfaces that read it; NULL = it
/// can.
static alp_result check_image(const alpi_bake_job *job, uint32_t image,
                              const alpi_texture *const *textures, alpi_image_source *source,
                              char **reason)
{
    *reason = NULL;
    for (uint32_t s = 0; s < job->scene->surface_count && job->only != NULL; s++) {
        if (textures[s] != NULL && !job->only[s]) {
            ALP_TRY(alpi_gltf_image_source(job->scene, image, source));
            return give_reason(job, "a surface that is not baked reads it too", reason);
        }
    }
    ALP_TRY(check_storage(job, image, source, reason));
    if (*reason != NULL) {
        return ALP_OK;
    }
    const alp_image_info *info = &job->scene->images[image]->info;
    alp_atlas *layout = NULL;
    alp_result result =
        alpi_uv_layout_create(job->scene, textures, info->width, info->height, &layout, reason);
    if (result == ALP_OK) {
        result = alpi_uv_layout_check(layout, reason);
    }
    alp_atlas_destroy(layout);
    return result == ALP_ERROR_INVALID_DATA && *reason != NULL ? ALP_OK : result;
}

// --- the plan ------------------------------------------------------------------------------------

/// Gives an image to the materials that read it, or warns with the reason why not.
static void assign_materials(alpi_bake_job *job, uint32_t image, const alpi_image_source *source,
                             const char *reason)
{
    alpi_packing *packing = &job->packing;
    for (uint32_t m = 0; m < job->scene->material_count; m++) {
        const alpi_texture *texture = target_texture(job, m);
        if (texture == NULL || texture->image != image) {
            continue;
        }
        if (reason == NULL) {
            packing->material_targets[m] = packing->count;
            continue;
        }
        bool used = false;
        for (uint32_t s = 0; s < job->scene->surface_count && !used; s++) {
            used = job->scene->surfaces[s].material == m;
        }
        if (used) {
            alpi_warn(
                job->context, "ao-not-packed", job->scene->name,
                "material %u (%s): its occlusion gets a separate map and is not packed into %s: "
                "%s",
                m, job->scene->materials[m].name, source->name, reason);
        }
    }
    if (reason == NULL) {
        packing->targets[packing->count++] = (alpi_pack_target){.image = image};
        const char *kind = source->encoding == ALPI_IMAGE_ENCODING_JPEG   ? "JPEG"
                           : source->encoding == ALPI_IMAGE_ENCODING_WEBP ? "WebP"
                                                                          : NULL;
        alpi_note(job->context, "ao-packed", job->scene->name,
                  "occlusion goes into the red channel of %s%s%s%s", source->name,
                  kind != NULL ? ", which is a " : "", kind != NULL ? kind : "",
                  kind != NULL ? " and becomes a PNG, so that its other channels stay unchanged"
                               : "");
    }
}

static alp_result plan_image(alpi_bake_job *job, uint32_t image, const alpi_texture **textures,
                             bool *found)
{
    if (!find_readers(job, image, textures)) {
        return ALP_OK;
    }
    *found = true;
    alpi_image_source source = {0};
    char *reason = NULL;
    alp_result result =
        check_image(job, image, (const alpi_texture *const *)textures, &source, &reason);
    if (result == ALP_OK) {
        assign_materials(job, image, &source, reason);
    }
    alpi_release(job->context, reason);
    return result;
}

alp_result alpi_bake_plan_packing(alpi_bake_job *job)
{
    const alp_scene *scene = job->scene;
    alpi_packing *packing = &job->packing;
    if (job->options.ao_into != ALP_AO_INTO_ORM) {
        return ALP_OK;
    }
    if (job->options.output == NULL) {
        alpi_note(job->context, "ao-not-packed", scene->name,
                  "occlusion is packed into images of an asset, and there is no output; give one");
        return ALP_OK;
    }
    ALPI_TRY_NEW(job->context, packing->targets, scene->image_count);
    ALPI_TRY_NEW(job->context, packing->material_targets, scene->material_count);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        packing->material_targets[m] = ALPI_NONE;
    }
    const alpi_texture **textures =
        ALPI_NEW(job->context, const alpi_texture *, scene->surface_count);
    alp_result result = textures == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    bool found = false;
    for (uint32_t i = 0; result == ALP_OK && i < scene->image_count; i++) {
        result = plan_image(job, i, textures, &found);
    }
    alpi_release(job->context, textures);
    if (result == ALP_OK && !found) {
        alpi_note(job->context, "ao-not-packed", scene->name,
                  "no baked material has an image of roughness, metalness or occlusion: all get "
                  "separate maps");
    }
    return result;
}

bool alpi_bake_is_packed(const alpi_bake_job *job, uint32_t triangle)
{
    uint32_t material = job->scene->surfaces[job->scene->triangle_surface[triangle]].material;
    return job->packing.material_targets != NULL && material != ALPI_NONE &&
           job->packing.material_targets[material] != ALPI_NONE;
}

void alpi_bake_release_packing(alpi_bake_job *job)
{
    for (uint32_t i = 0; i < job->packing.count; i++) {
        alpi_release(job->context, job->packing.targets[i].png);
    }
    alpi_release(job->context, job->packing.targets);
    alpi_release(job->context, job->packing.material_targets);
    job->packing = (alpi_packing){0};
}

// --- the images ----------------------------------------------------------------------------------

static bool same_coordinates(const alpi_texture *a, const alpi_texture *b)
{
    bool same = a->uv_set == b->uv_set && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
                a->rotation == b->rotation;
    for (int k = 0; k < 2; k++) {
        same = same && a->offset[k] == b->offset[k] && a->scale[k] == b->scale[k];
    }
    return same;
}

/// The accessibility in a material's own map at a cell; 1 where the material has no map. If the map
/// is the red channel of this image, the same texel is read without a filter.
static float old_occlusion(void *user, const alpi_uv_cell *cell, uint32_t x, uint32_t y)
{
    const alp_scene *scene = *(const alp_scene **)user;
    const alpi_material *m =
        &scene->materials[scene->surfaces[scene->triangle_surface[cell->triangle]].material];
    const alpi_texture *own = &m->occlusion_texture, *metal = &m->metallic_texture;
    const alpi_texture *target = metal->image != ALPI_NONE ? metal : own;
    float old = 1.0f;
    if (own->image != target->image || !same_coordinates(own, target)) {
        alpi_surface_occlusion(scene, cell->triangle, cell->barycentrics[0], cell->barycentrics[1],
                               &old);
        return old;
    }
    float rgba[4];
    alpi_image_pixel(scene->images[own->image], x, y, rgba);
    return 1.0f + m->occlusion_strength * (rgba[0] - 1.0f);
}

/// Makes a copy of the image with a new red channel. A grey image becomes a coloured one.
static alp_result replace_red(const alp_image *old, const float *page, alp_image **image)
{
    uint32_t channels = old->info.channels, old_channels = channels;
    alp_image_info info = old->info;
    info.channels = channels = channels == 1 ? 3 : channels == 2 ? 4 : channels;
    ALP_TRY(alp_image_create(old->context, info, image));
    const uint8_t *from = old->pixels;
    uint8_t *to = alp_image_bytes(*image);
    size_t count = (size_t)info.width * info.height;
    for (size_t i = 0; i < count; i++, from += old_channels, to += channels) {
        if (old_channels < 3) {
            to[1] = to[2] = from[0];
        } else {
            to[1] = from[1];
            to[2] = from[2];
        }
        if (channels == 4) {
            to[3] = from[old_channels - 1];
        }
        to[0] = (uint8_t)(fminf(fmaxf(page[4 * i], 0.0f), 1.0f) * 255.0f + 0.5f);
    }
    return ALP_OK;
}

static alp_result encode_target(const alpi_bake_job *job, const alp_atlas *layout, float *page,
                                alpi_pack_target *target)
{
    const alp_scene *scene = job->scene;
    const alpi_lightmap_weight weight = {
        job->options.existing_ao == ALP_EXISTING_AO_MULTIPLY ? old_occlusion : NULL, &scene};
    ALP_TRY(alpi_lightmap_resample(job->lightmap, layout, &weight, page));
    alp_image *image = NULL;
    ALP_TRY(replace_red(job->scene->images[target->image], page, &image));
    alp_result result = alpi_png_encode(image, &target->png, &target->png_size);
    alp_image_destroy(image);
    return result;
}

static alp_result pack_image(const alpi_bake_job *job, const alpi_texture **textures,
                             alpi_pack_target *target)
{
    const alp_image_info *info = &job->scene->images[target->image]->info;
    alp_atlas *layout = NULL;
    char *reason = NULL;
    find_readers(job, target->image, textures);
    alp_result result = alpi_uv_layout_create(job->scene, (const alpi_texture *const *)textures,
                                              info->width, info->height, &layout, &reason);
    alpi_release(job->context, reason); // none: the layout could be made before
    float *page = result == ALP_OK
                      ? ALPI_NEW(job->context, float, 4 * (size_t)info->width * info->height)
                      : NULL;
    if (result == ALP_OK) {
        result = page == NULL ? ALP_ERROR_OUT_OF_MEMORY : encode_target(job, layout, page, target);
    }
    alpi_release(job->context, page);
    alp_atlas_destroy(layout);
    return result;
}

alp_result alpi_bake_pack_images(alpi_bake_job *job)
{
    const alpi_texture **textures =
        ALPI_NEW(job->context, const alpi_texture *, job->scene->surface_count);
    if (textures == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    for (uint32_t i = 0; result == ALP_OK && i < job->packing.count; i++) {
        result = pack_image(job, textures, &job->packing.targets[i]);
    }
    alpi_release(job->context, textures);
    return result;
}
