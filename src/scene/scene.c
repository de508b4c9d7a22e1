// SPDX-License-Identifier: MIT
// Making, checking and asking a scene.
#include "scene/scene.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/plural.h"
#include "scene/blend_weights.h"
#include "scene/sides.h"
#include "scene/viewpoints.h"

#include <math.h>
#include <string.h>

alp_result alpi_scene_create(alp_context *context, const char *name, alp_scene **scene)
{
    *scene = NULL;
    alp_scene *s = ALPI_NEW(context, alp_scene, 1);
    if (s == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->context = context;
    s->unit_metres = 1.0; // what glTF and arrays are in
    s->name = alpi_copy_string(context, name);
    s->attachments = ALPI_NEW(context, alpi_attachment, ALPI_ATTACHMENT_COUNT);
    if (s->name == NULL || s->attachments == NULL) {
        alp_scene_destroy(s);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *scene = s;
    return ALP_OK;
}

void alp_scene_destroy(alp_scene *scene)
{
    if (scene == NULL) {
        return;
    }
    alp_context *context = scene->context;
    for (int i = ALPI_ATTACHMENT_COUNT - 1; scene->attachments != NULL && i >= 0; i--) {
        if (scene->attachments[i].destroy != NULL) {
            scene->attachments[i].destroy(context, scene->attachments[i].data);
        }
    }
    for (uint32_t i = 0; scene->surfaces != NULL && i < scene->surface_count; i++) {
        alpi_release(context, scene->surfaces[i].name);
    }
    for (uint32_t i = 0; scene->materials != NULL && i < scene->material_count; i++) {
        alpi_release(context, scene->materials[i].name);
    }
    for (uint32_t i = 0; scene->images != NULL && i < scene->image_count; i++) {
        alp_image_destroy(scene->images[i]);
    }
    for (uint32_t i = 0; scene->normal_maps != NULL && i < scene->image_count; i++) {
        alp_image_destroy(scene->normal_maps[i]);
    }
    for (uint32_t i = 0; scene->lights != NULL && i < scene->light_count; i++) {
        alpi_release(context, scene->lights[i].name);
    }
    for (uint32_t i = 0; scene->animations != NULL && i < scene->animation_count; i++) {
        alpi_release(context, scene->animations[i].name);
    }
    for (int i = 0; i < ALPI_UV_SLOT_COUNT; i++) {
        alpi_release(context, scene->uvs[i]);
    }
    alpi_sides_destroy(context, scene->sides);
    void *const arrays[] = {
        scene->positions, scene->normals,          scene->colors,          scene->vertex_source,
        scene->triangles, scene->triangle_surface, scene->triangle_usable, scene->surfaces,
        scene->materials, scene->images,           scene->normal_maps,     scene->lights,
        scene->cameras,   scene->animations,       scene->attachments,     scene->name};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        alpi_release(context, arrays[i]);
    }
    alpi_release(context, scene);
}

static alp_result share_list(alp_context *context, alp_image *const *from, uint32_t count,
                             alp_image ***to)
{
    if (from == NULL) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(context, *to, count);
    for (uint32_t i = 0; i < count; i++) {
        (*to)[i] = alpi_image_share(from[i]);
    }
    return ALP_OK;
}

alp_result alpi_scene_open_image(const alp_scene *scene, uint32_t index, alp_image **image)
{
    alp_image *there = scene->images[index];
    if (there == NULL && scene->normal_maps != NULL) {
        there = scene->normal_maps[index];
    }
    *image = alpi_image_share(there);
    return there != NULL || scene->read_image == NULL ? ALP_OK
                                                      : scene->read_image(scene, index, image);
}

alp_result alpi_scene_share_images(const alp_scene *from, alp_scene *to)
{
    to->image_count = from->image_count;
    ALP_TRY(share_list(to->context, from->images, from->image_count, &to->images));
    return share_list(to->context, from->normal_maps, from->image_count, &to->normal_maps);
}

// --- checks --------------------------------------------------------------------------------------

static alp_result check_indices(const alp_scene *scene)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            if (scene->triangles[t][k] >= scene->vertex_count) {
                return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                                 "%s: triangle %u uses vertex %u of %u", scene->name, t,
                                 scene->triangles[t][k], scene->vertex_count);
            }
        }
        if (scene->triangle_surface[t] >= scene->surface_count) {
            return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                             "%s: triangle %u names surface %u of %u", scene->name, t,
                             scene->triangle_surface[t], scene->surface_count);
        }
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        uint32_t material = scene->surfaces[s].material;
        if (material != ALPI_NONE && material >= scene->material_count) {
            return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                             "%s: surface %u names material %u of %u", scene->name, s, material,
                             scene->material_count);
        }
    }
    return ALP_OK;
}

static bool position_is_usable(const float p[3])
{
    return fabsf(p[0]) <= ALPI_COORDINATE_LIMIT && fabsf(p[1]) <= ALPI_COORDINATE_LIMIT &&
           fabsf(p[2]) <= ALPI_COORDINATE_LIMIT; // NaN compares false
}

/// Marks usable triangles and warns, once per surface and kind of fault.
static void mark_triangles(alp_scene *scene)
{
    scene->usable_count = 0;
    scene->area = 0.0;
    scene->bounds_min = (vec3){INFINITY, INFINITY, INFINITY};
    scene->bounds_max = (vec3){-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        alpi_surface *surface = &scene->surfaces[s];
        uint32_t broken = 0;
        surface->flat_count = 0;
        for (uint32_t i = 0; i < surface->triangle_count; i++) {
            uint32_t t = surface->first_triangle + i;
            const uint32_t *v = scene->triangles[t];
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            bool finite = position_is_usable(scene->positions[v[0]]) &&
                          position_is_usable(scene->positions[v[1]]) &&
                          position_is_usable(scene->positions[v[2]]);
            double area = vec3_triangle_area(c[0], c[1], c[2]);
            bool usable = finite && area > 0.0 && isfinite(area);
            broken += !finite;
            surface->flat_count += finite && !usable;
            scene->triangle_usable[t] = usable;
            if (usable) {
                scene->usable_count++;
                scene->area += area;
                for (int k = 0; k < 3; k++) {
                    scene->bounds_min = vec3_min(scene->bounds_min, c[k]);
                    scene->bounds_max = vec3_max(scene->bounds_max, c[k]);
                }
            }
        }
        if (broken > 0) {
            alpi_warn(scene->context, "bad-coordinates", surface->name,
                      "%u of %u triangles left out: a coordinate is not finite or beyond %g m",
                      broken, surface->triangle_count, (double)ALPI_COORDINATE_LIMIT);
        }
    }
    if (scene->usable_count == 0) {
        scene->bounds_min = scene->bounds_max = (vec3){0.0f, 0.0f, 0.0f};
    }
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        if (!position_is_usable(scene->positions[v])) {
            memset(scene->positions[v], 0, sizeof scene->positions[v]);
        }
    }
}

/// Triangles without area are invisible in any case.
static void note_flat(const alp_scene *scene)
{
    uint32_t flat = 0, surfaces = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        flat += scene->surfaces[s].flat_count;
        surfaces += scene->surfaces[s].flat_count > 0;
    }
    if (flat > 0) {
        alpi_note(scene->context, "zero-area", scene->name,
                  "triangles left out because they have no area: %u of %u, in %u surface%s", flat,
                  scene->triangle_count, surfaces, alpi_plural(surfaces));
    }
}

/// Unit normals everywhere: those that are zero or not finite are taken from the first usable
/// triangle at the vertex.
static void repair_normals(alp_scene *scene)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        uint32_t bad = 0;
        for (uint32_t i = 0; i < surface->triangle_count; i++) {
            uint32_t t = surface->first_triangle + i;
            if (!scene->triangle_usable[t]) {
                continue;
            }
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
            for (int k = 0; k < 3; k++) {
                float *normal = scene->normals[scene->triangles[t][k]];
                vec3 unit = vec3_normalize_or(vec3_load(normal), (vec3){0.0f, 0.0f, 0.0f});
                bool usable = unit.x != 0.0f || unit.y != 0.0f || unit.z != 0.0f;
                bad += !usable;
                vec3_store(normal, usable ? unit : face);
            }
        }
        if (bad > 0 && !surface->normals_generated) {
            alpi_warn(scene->context, "bad-normals", surface->name,
                      "%u normal%s zero or not finite: the triangle's normal is used", bad,
                      alpi_one_or_many(bad, " is", "s are"));
        }
    }
    for (uint32_t v = 0; v < scene->vertex_count; v++) { // vertices of no usable triangle
        vec3_store(scene->normals[v],
                   vec3_normalize_or(vec3_load(scene->normals[v]), (vec3){0.0f, 1.0f, 0.0f}));
    }
}

static bool clamp_value(float *value, float low, float high)
{
    float clamped = *value >= low ? fminf(*value, high) : low; // NaN → low
    bool changed = !(*value == clamped);
    *value = clamped;
    return changed;
}

/// Far beyond what any map needs, so that a shader's squares stay finite.
static const float NORMAL_SCALE_LIMIT = 1000.0f;

static void clamp_materials(alp_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        alpi_material *m = &scene->materials[i];
        bool changed = clamp_value(&m->metallic, 0.0f, 1.0f);
        changed |= clamp_value(&m->occlusion_strength, 0.0f, 1.0f);
        changed |= clamp_value(&m->transmission, 0.0f, 1.0f);
        for (int k = 0; k < 4; k++) {
            changed |= clamp_value(&m->base_color[k], 0.0f, 1.0f);
        }
        for (int k = 0; k < 3; k++) {
            changed |= clamp_value(&m->emission[k], 0.0f, 1e20f);
        }
        changed |= clamp_value(&m->alpha_cutoff, 0.0f, 1e20f);
        m->normal_scale = isnan(m->normal_scale) ? 1.0f : m->normal_scale;
        changed |= clamp_value(&m->normal_scale, -NORMAL_SCALE_LIMIT, NORMAL_SCALE_LIMIT);
        if (changed) {
            alpi_warn(scene->context, "material-range", m->name,
                      "material %u has values out of range: clamped, so that energy does not grow",
                      i);
        }
    }
}

const char *alpi_scene_second_set(const alp_scene *scene)
{
    if (scene->attachments[ALPI_ATTACHMENT_OBJ].data != NULL) {
        return "the set of texture coordinates (vt)";
    }
    return scene->attachments[ALPI_ATTACHMENT_COLLADA].data != NULL
               ? "the second UV set (<input semantic=\"TEXCOORD\">)"
               : "the second UV set (TEXCOORD_1)";
}

static bool is_assumed_metal(const alpi_material *m)
{
    static const float METAL = 0.9f;
    const float *color = m->base_color; // black is black of any material
    return m->metallic_assumed && m->metallic >= METAL &&
           (color[0] > 0.0f || color[1] > 0.0f || color[2] > 0.0f);
}

void alpi_scene_warn_of_metal(const alp_scene *scene)
{
    double metal = 0.0, area = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t m = scene->surfaces[scene->triangle_surface[t]].material;
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        const double own = scene->triangle_usable[t] ? vec3_triangle_area(c[0], c[1], c[2]) : 0.0;
        area += own;
        metal += m != ALPI_NONE && is_assumed_metal(&scene->materials[m]) ? own : 0.0;
    }
    if (metal > 0.5 * area) {
        alpi_warn(
            scene->context, "metal", scene->name,
            "%.0f %% of the surface is metal, the default of glTF: viewers that multiply a light "
            "map by the diffuse colour show it black; set metallicFactor to 0 on other materials",
            100.0 * metal / area);
    }
}

/// Float coordinates far from the origin cannot hold fine detail: say so where it will be seen.
static void warn_of_precision(const alp_scene *scene)
{
    vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    float extent = vec3_length(size);
    vec3 low = scene->bounds_min, high = scene->bounds_max;
    float far = fmaxf(fmaxf(fmaxf(fabsf(low.x), fabsf(low.y)), fmaxf(fabsf(low.z), fabsf(high.x))),
                      fmaxf(fabsf(high.y), fabsf(high.z)));
    far = fmaxf(far, scene->rounded_at);
    float spacing = nextafterf(far, INFINITY) - far; // of floats at the farthest coordinate
    if (scene->usable_count > 0 && spacing > extent * 1e-4f) {
        alpi_warn(scene->context, "precision", scene->name,
                  "coordinates reach %.3g m, where floats are %.2g m apart, in a scene of %.3g m: "
                  "move it near the origin",
                  (double)far, (double)spacing, (double)extent);
    }
}

alp_result alpi_scene_finish_quietly(alp_scene *scene)
{
    ALP_TRY(check_indices(scene));
    if (scene->triangle_usable == NULL) {
        ALPI_TRY_NEW(scene->context, scene->triangle_usable, scene->triangle_count);
    }
    mark_triangles(scene);
    repair_normals(scene); // asks which triangles are usable
    clamp_materials(scene);
    return alpi_sides_create(scene);
}

alp_result alpi_scene_finish(alp_scene *scene)
{
    ALP_TRY(alpi_scene_finish_quietly(scene));
    note_flat(scene);
    warn_of_precision(scene);
    return ALP_OK;
}

void alp_scene_set_metals(alp_scene *scene, alp_metals metals)
{
    if (scene != NULL && (metals == ALP_METALS_DIFFUSE || metals == ALP_METALS_BLACK)) {
        scene->metals_black = metals == ALP_METALS_BLACK;
    }
}

// --- questions -----------------------------------------------------------------------------------

alp_scene_info alp_scene_get_info(const alp_scene *scene)
{
    if (scene == NULL) {
        return (alp_scene_info){0};
    }
    alp_scene_info info = {
        .triangles = scene->triangle_count,
        .usable_triangles = scene->usable_count,
        .surfaces = scene->surface_count,
        .vertices = scene->vertex_count,
        .materials = scene->material_count,
        .images = scene->image_count,
        .cameras = scene->camera_count,
        .lights = scene->light_count,
        .animations = scene->animation_count,
        .light_maps = scene->light_map_count,
        .area = scene->area,
        .unit_metres = scene->unit_metres,
        .unit_stated = !scene->unit_assumed,
        .up_axis = scene->up_axis,
        .hash = scene->input_hash,
    };
    memcpy(info.origin, scene->origin, sizeof info.origin);
    vec3_store(info.bounds_min, scene->bounds_min);
    vec3_store(info.bounds_max, scene->bounds_max);
    return info;
}

alp_surface_info alp_scene_get_surface(const alp_scene *scene, uint32_t index)
{
    alp_surface_info info = {.name = "", .material = "", .material_index = ALP_NONE};
    if (scene == NULL || index >= scene->surface_count) {
        return info;
    }
    const alpi_surface *s = &scene->surfaces[index];
    const alpi_material *m = s->material == ALPI_NONE ? NULL : &scene->materials[s->material];
    info = (alp_surface_info){.name = s->name,
                              .material = m ? m->name : "",
                              .first_triangle = s->first_triangle,
                              .triangle_count = s->triangle_count,
                              .uv_sets = s->uv_sets,
                              .double_sided = m != NULL && m->double_sided,
                              .mirrored = s->mirrored,
                              .normals_generated = s->normals_generated,
                              .emission = {m ? m->emission[0] : 0.0f, m ? m->emission[1] : 0.0f,
                                           m ? m->emission[2] : 0.0f},
                              .material_index = s->material,
                              .uv_slots = s->uv_slots | ((1u << s->uv_sets) - 1u)};
    alpi_surface_normal_axes(s, info.axes);
    return info;
}

alp_light_info alp_scene_get_light(const alp_scene *scene, uint32_t index)
{
    alp_light_info info = {.name = ""};
    if (scene == NULL || index >= scene->light_count) {
        return info;
    }
    const alpi_light *l = &scene->lights[index];
    info = (alp_light_info){.name = l->name,
                            .kind = l->kind,
                            .intensity = l->intensity,
                            .range = l->range,
                            .inner_cone = l->inner_cone,
                            .outer_cone = l->outer_cone,
                            .size = l->size};
    vec3_store(info.color, l->color);
    vec3_store(info.position, l->position);
    vec3_store(info.direction, l->direction);
    return info;
}

alp_animation_info alp_scene_get_animation(const alp_scene *scene, uint32_t index)
{
    if (scene == NULL || index >= scene->animation_count) {
        return (alp_animation_info){.name = ""};
    }
    const alpi_animation *a = &scene->animations[index];
    return (alp_animation_info){.name = a->name, .seconds = a->seconds, .channels = a->channels};
}

alp_camera alp_scene_get_camera(const alp_scene *scene, uint32_t index)
{
    if (scene == NULL) {
        return (alp_camera){
            .target = {0.0f, 0.0f, -1.0f}, .up = {0.0f, 1.0f, 0.0f}, .vertical_fov = 0.8f};
    }
    return index < scene->camera_count ? scene->cameras[index] : alpi_viewpoint_usual(scene);
}

static uint64_t hash_light(uint64_t hash, const alpi_light *l)
{
    const float values[] = {(float)l->kind, l->color.x,     l->color.y,     l->color.z,
                            l->intensity,   l->position.x,  l->position.y,  l->position.z,
                            l->direction.x, l->direction.y, l->direction.z, l->range,
                            l->inner_cone,  l->outer_cone,  l->size};
    return alpi_hash_bytes(hash, values, sizeof values);
}

uint64_t alpi_scene_pose_hash(const alp_scene *scene)
{
    uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, scene->positions,
                                    scene->vertex_count * sizeof *scene->positions);
    hash =
        alpi_hash_bytes(hash, scene->triangles, scene->triangle_count * sizeof *scene->triangles);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        hash = hash_light(hash, &scene->lights[i]);
    }
    return hash;
}

uint64_t alpi_scene_images_hash(const alp_scene *scene)
{
    uint64_t hash = ALPI_HASH_START;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        hash = alpi_hash_bytes(hash, &i, sizeof i);
        hash = scene->images[i] != NULL ? alpi_image_hash(hash, scene->images[i]) : hash;
    }
    return hash;
}
