// SPDX-License-Identifier: MIT
// A scene that came from no file as a GLB in memory: one node, mesh and primitive a surface, in
// world space, and cameras and lights as glTF 2.0 names them; its materials:
// gltf_export_materials.c.
#include "base/look.h"
#include "formats/text/text_edits.h"

#include "base/memory.h"
#include "formats/gltf/write/gltf_export.h"
#include "formats/gltf/write/gltf_write.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TARGET_VERTICES = 34962, TARGET_INDICES = 34963 };
enum { COMPONENT_U32 = 5125, COMPONENT_FLOAT = 5126 };

/// Begins an element: a comma where it is not the first.
alpi_bytes *alpi_export_begin(alpi_gltf_exporter *e, alpi_gltf_list which)
{
    alpi_bytes *text = &e->lists[which];
    if (e->counts[which]++ > 0) {
        alpi_bytes_add(text, ",", 1);
    }
    return text;
}

void alpi_export_numbers(alpi_bytes *text, const char *name, const float *values, size_t count)
{
    alpi_bytes_print(text, "\"%s\":[", name);
    for (size_t i = 0; i < count; i++) {
        alpi_bytes_print(text, "%s", i > 0 ? "," : "");
        alpi_bytes_number(text, (double)values[i], 9);
    }
    alpi_bytes_print(text, "]");
}

void alpi_export_number(alpi_bytes *text, const char *name, float value)
{
    alpi_bytes_print(text, "\"%s\":", name);
    alpi_bytes_number(text, (double)value, 9);
}

/// The translation of a node, with a comma before; nothing where it is 0.
static void print_origin(const alpi_gltf_exporter *e, alpi_bytes *text)
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

size_t alpi_export_view(alpi_gltf_exporter *e, const void *bytes, size_t size, uint32_t target)
{
    alpi_bytes_align(&e->bin, '\0');
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_VIEWS);
    alpi_bytes_print(text, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", e->bin.size,
                     size);
    if (target != 0) {
        alpi_bytes_print(text, ",\"target\":%u", target);
    }
    alpi_bytes_print(text, "}");
    alpi_bytes_add(&e->bin, bytes, size);
    return e->counts[ALPI_LIST_VIEWS] - 1;
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
    alpi_export_numbers(text, "min", low, 3);
    alpi_bytes_print(text, ",");
    alpi_export_numbers(text, "max", high, 3);
}

/// `count` vectors of floats; positions state their bounds.
static size_t add_floats(alpi_gltf_exporter *e, const float *values, uint32_t count,
                         uint32_t components, bool is_position)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t view =
        alpi_export_view(e, values, (size_t)count * components * sizeof(float), TARGET_VERTICES);
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_ACCESSORS);
    alpi_bytes_print(text, "{\"bufferView\":%zu,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"",
                     view, COMPONENT_FLOAT, count, types[components]);
    if (is_position) {
        print_bounds(text, values, count);
    }
    alpi_bytes_print(text, "}");
    return e->counts[ALPI_LIST_ACCESSORS] - 1;
}

static alp_result add_indices(alpi_gltf_exporter *e, const alpi_surface *surface, size_t *accessor)
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
    size_t view = alpi_export_view(e, indices, count * sizeof *indices, TARGET_INDICES);
    alpi_release(e->context, indices);
    alpi_bytes_print(alpi_export_begin(e, ALPI_LIST_ACCESSORS),
                     "{\"bufferView\":%zu,\"componentType\":%d,\"count\":%u,\"type\":\"SCALAR\"}",
                     view, COMPONENT_U32, count);
    *accessor = e->counts[ALPI_LIST_ACCESSORS] - 1;
    return ALP_OK;
}

/// Whether a set has the coordinates of the one before, as an OBJ's second set has.
static bool repeats_set(const alp_scene *scene, const alpi_surface *surface, uint32_t set)
{
    const uint32_t first = surface->first_vertex;
    return set > 0 && set < ALPI_UV_SLOT_COUNT &&
           memcmp(scene->uvs[set - 1][first], scene->uvs[set][first],
                  surface->vertex_count * sizeof *scene->uvs[set]) == 0;
}

/// Sets that the surface has, and those its material reads (zeros in the scene's array).
static uint32_t needed_uv_sets(const alpi_gltf_exporter *e, const alpi_surface *surface)
{
    const alp_scene *scene = e->scene;
    uint32_t sets = surface->uv_sets;
    if (sets == 2 && !e->keeps_sets && scene->uvs[0] != NULL && scene->uvs[1] != NULL) {
        sets -= repeats_set(scene, surface, 1);
    }
    if (surface->material != ALPI_NONE) {
        const alpi_material *m = &scene->materials[surface->material];
        const alpi_texture textures[] = {
            m->base_color_texture, m->metallic_texture,        m->emission_texture,
            m->occlusion_texture,  m->transmission_texture,    m->normal_texture,
            m->shine.bump_texture, m->shine.roughness_texture, m->shine.specular_texture};
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

static alp_result add_mesh(alpi_gltf_exporter *e, const alpi_surface *surface)
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
    size_t coordinates = 0;
    for (uint32_t set = 0; set < needed_uv_sets(e, surface); set++) {
        if (!repeats_set(scene, surface, set)) {
            coordinates = add_floats(e, scene->uvs[set][first], count, 2, false);
        }
        alpi_bytes_print(&attributes, ",\"TEXCOORD_%u\":%zu", set, coordinates);
    }
    if (scene->colors != NULL) {
        alpi_bytes_print(&attributes, ",\"COLOR_0\":%zu",
                         add_floats(e, scene->colors[first], count, 4, false));
    }
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_MESHES);
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
static alp_result add_surfaces(alpi_gltf_exporter *e)
{
    for (uint32_t s = 0; s < e->scene->surface_count; s++) {
        const alpi_surface *surface = &e->scene->surfaces[s];
        alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_NODES);
        alpi_bytes_print(text, "{\"name\":");
        alpi_bytes_quote(text, surface->name != NULL ? surface->name : "");
        if (surface->triangle_count > 0 && surface->triangle_count <= UINT32_MAX / 3) {
            alpi_bytes_print(text, ",\"mesh\":%zu", e->counts[ALPI_LIST_MESHES]);
            ALP_TRY(add_mesh(e, surface));
        }
        print_origin(e, text);
        alpi_bytes_print(text, "}");
    }
    return ALP_OK;
}

// --- cameras and lights --------------------------------------------------------------------------

static void print_matrix(const alpi_gltf_exporter *e, alpi_bytes *text, vec3 position, vec3 forward,
                         vec3 up)
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

static void add_camera(alpi_gltf_exporter *e, const alp_camera *camera)
{
    vec3 position = vec3_load(camera->position);
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_NODES);
    alpi_bytes_print(text, "{\"name\":\"camera %zu\",\"camera\":%zu,", e->counts[ALPI_LIST_CAMERAS],
                     e->counts[ALPI_LIST_CAMERAS]);
    print_matrix(e, text, position, vec3_sub(vec3_load(camera->target), position),
                 vec3_load(camera->up));
    alpi_bytes_print(text, "}");
    text = alpi_export_begin(e, ALPI_LIST_CAMERAS);
    alpi_bytes_print(text, "{\"type\":\"perspective\",\"perspective\":{");
    alpi_export_number(text, "yfov", camera->vertical_fov);
    alpi_bytes_print(text, ",\"znear\":0.01}}");
}

static void add_light(alpi_gltf_exporter *e, const alpi_light *light)
{
    const alp_light_traits traits = alp_light_traits_of(light->kind);
    alpi_bytes *text = alpi_export_begin(e, ALPI_LIST_NODES);
    alpi_bytes_print(text, "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":%zu}},",
                     e->counts[ALPI_LIST_LIGHTS]);
    print_matrix(e, text, light->position, light->direction, (vec3){0.0f, 1.0f, 0.0f});
    alpi_bytes_print(text, "}");
    text = alpi_export_begin(e, ALPI_LIST_LIGHTS);
    const float color[3] = {light->color.x, light->color.y, light->color.z};
    alpi_bytes_print(text, "{\"name\":");
    alpi_bytes_quote(text, light->name != NULL ? light->name : "");
    alpi_bytes_print(text, ",\"type\":\"%s\",", traits.name);
    alpi_export_numbers(text, "color", color, 3);
    alpi_bytes_print(text, ",");
    alpi_export_number(text, "intensity", light->intensity);
    if (isfinite(light->range)) {
        alpi_bytes_print(text, ",");
        alpi_export_number(text, "range", light->range);
    }
    if (traits.has_cone) {
        alpi_bytes_print(text, ",\"spot\":{");
        alpi_export_number(text, "innerConeAngle", light->inner_cone);
        alpi_bytes_print(text, ",");
        alpi_export_number(text, "outerConeAngle", light->outer_cone);
        alpi_bytes_print(text, "}");
    }
    alpi_bytes_print(text, "}");
}

// --- the whole file ------------------------------------------------------------------------------

static alp_result fill(alpi_gltf_exporter *e)
{
    const alp_scene *scene = e->scene;
    ALP_TRY(alpi_export_images(e));
    ALP_TRY(add_surfaces(e));
    alpi_export_materials(e);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        add_camera(e, &scene->cameras[i]);
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        add_light(e, &scene->lights[i]);
    }
    return ALP_OK;
}

static void print_extensions(const alpi_gltf_exporter *e, alpi_bytes *json)
{
    const struct {
        bool used;
        const char *name;
    } extensions[] = {{e->has_emissive_strength, "KHR_materials_emissive_strength"},
                      {e->has_transmission, "KHR_materials_transmission"},
                      {e->has_ior, "KHR_materials_ior"},
                      {e->has_specular, "KHR_materials_specular"},
                      {e->has_transform, "KHR_texture_transform"},
                      {e->counts[ALPI_LIST_LIGHTS] > 0, "KHR_lights_punctual"}};
    const char *before = ",\"extensionsUsed\":[";
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++) {
        if (extensions[i].used) {
            alpi_bytes_print(json, "%s\"%s\"", before, extensions[i].name);
            before = ",";
        }
    }
    alpi_bytes_print(json, "%s", before[1] == '\0' ? "]" : "");
    if (e->counts[ALPI_LIST_LIGHTS] > 0) {
        alpi_bytes_print(json, ",\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[");
        alpi_bytes_add(json, e->lists[ALPI_LIST_LIGHTS].bytes, e->lists[ALPI_LIST_LIGHTS].size);
        alpi_bytes_print(json, "]}}");
    }
}

static void print_json(const alpi_gltf_exporter *e, alpi_bytes *json)
{
    static const char *const names[ALPI_LIST_COUNT] = {
        [ALPI_LIST_ACCESSORS] = "accessors", [ALPI_LIST_VIEWS] = "bufferViews",
        [ALPI_LIST_IMAGES] = "images",       [ALPI_LIST_TEXTURES] = "textures",
        [ALPI_LIST_MATERIALS] = "materials", [ALPI_LIST_MESHES] = "meshes",
        [ALPI_LIST_NODES] = "nodes",         [ALPI_LIST_CAMERAS] = "cameras",
        [ALPI_LIST_SAMPLERS] = "samplers"};
    alpi_bytes_print(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Alpenglow %s\"}",
                     alp_version());
    print_extensions(e, json);
    if (e->counts[ALPI_LIST_NODES] > 0) {
        alpi_bytes_print(json, ",\"scene\":0,\"scenes\":[{\"nodes\":[0");
        for (size_t i = 1; i < e->counts[ALPI_LIST_NODES]; i++) {
            alpi_bytes_print(json, ",%zu", i);
        }
        alpi_bytes_print(json, "]}]");
    }
    for (int i = 0; i < ALPI_LIST_COUNT; i++) {
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

static alp_result assemble(alpi_gltf_exporter *e, alpi_bytes *json, alpi_bytes *glb)
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
    for (int i = 0; i < ALPI_LIST_COUNT; i++) {
        failed |= e->lists[i].failed;
    }
    return failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_gltf_export_scene(const alp_scene *scene, bool keeps_sets, uint8_t **bytes,
                                  size_t *size)
{
    alp_context *context = scene->context;
    alpi_gltf_exporter e = {.context = context,
                            .scene = scene,
                            .bin = alpi_bytes_create(context),
                            .keeps_sets = keeps_sets};
    for (int i = 0; i < ALPI_LIST_COUNT; i++) {
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
    for (int i = 0; i < ALPI_LIST_COUNT; i++) {
        alpi_bytes_destroy(&e.lists[i]);
    }
    alpi_bytes_destroy(&e.bin);
    alpi_bytes_destroy(&json);
    alpi_release(context, e.images);
    alpi_release(context, e.gloss);
    alpi_release(context, e.normals);
    return result;
}
