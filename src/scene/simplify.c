// SPDX-License-Identifier: MIT
// A scene with fewer triangles, for light that is sampled coarsely.
//
// Each surface is simplified alone, so materials stay apart. Corners at one place count as one
// vertex, unless textures or colours tell them apart there. The border of a surface that touches
// another one stays, so no gaps open between them.
//
// The simplifier removes objects that are smaller than the error. Leaves of a tree are, and
// together they hold back much light. So a surface that would lose much of its area is simplified
// with a half, a quarter or an eighth of the error, or it stays as it is.
#include "scene/scene.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <meshoptimizer.h>

#include <math.h>
#include <string.h>

enum { TRIALS = 4, STREAMS = ALPI_UV_SLOT_COUNT + 2, SCRATCH = 64 /* bytes a corner */ };
/// Share of its area that a surface keeps.
static const double KEPT_AREA = 0.8;
/// Cosine of the angle to a vertex normal beyond which a triangle is flat there.
static const float SMOOTH_COSINE = 0.9f;

typedef struct simplifier {
    const alp_scene *from;
    alp_scene *to;
    float error;        // metres
    bool *touches;      // [surface] shares a place with another surface
    uint32_t *owner;    // [vertex] of the first at a place: its surface; then: its copy
    uint32_t *corners;  // [3 × triangles] of the surface in work, from its first vertex on
    uint32_t *welded;   // [3 × triangles]
    uint32_t *result;   // [3 × triangles]
    uint32_t *sources;  // [vertex] of those that are left: their number from the first vertex on
    float (*places)[3]; // [vertex] of these: metres
} simplifier;

/// The surface in work.
typedef struct simple_surface {
    uint32_t index;
    size_t corner_count;
    uint32_t first, vertex_count; // of the vertices that it uses
    double area;
} simple_surface;

// --- which surfaces touch ------------------------------------------------------------------------

static void find_touching(simplifier *s)
{
    const alp_scene *scene = s->from;
    const size_t count = 3 * (size_t)scene->triangle_count;
    if (count == 0) {
        return;
    }
    meshopt_generateShadowIndexBuffer(s->welded, scene->triangles[0], count, scene->positions,
                                      scene->vertex_count, sizeof *scene->positions,
                                      sizeof *scene->positions);
    memset(s->owner, 0xff, scene->vertex_count * sizeof *s->owner);
    for (size_t i = 0; i < count; i++) {
        const uint32_t surface = scene->triangle_surface[i / 3];
        uint32_t *owner = &s->owner[s->welded[i]];
        if (*owner != ALPI_NONE && *owner != surface) {
            s->touches[*owner] = s->touches[surface] = true;
        }
        *owner = surface;
    }
}

// --- one surface ---------------------------------------------------------------------------------

static double area_of(const alp_scene *scene, uint32_t first, const uint32_t *corners)
{
    vec3 c[3];
    for (int k = 0; k < 3; k++) {
        c[k] = vec3_load(scene->positions[first + corners[k]]);
    }
    return vec3_triangle_area(c[0], c[1], c[2]);
}

static double area_of_all(const alp_scene *scene, uint32_t first, const uint32_t *corners,
                          size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i += 3) {
        sum += area_of(scene, first, corners + i);
    }
    return sum;
}

/// Collects usable triangles.
static simple_surface collect(simplifier *s, uint32_t index)
{
    const alp_scene *scene = s->from;
    const alpi_surface *surface = &scene->surfaces[index];
    simple_surface at = {.index = index, .first = ALPI_NONE};
    uint32_t last = 0;
    for (uint32_t t = 0; t < surface->triangle_count; t++) {
        const uint32_t triangle = surface->first_triangle + t;
        for (int k = 0; k < 3 && scene->triangle_usable[triangle]; k++) {
            const uint32_t corner = scene->triangles[triangle][k];
            at.first = corner < at.first ? corner : at.first;
            last = corner > last ? corner : last;
            s->corners[at.corner_count++] = corner;
        }
    }
    for (size_t i = 0; i < at.corner_count; i++) {
        s->corners[i] -= at.first;
    }
    at.vertex_count = at.corner_count > 0 ? last - at.first + 1 : 0;
    at.area = area_of_all(scene, at.first, s->corners, at.corner_count);
    return at;
}

static bool has_textures(const alp_scene *scene, uint32_t surface)
{
    const uint32_t material = scene->surfaces[surface].material;
    if (material == ALPI_NONE) {
        return false;
    }
    const alpi_material *m = &scene->materials[material];
    return m->base_color_texture.image != ALPI_NONE || m->metallic_texture.image != ALPI_NONE ||
           m->emission_texture.image != ALPI_NONE || m->occlusion_texture.image != ALPI_NONE ||
           m->transmission_texture.image != ALPI_NONE;
}

/// Makes one vertex of those that are alike, and numbers those that are left. The simplifier would
/// take others at the same place for a seam. @return their number
static uint32_t weld(simplifier *s, const simple_surface *at)
{
    const alp_scene *scene = s->from;
    struct meshopt_Stream streams[STREAMS];
    size_t count = 0;
    streams[count++] =
        (struct meshopt_Stream){scene->positions[at->first], sizeof(float[3]), sizeof(float[3])};
    for (int slot = 0; slot < ALPI_UV_SLOT_COUNT && has_textures(scene, at->index); slot++) {
        if (scene->uvs[slot] != NULL) {
            streams[count++] = (struct meshopt_Stream){scene->uvs[slot][at->first],
                                                       sizeof(float[2]), sizeof(float[2])};
        }
    }
    if (scene->colors != NULL) {
        streams[count++] =
            (struct meshopt_Stream){scene->colors[at->first], sizeof(float[4]), sizeof(float[4])};
    }
    meshopt_generateShadowIndexBufferMulti(s->welded, s->corners, at->corner_count,
                                           at->vertex_count, streams, count);
    uint32_t left = 0;
    for (size_t i = 0; i < at->corner_count; i++) {
        s->owner[at->first + s->welded[i]] = ALPI_NONE;
    }
    for (size_t i = 0; i < at->corner_count; i++) {
        uint32_t *number = &s->owner[at->first + s->welded[i]];
        if (*number == ALPI_NONE) {
            s->sources[left] = s->welded[i];
            memcpy(s->places[left], scene->positions[at->first + s->welded[i]], sizeof *s->places);
            *number = left++;
        }
        s->welded[i] = *number;
    }
    return left;
}

/// Simplifies the surface to s->result. @return number of corners
static size_t simplify(simplifier *s, const simple_surface *at)
{
    const uint32_t vertices = weld(s, at);
    const float scale = meshopt_simplifyScale(s->places[0], vertices, sizeof *s->places);
    const unsigned options = s->touches[at->index] ? (unsigned)meshopt_SimplifyLockBorder : 0u;
    float error = s->error;
    for (int i = 0; i < TRIALS && scale > 0.0f; i++, error *= 0.5f) {
        const size_t count =
            meshopt_simplify(s->result, s->welded, at->corner_count, s->places[0], vertices,
                             sizeof *s->places, 0, error / scale, options, NULL);
        for (size_t k = 0; k < count; k++) {
            s->result[k] = s->sources[s->result[k]];
        }
        if (area_of_all(s->from, at->first, s->result, count) >= KEPT_AREA * at->area) {
            return count;
        }
    }
    memcpy(s->result, s->corners, at->corner_count * sizeof *s->result);
    return at->corner_count;
}

// --- the new scene -------------------------------------------------------------------------------

/// @return number of the copy
static uint32_t copy_vertex(const alp_scene *from, uint32_t source, alp_scene *to)
{
    const uint32_t v = to->vertex_count++;
    memcpy(to->positions[v], from->positions[source], sizeof to->positions[v]);
    memcpy(to->normals[v], from->normals[source], sizeof to->normals[v]);
    for (int slot = 0; slot < ALPI_UV_SLOT_COUNT; slot++) {
        if (to->uvs[slot] != NULL) {
            memcpy(to->uvs[slot][v], from->uvs[slot][source], sizeof to->uvs[slot][v]);
        }
    }
    if (to->colors != NULL) {
        memcpy(to->colors[v], from->colors[source], sizeof to->colors[v]);
    }
    to->vertex_source[v] = from->vertex_source[source];
    return v;
}

/// Adds a triangle. Vertices whose normal is far from its own are not shared: other triangles at
/// their place have other normals.
static void add_triangle(simplifier *s, const simple_surface *at, const uint32_t corners[3])
{
    alp_scene *to = s->to;
    vec3 c[3];
    for (int k = 0; k < 3; k++) {
        c[k] = vec3_load(s->from->positions[at->first + corners[k]]);
    }
    if (!(vec3_triangle_area(c[0], c[1], c[2]) > 0.0)) {
        return;
    }
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    for (int k = 0; k < 3; k++) {
        const uint32_t source = at->first + corners[k];
        uint32_t made = s->owner[source];
        if (vec3_dot(face, vec3_load(s->from->normals[source])) < SMOOTH_COSINE) {
            made = copy_vertex(s->from, source, to);
            vec3_store(to->normals[made], face);
        } else if (made == ALPI_NONE) {
            s->owner[source] = made = copy_vertex(s->from, source, to);
        }
        to->triangles[to->triangle_count][k] = made;
    }
    to->triangle_surface[to->triangle_count++] = at->index;
}

static alp_result add_surface(simplifier *s, const simple_surface *at, size_t count)
{
    alp_scene *to = s->to;
    alpi_surface *made = &to->surfaces[to->surface_count++];
    *made = s->from->surfaces[at->index];
    made->name = alpi_copy_string(to->context, made->name);
    made->first_vertex = to->vertex_count;
    made->first_triangle = to->triangle_count;
    for (size_t i = 0; i < count; i++) {
        s->owner[at->first + s->result[i]] = ALPI_NONE;
    }
    for (size_t i = 0; i < count; i += 3) {
        add_triangle(s, at, s->result + i);
    }
    made->vertex_count = to->vertex_count - made->first_vertex;
    made->triangle_count = to->triangle_count - made->first_triangle;
    return made->name != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

static alp_result copy_images(const alp_scene *from, alp_scene *to)
{
    ALPI_TRY_NEW(to->context, to->images, from->image_count);
    for (uint32_t i = 0; i < from->image_count; i++) {
        const alp_image *image = from->images[i];
        to->image_count++;
        if (image == NULL) {
            continue;
        }
        const alp_image_info info = image->info;
        const size_t size = info.component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1;
        ALP_TRY(alp_image_create(to->context, info, &to->images[i]));
        memcpy(to->images[i]->pixels, image->pixels,
               (size_t)info.width * info.height * info.channels * size);
    }
    return ALP_OK;
}

static alp_result copy_descriptions(const alp_scene *from, alp_scene *to)
{
    ALPI_TRY_NEW(to->context, to->materials, from->material_count);
    ALPI_TRY_NEW(to->context, to->lights, from->light_count);
    ALPI_TRY_NEW(to->context, to->cameras, from->camera_count);
    for (uint32_t i = 0; i < from->material_count; i++) {
        to->materials[to->material_count] = from->materials[i];
        char **name = &to->materials[to->material_count++].name;
        *name = alpi_copy_string(to->context, *name);
        if (*name == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    for (uint32_t i = 0; i < from->light_count; i++) {
        to->lights[to->light_count] = from->lights[i];
        char **name = &to->lights[to->light_count++].name;
        *name = *name != NULL ? alpi_copy_string(to->context, *name) : NULL;
        if (*name == NULL && from->lights[i].name != NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    to->camera_count = from->camera_count;
    if (from->camera_count > 0) {
        memcpy(to->cameras, from->cameras, from->camera_count * sizeof *to->cameras);
    }
    memcpy(to->origin, from->origin, sizeof to->origin);
    to->rounded_at = from->rounded_at;
    to->unit_metres = from->unit_metres;
    to->unit_assumed = from->unit_assumed;
    to->metals_black = from->metals_black;
    to->up_axis = from->up_axis;
    to->input_hash = from->input_hash;
    return copy_images(from, to);
}

static alp_result allocate(simplifier *s)
{
    const alp_scene *from = s->from;
    alp_scene *to = s->to;
    alp_context *context = from->context;
    const size_t corners = 3 * (size_t)from->triangle_count;
    ALPI_TRY_NEW(context, s->touches, from->surface_count);
    ALPI_TRY_NEW(context, s->owner, from->vertex_count);
    ALPI_TRY_NEW(context, s->corners, corners);
    ALPI_TRY_NEW(context, s->welded, corners);
    ALPI_TRY_NEW(context, s->result, corners);
    ALPI_TRY_NEW(context, s->sources, from->vertex_count);
    ALPI_TRY_NEW(context, s->places, from->vertex_count);
    ALPI_TRY_NEW(context, to->positions, corners);
    ALPI_TRY_NEW(context, to->normals, corners);
    ALPI_TRY_NEW(context, to->vertex_source, corners);
    for (int slot = 0; slot < ALPI_UV_SLOT_COUNT; slot++) {
        if (from->uvs[slot] != NULL) {
            ALPI_TRY_NEW(context, to->uvs[slot], corners);
        }
    }
    if (from->colors != NULL) {
        ALPI_TRY_NEW(context, to->colors, corners);
    }
    ALPI_TRY_NEW(context, to->triangles, from->triangle_count);
    ALPI_TRY_NEW(context, to->triangle_surface, from->triangle_count);
    ALPI_TRY_NEW(context, to->surfaces, from->surface_count);
    // The simplifier allocates behind our back: its memory is counted before.
    void *scratch = alpi_allocate(context, corners, SCRATCH);
    alpi_release(context, scratch);
    return scratch != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

static alp_result shrink(alp_context *context, void **array, size_t count, size_t size)
{
    void *smaller = alpi_reallocate(context, *array, count > 0 ? count : 1, size);
    *array = smaller != NULL ? smaller : *array;
    return smaller != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

/// Gives back memory that was held for corners that are gone.
static alp_result shrink_all(alp_scene *to)
{
    alp_context *c = to->context;
    const size_t v = to->vertex_count, t = to->triangle_count;
    ALP_TRY(shrink(c, (void **)&to->positions, v, sizeof *to->positions));
    ALP_TRY(shrink(c, (void **)&to->normals, v, sizeof *to->normals));
    ALP_TRY(shrink(c, (void **)&to->vertex_source, v, sizeof *to->vertex_source));
    for (int slot = 0; slot < ALPI_UV_SLOT_COUNT; slot++) {
        if (to->uvs[slot] != NULL) {
            ALP_TRY(shrink(c, (void **)&to->uvs[slot], v, sizeof *to->uvs[slot]));
        }
    }
    if (to->colors != NULL) {
        ALP_TRY(shrink(c, (void **)&to->colors, v, sizeof *to->colors));
    }
    ALP_TRY(shrink(c, (void **)&to->triangles, t, sizeof *to->triangles));
    return shrink(c, (void **)&to->triangle_surface, t, sizeof *to->triangle_surface);
}

static alp_result fill(simplifier *s)
{
    ALP_TRY(allocate(s));
    ALP_TRY(copy_descriptions(s->from, s->to));
    find_touching(s);
    for (uint32_t i = 0; i < s->from->surface_count; i++) {
        const simple_surface at = collect(s, i);
        ALP_TRY(add_surface(s, &at, at.corner_count > 0 ? simplify(s, &at) : 0));
        if (!alpi_loop_goes_on(s->from->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    ALP_TRY(shrink_all(s->to));
    return alpi_scene_finish_quietly(s->to);
}

alp_result alp_scene_simplify(const alp_scene *scene, float error, alp_scene **simple)
{
    if (scene == NULL || simple == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *simple = NULL;
    if (!(error > 0.0f) || !isfinite(error)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: simplified to %g m, need a finite error > 0", scene->name,
                         (double)error);
    }
    simplifier s = {.from = scene, .error = error};
    ALP_TRY(alpi_scene_create(scene->context, scene->name, &s.to));
    const alp_result result = fill(&s);
    alpi_release(scene->context, s.touches);
    alpi_release(scene->context, s.owner);
    alpi_release(scene->context, s.corners);
    alpi_release(scene->context, s.welded);
    alpi_release(scene->context, s.result);
    alpi_release(scene->context, s.sources);
    alpi_release(scene->context, s.places);
    if (result != ALP_OK) {
        alp_scene_destroy(s.to);
        return result;
    }
    *simple = s.to;
    return ALP_OK;
}
