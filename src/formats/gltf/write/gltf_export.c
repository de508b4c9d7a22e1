// SPDX-License-Identifier: MIT
// A scene that came from no file as a GLB in memory: one node, mesh and primitive a surface, in
// world space, and materials, images, cameras and lights as glTF 2.0 names them.
#include "base/look.h"
#include "formats/text/text_edits.h"

#include "base/memory.h"
#include "formats/gltf/write/gltf_write.h"
#include "formats/images/images.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TARGET_VERTICES = 34962, TARGET_INDICES = 34963 };
enum { COMPONENT_U32 = 5125, COMPONENT_FLOAT = 5126 };

/// Each root array is a text that grows; `counts` says how many elements it has.
typedef enum list {
    ACCESSORS,
    VIEWS,
    IMAGES,
    TEXTURES,
    MATERIALS,
    MESHES,
    NODES,
    CAMERAS,
    LIGHTS,
    SAMPLERS,
    LIST_COUNT
} list;

typedef struct exporter {
    alp_context *context;
    const alp_scene *scene;
    alpi_bytes lists[LIST_COUNT];
    size_t counts[LIST_COUNT];
    alpi_bytes bin;
    size_t *images; // [image_count] in the file, SIZE_MAX = left out
    bool has_emissive_strength, has_transmission, has_specular, has_transform;
} exporter;

/// Begins an element: a comma where it is not the first.
static alpi_bytes *begin(exporter *e, list which)
{
    alpi_bytes *text = &e->lists[which];
    if (e->counts[which]++ > 0) {
        alpi_bytes_add(text, ",", 1);
    }
    return text;
}

static void print_numbers(alpi_bytes *text, const char *name, const float *values, size_t count)
{
    alpi_bytes_print(text, "\"%s\":[", name);
    for (size_t i = 0; i < count; i++) {
        alpi_bytes_print(text, "%s", i > 0 ? "," : "");
        alpi_bytes_number(text, (double)values[i], 9);
    }
    alpi_bytes_print(text, "]");
}

static void print_number(alpi_bytes *text, const char *name, float value)
{
    alpi_bytes_print(text, "\"%s\":", name);
    alpi_bytes_number(text, (double)value, 9);
}

/// The translation of a node, with a comma before; nothing where it is 0.
static void print_origin(const exporter *e, alpi_bytes *text)
{
    const double *origin = e->scene->origin;
    if (origin[0] != 0.0 || origin[1] != 0.0 || origin[2] != 0.0) {
        alpi_bytes_print(text, ",\"translation\":[");
        for (int k = 0; k < 3; k++) {
            alpi_bytes_print(text, "%s", k > 0 ? "," : "");
            alpi_bytes_number(text, origin[k], 17);
        }
        alpi_bytes_print(text, "]");
    }
}

// --- geometry ------------------------------------------------------------------------------------

static size_t add_view(exporter *e, const void *bytes, size_t size, uint32_t target)
{
    alpi_bytes_align(&e->bin, '\0');
    alpi_bytes *text = begin(e, VIEWS);
    alpi_bytes_print(text, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", e->bin.size,
                     size);
    if (target != 0) {
        alpi_bytes_print(text, ",\"target\":%u", target);
    }
    alpi_bytes_print(text, "}");
    alpi_bytes_add(&e->bin, bytes, size);
    return e->counts[VIEWS] - 1;
}

static void print_bounds(alpi_bytes *text, const float *positions, uint32_t count)
{
    float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (uint32_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 3; k++) {
            low[k] = fminf(low[k], positions[3 * (size_t)i + k]);
            high[k] = fmaxf(high[k], positions[3 * (size_t)i + k]);
        }
    }
    alpi_bytes_print(text, ",");
    print_numbers(text, "min", low, 3);
    alpi_bytes_print(text, ",");
    print_numbers(text, "max", high, 3);
}

/// `count` vectors of floats; positions state their bounds.
static size_t add_floats(exporter *e, const float *values, uint32_t count, uint32_t components,
                         bool is_position)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t view = add_view(e, values, (size_t)count * components * sizeof(float), TARGET_VERTICES);
    alpi_bytes *text = begin(e, ACCESSORS);
    alpi_bytes_print(text, "{\"bufferView\":%zu,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"",
                     view, COMPONENT_FLOAT, count, types[components]);
    if (is_position) {
        print_bounds(text, values, count);
    }
    alpi_bytes_print(text, "}");
    return e->counts[ACCESSORS] - 1;
}

static alp_result add_indices(exporter *e, const alpi_surface *surface, size_t *accessor)
{
    uint32_t count = 3 * surface->triangle_count;
    uint32_t *indices = ALPI_NEW(e->context, uint32_t, count);
    if (indices == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const uint32_t *first = e->scene->triangles[surface->first_triangle];
    for (uint32_t i = 0; i < count; i++) {
        indices[i] = first[i] - surface->first_vertex;
    }
    size_t view = add_view(e, indices, count * sizeof *indices, TARGET_INDICES);
    alpi_release(e->context, indices);
    alpi_bytes_print(begin(e, ACCESSORS),
                     "{\"bufferView\":%zu,\"componentType\":%d,\"count\":%u,\"type\":\"SCALAR\"}",
                     view, COMPONENT_U32, count);
    *accessor = e->counts[ACCESSORS] - 1;
    return ALP_OK;
}

/// Sets that the surface has, and those its material reads (zeros in the scene's array).
static uint32_t needed_uv_sets(const alp_scene *scene, const alpi_surface *surface)
{
    uint32_t sets = surface->uv_sets;
    if (surface->material != ALPI_NONE) {
        const alpi_material *m = &scene->materials[surface->material];
        const alpi_texture textures[] = {m->base_color_texture,   m->metallic_texture,
                                         m->emission_texture,     m->occlusion_texture,
                                         m->transmission_texture, m->normal_texture};
        for (size_t i = 0; i < sizeof textures / sizeof *textures; i++) {
            if (textures[i].image != ALPI_NONE && textures[i].uv_set >= sets) {
                sets = textures[i].uv_set + 1;
            }
        }
    }
    sets = sets < ALPI_UV_SET_LIMIT ? sets : ALPI_UV_SET_LIMIT;
    for (uint32_t i = 0; i < sets; i++) {
        sets = scene->uvs[i] == NULL ? i : sets; // sets must follow each other
    }
    return sets;
}

static alp_result add_mesh(exporter *e, const alpi_surface *surface)
{
    const alp_scene *scene = e->scene;
    uint32_t first = surface->first_vertex, count = surface->vertex_count;
    size_t indices;
    ALP_TRY(add_indices(e, surface, &indices));
    alpi_bytes attributes = alpi_bytes_create(e->context);
    alpi_bytes_print(&attributes, "\"POSITION\":%zu,",
                     add_floats(e, scene->positions[first], count, 3, true));
    alpi_bytes_print(&attributes, "\"NORMAL\":%zu",
                     add_floats(e, scene->normals[first], count, 3, false));
    for (uint32_t set = 0; set < needed_uv_sets(scene, surface); set++) {
        alpi_bytes_print(&attributes, ",\"TEXCOORD_%u\":%zu", set,
                         add_floats(e, scene->uvs[set][first], count, 2, false));
    }
    if (scene->colors != NULL) {
        alpi_bytes_print(&attributes, ",\"COLOR_0\":%zu",
                         add_floats(e, scene->colors[first], count, 4, false));
    }
    alpi_bytes *text = begin(e, MESHES);
    alpi_bytes_print(text, "{\"primitives\":[{\"attributes\":{");
    alpi_bytes_add(text, attributes.bytes, attributes.size);
    alpi_bytes_print(text, "},\"indices\":%zu", indices);
    if (surface->material != ALPI_NONE) {
        alpi_bytes_print(text, ",\"material\":%u", surface->material);
    }
    alpi_bytes_print(text, "}]}");
    e->bin.failed |= attributes.failed;
    alpi_bytes_destroy(&attributes);
    return ALP_OK;
}

/// Node i is surface i, also where the surface is empty and there is no mesh.
static alp_result add_surfaces(exporter *e)
{
    for (uint32_t s = 0; s < e->scene->surface_count; s++) {
        const alpi_surface *surface = &e->scene->surfaces[s];
        alpi_bytes *text = begin(e, NODES);
        alpi_bytes_print(text, "{\"name\":");
        alpi_bytes_quote(text, surface->name != NULL ? surface->name : "");
        if (surface->triangle_count > 0 && surface->triangle_count <= UINT32_MAX / 3) {
            alpi_bytes_print(text, ",\"mesh\":%zu", e->counts[MESHES]);
            ALP_TRY(add_mesh(e, surface));
        }
        print_origin(e, text);
        alpi_bytes_print(text, "}");
    }
    return ALP_OK;
}

// --- materials -----------------------------------------------------------------------------------

static alp_result add_image(exporter *e, uint32_t index, const alp_image *image)
{
    uint8_t *png = NULL;
    size_t size = 0;
    if (image == NULL || image->info.component != ALP_COMPONENT_U8) {
        return ALP_OK;
    }
    ALP_TRY(alpi_png_encode(image, &png, &size));
    size_t view = add_view(e, png, size, 0);
    alpi_release(e->context, png);
    alpi_bytes_print(begin(e, IMAGES), "{\"bufferView\":%zu,\"mimeType\":\"image/png\"}", view);
    e->images[index] = e->counts[IMAGES] - 1;
    return ALP_OK;
}

/// Normal maps, which the scene does not hold unless a host has asked for them.
static alp_result add_normal_maps(exporter *e)
{
    for (uint32_t m = 0; m < e->scene->material_count && e->scene->read_image != NULL; m++) {
        const uint32_t index = e->scene->materials[m].normal_texture.image;
        if (index >= e->scene->image_count || e->images[index] != SIZE_MAX) {
            continue;
        }
        alp_image *image = NULL;
        ALP_TRY(e->scene->read_image(e->scene, index, &image));
        const alp_result result = add_image(e, index, image);
        alp_image_destroy(image);
        ALP_TRY(result);
    }
    return ALP_OK;
}

/// Images that can be stored as PNG: those of bytes.
static alp_result add_images(exporter *e)
{
    ALPI_TRY_NEW(e->context, e->images, e->scene->image_count);
    for (uint32_t i = 0; i < e->scene->image_count; i++) {
        e->images[i] = SIZE_MAX;
        ALP_TRY(add_image(e, i, e->scene->images[i]));
    }
    return add_normal_maps(e);
}

/// A texture with its sampler, and the reference to it, with a comma before; nothing where there is
/// no image.
static void add_texture(exporter *e, alpi_bytes *text, const char *name,
                        const alpi_texture *texture, float strength)
{
    static const int wraps[] = {
        [ALPI_WRAP_REPEAT] = 10497, [ALPI_WRAP_CLAMP] = 33071, [ALPI_WRAP_MIRROR] = 33648};
    if (texture->image == ALPI_NONE || texture->image >= e->scene->image_count ||
        e->images[texture->image] == SIZE_MAX) {
        return;
    }
    alpi_bytes_print(begin(e, SAMPLERS), "{\"wrapS\":%d,\"wrapT\":%d}", wraps[texture->wrap_u],
                     wraps[texture->wrap_v]);
    alpi_bytes_print(begin(e, TEXTURES), "{\"sampler\":%zu,\"source\":%zu}",
                     e->counts[SAMPLERS] - 1, e->images[texture->image]);
    alpi_bytes_print(text, ",\"%s\":{\"index\":%zu,\"texCoord\":%u", name, e->counts[TEXTURES] - 1,
                     texture->uv_set);
    if (strength != 1.0f) {
        alpi_bytes_print(text, ",");
        print_number(text, "strength", strength);
    }
    if (texture->offset[0] != 0.0f || texture->offset[1] != 0.0f || texture->scale[0] != 1.0f ||
        texture->scale[1] != 1.0f || texture->rotation != 0.0f) {
        e->has_transform = true;
        alpi_bytes_print(text, ",\"extensions\":{\"KHR_texture_transform\":{");
        print_numbers(text, "offset", texture->offset, 2);
        alpi_bytes_print(text, ",");
        print_numbers(text, "scale", texture->scale, 2);
        alpi_bytes_print(text, ",");
        print_number(text, "rotation", texture->rotation);
        alpi_bytes_print(text, "}}");
    }
    alpi_bytes_print(text, "}");
}

/// The tint of the specular colour; its strength is of another model and stays behind. False where
/// the default says the same.
static bool find_tint(const alpi_material *m, float tint[3])
{
    const float most = fmaxf(m->specular[0], fmaxf(m->specular[1], m->specular[2]));
    bool coloured = false;
    for (int k = 0; k < 3; k++) {
        tint[k] = most > 0.0f ? m->specular[k] / most : 0.0f;
        coloured |= tint[k] != 1.0f;
    }
    return m->shininess >= 0.0f && coloured;
}

/// Material extensions: emissiveFactor is at most 1, what is brighter goes into
/// KHR_materials_emissive_strength.
static void print_material_extensions(exporter *e, alpi_bytes *text, const alpi_material *m,
                                      float strength)
{
    float tint[3];
    const bool bright = strength > 1.0f, clear = m->transmission > 0.0f;
    const bool tinted = find_tint(m, tint);
    e->has_emissive_strength |= bright;
    e->has_transmission |= clear;
    e->has_specular |= tinted;
    alpi_bytes_print(text, "%s", bright || clear || tinted ? ",\"extensions\":{" : "");
    if (bright) {
        alpi_bytes_print(text, "\"KHR_materials_emissive_strength\":{");
        print_number(text, "emissiveStrength", strength);
        alpi_bytes_print(text, "}%s", clear || tinted ? "," : "");
    }
    if (tinted) {
        alpi_bytes_print(text, "\"KHR_materials_specular\":{");
        print_numbers(text, "specularColorFactor", tint, 3);
        alpi_bytes_print(text, "}%s", clear ? "," : "");
    }
    if (clear) {
        alpi_bytes_print(text, "\"KHR_materials_transmission\":{");
        print_number(text, "transmissionFactor", m->transmission);
        add_texture(e, text, "transmissionTexture", &m->transmission_texture, 1.0f);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "%s", bright || clear || tinted ? "}" : "");
}

static void print_emission(exporter *e, alpi_bytes *text, const alpi_material *m)
{
    float strength = fmaxf(1.0f, fmaxf(m->emission[0], fmaxf(m->emission[1], m->emission[2])));
    float factor[3];
    for (int k = 0; k < 3; k++) {
        factor[k] = m->emission[k] / strength;
    }
    if (factor[0] > 0.0f || factor[1] > 0.0f || factor[2] > 0.0f) {
        alpi_bytes_print(text, ",");
        print_numbers(text, "emissiveFactor", factor, 3);
    }
    print_material_extensions(e, text, m, strength);
}

/// Roughness whose lobe is that of a Blinn-Phong exponent n: √(2 / (n + 2)) is its square. 1
/// without specular colour. Walter, Marschner, Li, Torrance. Microfacet models for refraction. EGSR
/// 2007.
static float roughness_of(const alpi_material *m)
{
    const float *c = m->specular;
    return c[0] + c[1] + c[2] > 0.0f ? powf(2.0f / (m->shininess + 2.0f), 0.25f) : 1.0f;
}

static void add_material(exporter *e, const alpi_material *m)
{
    alpi_bytes *text = begin(e, MATERIALS);
    alpi_bytes_print(text, "{\"name\":");
    alpi_bytes_quote(text, m->name != NULL ? m->name : "");
    alpi_bytes_print(text, ",\"pbrMetallicRoughness\":{");
    print_numbers(text, "baseColorFactor", m->base_color, 4);
    alpi_bytes_print(text, ",");
    print_number(text, "metallicFactor", m->metallic);
    add_texture(e, text, "baseColorTexture", &m->base_color_texture, 1.0f);
    add_texture(e, text, "metallicRoughnessTexture", &m->metallic_texture, 1.0f);
    if (m->shininess >= 0.0f) {
        alpi_bytes_print(text, ",");
        print_number(text, "roughnessFactor", roughness_of(m));
    }
    alpi_bytes_print(text, "}");
    print_emission(e, text, m);
    add_texture(e, text, "normalTexture", &m->normal_texture, 1.0f);
    add_texture(e, text, "emissiveTexture", &m->emission_texture, 1.0f);
    add_texture(e, text, "occlusionTexture", &m->occlusion_texture, m->occlusion_strength);
    if (m->alpha_mode != ALPI_ALPHA_OPAQUE) {
        alpi_bytes_print(text, ",\"alphaMode\":\"%s\"",
                         m->alpha_mode == ALPI_ALPHA_MASK ? "MASK" : "BLEND");
    }
    if (m->alpha_mode == ALPI_ALPHA_MASK) {
        alpi_bytes_print(text, ",");
        print_number(text, "alphaCutoff", m->alpha_cutoff);
    }
    alpi_bytes_print(text, "%s}", m->double_sided ? ",\"doubleSided\":true" : "");
}

// --- cameras and lights --------------------------------------------------------------------------

static void print_matrix(const exporter *e, alpi_bytes *text, vec3 position, vec3 forward, vec3 up)
{
    float m[16];
    alpi_look_matrix(position, forward, up, m);
    alpi_bytes_print(text, "\"matrix\":[");
    for (int i = 0; i < 16; i++) {
        const double origin = i >= 12 && i < 15 ? e->scene->origin[i - 12] : 0.0;
        alpi_bytes_print(text, "%s", i > 0 ? "," : "");
        alpi_bytes_number(text, origin + (double)m[i], origin != 0.0 ? 17 : 9);
    }
    alpi_bytes_print(text, "]");
}

static void add_camera(exporter *e, const alp_camera *camera)
{
    vec3 position = vec3_load(camera->position);
    alpi_bytes *text = begin(e, NODES);
    alpi_bytes_print(text, "{\"name\":\"camera %zu\",\"camera\":%zu,", e->counts[CAMERAS],
                     e->counts[CAMERAS]);
    print_matrix(e, text, position, vec3_sub(vec3_load(camera->target), position),
                 vec3_load(camera->up));
    alpi_bytes_print(text, "}");
    text = begin(e, CAMERAS);
    alpi_bytes_print(text, "{\"type\":\"perspective\",\"perspective\":{");
    print_number(text, "yfov", camera->vertical_fov);
    alpi_bytes_print(text, ",\"znear\":0.01}}");
}

static void add_light(exporter *e, const alpi_light *light)
{
    const alp_light_traits traits = alp_light_traits_of(light->kind);
    alpi_bytes *text = begin(e, NODES);
    alpi_bytes_print(text, "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":%zu}},",
                     e->counts[LIGHTS]);
    print_matrix(e, text, light->position, light->direction, (vec3){0.0f, 1.0f, 0.0f});
    alpi_bytes_print(text, "}");
    text = begin(e, LIGHTS);
    const float color[3] = {light->color.x, light->color.y, light->color.z};
    alpi_bytes_print(text, "{\"name\":");
    alpi_bytes_quote(text, light->name != NULL ? light->name : "");
    alpi_bytes_print(text, ",\"type\":\"%s\",", traits.name);
    print_numbers(text, "color", color, 3);
    alpi_bytes_print(text, ",");
    print_number(text, "intensity", light->intensity);
    if (isfinite(light->range)) {
        alpi_bytes_print(text, ",");
        print_number(text, "range", light->range);
    }
    if (traits.has_cone) {
        alpi_bytes_print(text, ",\"spot\":{");
        print_number(text, "innerConeAngle", light->inner_cone);
        alpi_bytes_print(text, ",");
        print_number(text, "outerConeAngle", light->outer_cone);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "}");
}

// --- the whole file ------------------------------------------------------------------------------

static alp_result fill(exporter *e)
{
    const alp_scene *scene = e->scene;
    ALP_TRY(add_images(e));
    ALP_TRY(add_surfaces(e));
    for (uint32_t i = 0; i < scene->material_count; i++) {
        add_material(e, &scene->materials[i]);
    }
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        add_camera(e, &scene->cameras[i]);
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        add_light(e, &scene->lights[i]);
    }
    return ALP_OK;
}

static void print_extensions(const exporter *e, alpi_bytes *json)
{
    const struct {
        bool used;
        const char *name;
    } extensions[] = {{e->has_emissive_strength, "KHR_materials_emissive_strength"},
                      {e->has_specular, "KHR_materials_specular"},
                      {e->has_transmission, "KHR_materials_transmission"},
                      {e->has_transform, "KHR_texture_transform"},
                      {e->counts[LIGHTS] > 0, "KHR_lights_punctual"}};
    const char *before = ",\"extensionsUsed\":[";
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++) {
        if (extensions[i].used) {
            alpi_bytes_print(json, "%s\"%s\"", before, extensions[i].name);
            before = ",";
        }
    }
    alpi_bytes_print(json, "%s", before[1] == '\0' ? "]" : "");
    if (e->counts[LIGHTS] > 0) {
        alpi_bytes_print(json, ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[");
        alpi_bytes_add(json, e->lists[LIGHTS].bytes, e->lists[LIGHTS].size);
        alpi_bytes_print(json, "]}}");
    }
}

static void print_json(const exporter *e, alpi_bytes *json)
{
    static const char *const names[LIST_COUNT] = {
        [ACCESSORS] = "accessors", [VIEWS] = "bufferViews",   [IMAGES] = "images",
        [TEXTURES] = "textures",   [MATERIALS] = "materials", [MESHES] = "meshes",
        [NODES] = "nodes",         [CAMERAS] = "cameras",     [SAMPLERS] = "samplers"};
    alpi_bytes_print(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Alpenglow %s\"}",
                     alp_version());
    print_extensions(e, json);
    if (e->counts[NODES] > 0) {
        alpi_bytes_print(json, ",\"scene\":0,\"scenes\":[{\"nodes\":[0");
        for (size_t i = 1; i < e->counts[NODES]; i++) {
            alpi_bytes_print(json, ",%zu", i);
        }
        alpi_bytes_print(json, "]}]");
    }
    for (int i = 0; i < LIST_COUNT; i++) {
        if (names[i] != NULL && e->counts[i] > 0) {
            alpi_bytes_print(json, ",\"%s\":[", names[i]);
            alpi_bytes_add(json, e->lists[i].bytes, e->lists[i].size);
            alpi_bytes_print(json, "]");
        }
    }
    if (e->bin.size > 0) {
        alpi_bytes_print(json, ",\"buffers\":[{\"byteLength\":%zu}]", e->bin.size);
    }
    alpi_bytes_print(json, "}");
    alpi_bytes_align(json, ' ');
}

static alp_result assemble(exporter *e, alpi_bytes *json, alpi_bytes *glb)
{
    alpi_bytes_align(&e->bin, '\0');
    print_json(e, json);
    uint64_t size = 12 + 8 + (uint64_t)json->size + (e->bin.size > 0 ? 8 + e->bin.size : 0);
    if (size > UINT32_MAX) {
        return alpi_fail(e->context, ALP_ERROR_LIMIT,
                         "%s: the scene has %llu bytes, more than a .glb can hold", e->scene->name,
                         (unsigned long long)size);
    }
    alpi_bytes_add(glb, "glTF", 4);
    alpi_bytes_add_u32(glb, 2);
    alpi_bytes_add_u32(glb, (uint32_t)size);
    alpi_bytes_add_u32(glb, (uint32_t)json->size);
    alpi_bytes_add(glb, "JSON", 4);
    alpi_bytes_add(glb, json->bytes, json->size);
    if (e->bin.size > 0) {
        alpi_bytes_add_u32(glb, (uint32_t)e->bin.size);
        alpi_bytes_add(glb, "BIN\0", 4);
        alpi_bytes_add(glb, e->bin.bytes, e->bin.size);
    }
    bool failed = json->failed || glb->failed || e->bin.failed;
    for (int i = 0; i < LIST_COUNT; i++) {
        failed |= e->lists[i].failed;
    }
    return failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_gltf_export_scene(const alp_scene *scene, uint8_t **bytes, size_t *size)
{
    alp_context *context = scene->context;
    exporter e = {.context = context, .scene = scene, .bin = alpi_bytes_create(context)};
    for (int i = 0; i < LIST_COUNT; i++) {
        e.lists[i] = alpi_bytes_create(context);
    }
    alpi_bytes json = alpi_bytes_create(context), glb = alpi_bytes_create(context);
    *bytes = NULL;
    *size = 0;
    alp_result result = fill(&e);
    if (result == ALP_OK) {
        result = assemble(&e, &json, &glb);
    }
    if (result == ALP_OK) {
        *bytes = glb.bytes;
        *size = glb.size;
    } else {
        alpi_bytes_destroy(&glb);
    }
    for (int i = 0; i < LIST_COUNT; i++) {
        alpi_bytes_destroy(&e.lists[i]);
    }
    alpi_bytes_destroy(&e.bin);
    alpi_bytes_destroy(&json);
    alpi_release(context, e.images);
    return result;
}
