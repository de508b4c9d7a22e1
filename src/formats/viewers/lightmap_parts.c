// SPDX-License-Identifier: MIT
// Surfaces × pages as meshes, materials × pages as materials, and their numbers as JSON.
#include "formats/viewers/lightmap_parts.h"

#include "base/memory.h"
#include "formats/images/images.h"

#include <stdlib.h>

// --- meshes --------------------------------------------------------------------------------------

typedef struct placed_triangle {
    uint32_t page, triangle;
} placed_triangle;

typedef struct builder {
    alp_context *context;
    const alp_scene *scene;
    const alpi_light_pages *light;
    alpi_lightmap_parts *out;
    placed_triangle *order; // of one surface
    uint32_t *last;         // [scene.vertex_count] newest copy of each, of any part
    uint32_t *older;        // [corners] the copy before it
    uint32_t *first_slots;  // [scene.material_count + 1], the last for none
    size_t part_capacity, slot_capacity;
    uint32_t vertex_count, index_count;
} builder;

static int compare_placed(const void *left, const void *right)
{
    const placed_triangle *a = left, *b = right;
    if (a->page != b->page) {
        return a->page < b->page ? -1 : 1;
    }
    return a->triangle < b->triangle ? -1 : a->triangle > b->triangle;
}

/// Usable triangles of a surface by page; those without a map last.
static uint32_t place_triangles(builder *b, const alpi_surface *surface)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        uint32_t t = surface->first_triangle + i;
        if (b->scene->triangle_usable[t]) {
            uint32_t page = b->light->triangle_pages != NULL ? b->light->triangle_pages[t] : 0;
            b->order[count++] = (placed_triangle){page, t};
        }
    }
    if (count > 0) {
        qsort(b->order, count, sizeof *b->order, compare_placed);
    }
    return count;
}

static bool is_same_place(const float a[2], const float b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

/// A corner's vertex in the part: one that is there already, or a new one.
static void add_corner(builder *b, alpi_lightmap_part *part, uint32_t vertex, const float uv[2])
{
    alpi_lightmap_parts *out = b->out;
    uint32_t copy = b->last[vertex];
    // Copies of earlier parts lie below this one's first.
    while (copy != ALPI_NONE && copy >= part->first_vertex && !is_same_place(out->uvs[copy], uv)) {
        copy = b->older[copy];
    }
    if (copy == ALPI_NONE || copy < part->first_vertex) {
        copy = b->vertex_count++;
        part->vertex_count++;
        b->older[copy] = b->last[vertex];
        b->last[vertex] = copy;
        out->vertices[copy] = vertex;
        out->uvs[copy][0] = uv[0];
        out->uvs[copy][1] = uv[1];
    }
    out->indices[b->index_count++] = copy - part->first_vertex;
    part->index_count++;
}

static bool has_colors(const builder *b, const alpi_lightmap_part *part)
{
    if (b->scene->colors == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < part->vertex_count; i++) {
        const float *c = b->scene->colors[b->out->vertices[part->first_vertex + i]];
        if (c[0] != 1.0f || c[1] != 1.0f || c[2] != 1.0f || c[3] != 1.0f) {
            return true;
        }
    }
    return false;
}

static alp_result find_slot(builder *b, alpi_lightmap_part *part, uint32_t page)
{
    alpi_lightmap_parts *out = b->out;
    uint32_t material = b->scene->surfaces[part->surface].material;
    uint32_t *first = &b->first_slots[material == ALPI_NONE ? b->scene->material_count : material];
    bool colored = has_colors(b, part);
    for (uint32_t s = *first; s != ALPI_NONE; s = out->slots[s].next) {
        if (out->slots[s].page == page && out->slots[s].colored == colored) {
            part->slot = s;
            return ALP_OK;
        }
    }
    void *items = out->slots;
    ALP_TRY(alpi_grow(b->context, &items, &b->slot_capacity, (size_t)out->slot_count + 1,
                      sizeof *out->slots));
    out->slots = items;
    out->slots[out->slot_count] = (alpi_lightmap_slot){material, page, colored, *first};
    part->slot = *first = out->slot_count++;
    return ALP_OK;
}

/// Triangles order[begin, end), all of one page.
static alp_result add_part(builder *b, uint32_t surface, uint32_t begin, uint32_t end)
{
    alpi_lightmap_part part = {
        .surface = surface, .first_vertex = b->vertex_count, .first_index = b->index_count};
    for (uint32_t i = begin; i < end; i++) {
        uint32_t t = b->order[i].triangle;
        for (int k = 0; k < 3; k++) {
            add_corner(b, &part, b->scene->triangles[t][k], b->light->corner_uvs[t][k]);
        }
    }
    ALP_TRY(find_slot(b, &part, b->order[begin].page));
    void *items = b->out->parts;
    ALP_TRY(alpi_grow(b->context, &items, &b->part_capacity, (size_t)b->out->part_count + 1,
                      sizeof *b->out->parts));
    b->out->parts = items;
    b->out->parts[b->out->part_count++] = part;
    return ALP_OK;
}

static alp_result add_surface(builder *b, uint32_t surface)
{
    uint32_t count = place_triangles(b, &b->scene->surfaces[surface]);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && b->order[end].page == b->order[begin].page; end++) {
        }
        ALP_TRY(add_part(b, surface, begin, end));
    }
    return ALP_OK;
}

static alp_result build(builder *b)
{
    const alp_scene *scene = b->scene;
    size_t corners = 3 * (size_t)scene->usable_count;
    if (corners > ALPI_NONE - 1) {
        return alpi_fail(b->context, ALP_ERROR_LIMIT,
                         "%s: %u triangles are more than one file of this kind can index; split "
                         "the scene",
                         scene->name, scene->usable_count);
    }
    ALPI_TRY_NEW(b->context, b->order, scene->triangle_count);
    ALPI_TRY_NEW(b->context, b->last, scene->vertex_count);
    ALPI_TRY_NEW(b->context, b->older, corners);
    ALPI_TRY_NEW(b->context, b->first_slots, (size_t)scene->material_count + 1);
    ALPI_TRY_NEW(b->context, b->out->vertices, corners);
    ALPI_TRY_NEW(b->context, b->out->uvs, corners);
    ALPI_TRY_NEW(b->context, b->out->indices, corners);
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        b->last[v] = ALPI_NONE;
    }
    for (uint32_t m = 0; m <= scene->material_count; m++) {
        b->first_slots[m] = ALPI_NONE;
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        ALP_TRY(add_surface(b, s));
    }
    return ALP_OK;
}

alp_result alpi_lightmap_parts_create(const alp_scene *scene, const alpi_light_pages *light,
                                      alpi_lightmap_parts *parts)
{
    *parts = (alpi_lightmap_parts){.scene = scene};
    builder b = {.context = scene->context, .scene = scene, .light = light, .out = parts};
    alp_result result = build(&b);
    alpi_release(b.context, b.order);
    alpi_release(b.context, b.last);
    alpi_release(b.context, b.older);
    alpi_release(b.context, b.first_slots);
    return result;
}

void alpi_lightmap_parts_destroy(alpi_lightmap_parts *parts)
{
    alp_context *context = parts->scene->context;
    alpi_release(context, parts->parts);
    alpi_release(context, parts->slots);
    alpi_release(context, parts->vertices);
    alpi_release(context, parts->uvs);
    alpi_release(context, parts->indices);
}

// --- sizes ---------------------------------------------------------------------------------------

/// Vertices where charts meet come out once for each.
static uint64_t guess_vertices(const alp_scene *scene)
{
    const uint64_t corners = 3 * (uint64_t)scene->usable_count;
    const uint64_t vertices = scene->vertex_count + scene->vertex_count / 4u;
    return vertices < corners ? vertices : corners;
}

uint64_t alpi_lightmap_text_size(const alp_scene *scene)
{
    enum {
        PART_BYTES = 800, // what is said of a surface, its material, and a camera
        PLACE_BYTES = 11, // a number between 1e-3 and 1e3, with its comma
        SIGN_BYTES = 11,  // one between −1 and 1
        INDEX_BYTES = 6
    };
    const bool textured = scene->uvs[0] != NULL && scene->image_count > 0;
    const uint64_t of_vertex = 3 * PLACE_BYTES + 3 * SIGN_BYTES + 2 * PLACE_BYTES +
                               (textured ? 2 * PLACE_BYTES : 0u) +
                               (scene->colors != NULL ? 4 * SIGN_BYTES : 0u);
    uint64_t images = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const alp_image *image = scene->images[i];
        images += image == NULL ? 0u
                                : (uint64_t)image->info.width * image->info.height *
                                      image->info.channels; // PNG saves what base64 costs
    }
    return of_vertex * guess_vertices(scene) + 3 * INDEX_BYTES * (uint64_t)scene->usable_count +
           PART_BYTES * ((uint64_t)scene->surface_count + scene->camera_count + 1) + images;
}

// --- their numbers -------------------------------------------------------------------------------

void alpi_lightmap_print_floats(alpi_bytes *text, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (i > 0) {
            alpi_bytes_add(text, ",", 1);
        }
        alpi_bytes_float(text, values[i]);
    }
}

void alpi_lightmap_print_point(alpi_bytes *text, const alp_scene *scene, const float point[3])
{
    for (int k = 0; k < 3; k++) {
        const double origin = scene->origin[k];
        alpi_bytes_print(text, "%s", k > 0 ? "," : "");
        if (origin != 0.0) {
            alpi_bytes_number(text, origin + (double)point[k], 17);
        } else {
            alpi_bytes_float(text, point[k]);
        }
    }
}

void alpi_lightmap_print_float(alpi_bytes *text, const char *name, float value)
{
    alpi_bytes_print(text, ",\"%s\":", name);
    alpi_bytes_float(text, value);
}

const char *alpi_lightmap_comma(uint32_t index)
{
    return index > 0 ? "," : "";
}

void alpi_lightmap_print_vertices(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                  const alpi_lightmap_part *part, const float *values, size_t width)
{
    for (uint32_t i = 0; i < part->vertex_count; i++) {
        if (i > 0) {
            alpi_bytes_add(text, ",", 1);
        }
        size_t vertex = parts->vertices[part->first_vertex + i];
        alpi_lightmap_print_floats(text, values + vertex * width, width);
    }
}

void alpi_lightmap_print_uvs(alpi_bytes *text, const alpi_lightmap_parts *parts,
                             const alpi_lightmap_part *part, const alpi_texture *texture)
{
    float(*uvs)[2] =
        texture->uv_set < ALPI_UV_SET_LIMIT ? parts->scene->uvs[texture->uv_set] : NULL;
    for (uint32_t i = 0; i < part->vertex_count; i++) {
        if (i > 0) {
            alpi_bytes_add(text, ",", 1);
        }
        uint32_t vertex = parts->vertices[part->first_vertex + i];
        vec2 uv = uvs != NULL ? (vec2){uvs[vertex][0], uvs[vertex][1]} : (vec2){0.0f, 0.0f};
        uv = alpi_texture_transform(texture, uv);
        const float finite[2] = {isfinite(uv.x) ? uv.x : 0.0f, isfinite(uv.y) ? uv.y : 0.0f};
        alpi_lightmap_print_floats(text, finite, 2);
    }
}

void alpi_lightmap_print_light_uvs(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                   const alpi_lightmap_part *part)
{
    alpi_lightmap_print_floats(text, parts->uvs[part->first_vertex],
                               2 * (size_t)part->vertex_count);
}

void alpi_lightmap_print_indices(alpi_bytes *text, const alpi_lightmap_parts *parts,
                                 const alpi_lightmap_part *part, bool clockwise)
{
    for (uint32_t i = 0; i < part->index_count; i += 3) {
        const uint32_t *corners = parts->indices + part->first_index + i;
        alpi_bytes_print(text, "%s%u,%u,%u", i > 0 ? "," : "", corners[0],
                         corners[clockwise ? 2 : 1], corners[clockwise ? 1 : 2]);
    }
}

// --- materials, images, cameras ------------------------------------------------------------------

alpi_material alpi_lightmap_material(const alp_scene *scene, const alpi_lightmap_slot *slot)
{
    if (slot->material != ALPI_NONE) {
        return scene->materials[slot->material];
    }
    alpi_material plain = alpi_material_default();
    plain.base_color[0] = plain.base_color[1] = plain.base_color[2] = 0.5f;
    return plain;
}

vec3 alpi_lightmap_albedo(const alp_scene *scene, const alpi_material *material)
{
    const float most = alpi_lightmap_has_image(scene, &material->base_color_texture) ? 1.0f : 0.95f;
    const float metal =
        alpi_lightmap_has_image(scene, &material->metallic_texture) ? 0.0f : material->metallic;
    vec3 albedo =
        vec3_scale(vec3_load(material->base_color), alpi_scene_diffuse_share(scene, metal));
    return vec3_min(albedo, (vec3){most, most, most});
}

void alpi_lightmap_warn_of_metal(const alpi_lightmap_parts *parts)
{
    const alp_scene *scene = parts->scene;
    uint32_t last = ALPI_NONE, count = 0;
    for (uint32_t m = 0; m < scene->material_count && scene->metals_black; m++) {
        const alpi_material *material = &scene->materials[m];
        if (alpi_lightmap_has_image(scene, &material->metallic_texture) &&
            material->metallic > 0.0f) {
            last = m;
            count++;
        }
    }
    if (count > 0) {
        alpi_warn(scene->context, "lightmap-metal", scene->materials[last].name,
                  "%u materials have a texture of metalness, which this format cannot hold; they"
                  " are written without metal",
                  count);
    }
}

bool alpi_lightmap_has_image(const alp_scene *scene, const alpi_texture *texture)
{
    return texture->image != ALPI_NONE && texture->image < scene->image_count &&
           scene->images[texture->image] != NULL &&
           scene->images[texture->image]->info.component == ALP_COMPONENT_U8;
}

alp_result alpi_lightmap_print_image(alpi_bytes *text, const alp_image *image)
{
    uint8_t *png = NULL;
    size_t size = 0;
    ALP_TRY(alpi_png_encode(image, &png, &size));
    alpi_bytes_print(text, "\"data:image/png;base64,");
    alpi_bytes_base64(text, png, size);
    alpi_bytes_print(text, "\"");
    alpi_release(text->context, png);
    return ALP_OK;
}

float alpi_lightmap_far(const alp_scene *scene, const alp_camera *camera)
{
    float far = 0.0f;
    for (int corner = 0; corner < 8; corner++) {
        vec3 p = {corner & 1 ? scene->bounds_max.x : scene->bounds_min.x,
                  corner & 2 ? scene->bounds_max.y : scene->bounds_min.y,
                  corner & 4 ? scene->bounds_max.z : scene->bounds_min.z};
        far = fmaxf(far, vec3_length(vec3_sub(p, vec3_load(camera->position))));
    }
    return isfinite(far) && far > 0.0f ? 1.01f * far : 1000.0f;
}
