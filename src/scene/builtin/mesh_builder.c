// SPDX-License-Identifier: MIT
// Growing a scene's arrays, and the shapes that the built-in scenes are made of.
#include "scene/builtin/mesh_builder.h"

#include "base/hash.h"
#include "base/memory.h"

#include <math.h>

void alpi_builder_start(alpi_builder *builder, alp_context *context, const char *name)
{
    *builder = (alpi_builder){.context = context};
    builder->result = alpi_scene_create(context, name, &builder->scene);
}

/// Makes room for one more item of an array; false after a failure.
static bool grow(alpi_builder *builder, void **items, size_t *capacity, size_t count, size_t size)
{
    if (builder->result == ALP_OK) {
        builder->result = alpi_grow(builder->context, items, capacity, count + 1, size);
    }
    return builder->result == ALP_OK;
}

#define GROW(builder, items, capacity, count)                                                      \
    grow((builder), (void **)&(builder)->scene->items, &(builder)->capacity,                       \
         (builder)->scene->count, sizeof *(builder)->scene->items)

static char *copy_name(alpi_builder *builder, const char *name)
{
    char *copy = alpi_copy_string(builder->context, name);
    if (copy == NULL) {
        builder->result = ALP_ERROR_OUT_OF_MEMORY;
    }
    return copy;
}

uint32_t alpi_builder_material(alpi_builder *builder, const char *name, vec3 color, vec3 emission)
{
    if (builder->result != ALP_OK || !GROW(builder, materials, material_capacity, material_count)) {
        return 0;
    }
    uint32_t index = builder->scene->material_count++;
    alpi_material *material = &builder->scene->materials[index];
    *material = alpi_material_default();
    vec3_store(material->base_color, color);
    vec3_store(material->emission, emission);
    material->name = copy_name(builder, name);
    return index;
}

void alpi_builder_surface(alpi_builder *builder, const char *name, uint32_t material)
{
    if (builder->result != ALP_OK || !GROW(builder, surfaces, surface_capacity, surface_count)) {
        return;
    }
    alp_scene *scene = builder->scene;
    uint32_t index = scene->surface_count++;
    scene->surfaces[index] = (alpi_surface){.node = index,
                                            .mesh = index,
                                            .material = material,
                                            .first_vertex = scene->vertex_count,
                                            .first_triangle = scene->triangle_count};
    scene->surfaces[index].name = copy_name(builder, name);
}

uint32_t alpi_builder_vertex(alpi_builder *builder, vec3 position, vec3 normal)
{
    if (builder->result != ALP_OK || !GROW(builder, positions, position_capacity, vertex_count) ||
        !GROW(builder, normals, normal_capacity, vertex_count) ||
        !GROW(builder, vertex_source, source_capacity, vertex_count)) {
        return 0;
    }
    alp_scene *scene = builder->scene;
    uint32_t index = scene->vertex_count++;
    vec3_store(scene->positions[index], position);
    vec3_store(scene->normals[index], normal);
    scene->vertex_source[index] = scene->surfaces[scene->surface_count - 1].vertex_count++;
    return index;
}

void alpi_builder_triangle(alpi_builder *builder, uint32_t a, uint32_t b, uint32_t c)
{
    if (builder->result != ALP_OK || !GROW(builder, triangles, triangle_capacity, triangle_count) ||
        !GROW(builder, triangle_surface, owner_capacity, triangle_count)) {
        return;
    }
    alp_scene *scene = builder->scene;
    uint32_t index = scene->triangle_count++;
    scene->triangles[index][0] = a;
    scene->triangles[index][1] = b;
    scene->triangles[index][2] = c;
    scene->triangle_surface[index] = scene->surface_count - 1;
    scene->surfaces[scene->surface_count - 1].triangle_count++;
}

void alpi_builder_camera(alpi_builder *builder, vec3 position, vec3 target, float vertical_fov)
{
    if (builder->result != ALP_OK || !GROW(builder, cameras, camera_capacity, camera_count)) {
        return;
    }
    alp_camera *camera = &builder->scene->cameras[builder->scene->camera_count++];
    *camera = (alp_camera){.up = {0.0f, 1.0f, 0.0f}, .vertical_fov = vertical_fov};
    vec3_store(camera->position, position);
    vec3_store(camera->target, target);
}

alp_result alpi_builder_finish(alpi_builder *builder, alp_scene **scene)
{
    alp_scene *made = builder->scene;
    alp_result result = builder->result;
    if (result == ALP_OK) {
        uint64_t hash = ALPI_HASH_START;
        hash = alpi_hash_bytes(hash, made->positions, made->vertex_count * sizeof *made->positions);
        hash = alpi_hash_bytes(hash, made->normals, made->vertex_count * sizeof *made->normals);
        hash =
            alpi_hash_bytes(hash, made->triangles, made->triangle_count * sizeof *made->triangles);
        made->input_hash = hash;
        result = alpi_scene_finish(made);
    }
    if (result != ALP_OK) {
        alp_scene_destroy(made);
        made = NULL;
    }
    *scene = made;
    builder->scene = NULL;
    return result;
}

// --- flat shapes ---------------------------------------------------------------------------------

void alpi_builder_quad(alpi_builder *builder, const vec3 corners[4])
{
    // The cross product of the diagonals is the mean normal of a quad that is not quite flat.
    vec3 across = vec3_cross(vec3_sub(corners[2], corners[0]), vec3_sub(corners[3], corners[1]));
    vec3 normal = vec3_normalize_or(across, (vec3){0.0f, 1.0f, 0.0f});
    uint32_t v[4];
    for (int i = 0; i < 4; i++) {
        v[i] = alpi_builder_vertex(builder, corners[i], normal);
    }
    alpi_builder_triangle(builder, v[0], v[1], v[2]);
    alpi_builder_triangle(builder, v[0], v[2], v[3]);
}

void alpi_builder_box(alpi_builder *builder, vec3 low, vec3 high, unsigned faces)
{
    // Corner i: bit 0 = +x, bit 1 = +y, bit 2 = +z. Each face counter-clockwise from outside.
    static const int corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    bool inside = low.x > high.x; // three mirrored axes turn the winding by themselves
    for (int face = 0; face < 6; face++) {
        vec3 quad[4];
        for (int k = 0; k < 4; k++) {
            int corner = corners[face][k];
            quad[k] = (vec3){corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                             corner & 4 ? high.z : low.z};
        }
        // Seen from inside, low and high are swapped, and so are the faces of each axis.
        int wanted = inside ? face ^ 1 : face;
        if (faces & (1u << wanted)) {
            alpi_builder_quad(builder, quad);
        }
    }
}

static vec3 panel_point(const alpi_panel *panel, uint32_t i, uint32_t j)
{
    return vec3_mad(vec3_mad(panel->origin, panel->u_cuts[i], panel->u), panel->v_cuts[j],
                    panel->v);
}

void alpi_builder_panel(alpi_builder *builder, const alpi_panel *panel)
{
    for (uint32_t j = 0; j + 1 < panel->v_count; j++) {
        for (uint32_t i = 0; i + 1 < panel->u_count; i++) {
            if (i == panel->hole_u && j == panel->hole_v) {
                continue;
            }
            const vec3 corners[4] = {panel_point(panel, i, j), panel_point(panel, i + 1, j),
                                     panel_point(panel, i + 1, j + 1),
                                     panel_point(panel, i, j + 1)};
            alpi_builder_quad(builder, corners);
        }
    }
}

// --- round shapes --------------------------------------------------------------------------------

void alpi_builder_turn(uint32_t i, uint32_t n, double *cosine, double *sine)
{
    double angle = 2.0 * ALPI_PI * i / n;
    bool quarter = 4 * (uint64_t)i % n == 0;
    *cosine = quarter ? round(cos(angle)) : cos(angle);
    *sine = quarter ? round(sin(angle)) : sin(angle);
}

/// Vertex of a ball in direction d (unit).
static uint32_t ball_vertex(alpi_builder *builder, const alpi_ball *ball, double x, double y,
                            double z)
{
    double r = (double)ball->radius;
    vec3 position = {(float)((double)ball->center.x + r * x),
                     (float)((double)ball->center.y + r * y),
                     (float)((double)ball->center.z + r * z)};
    vec3 normal = {(float)x, (float)y, (float)z};
    return alpi_builder_vertex(builder, position,
                               ball->inside ? vec3_scale(normal, -1.0f) : normal);
}

/// Seen from outside a, b, c are counter-clockwise; from inside they are turned round.
static void ball_triangle(alpi_builder *builder, const alpi_ball *ball, uint32_t a, uint32_t b,
                          uint32_t c)
{
    alpi_builder_triangle(builder, a, ball->inside ? c : b, ball->inside ? b : c);
}

void alpi_builder_ball(alpi_builder *builder, const alpi_ball *ball)
{
    bool closed = ball->top >= ball->radius;
    double end = closed ? ALPI_PI : acos(-(double)ball->top / (double)ball->radius);
    uint32_t rings = closed ? ball->stacks - 1 : ball->stacks;
    uint32_t bottom = ball_vertex(builder, ball, 0.0, -1.0, 0.0), first = bottom + 1;
    for (uint32_t j = 1; j <= rings; j++) {
        double polar = end * j / ball->stacks; // from −y
        for (uint32_t i = 0; i < ball->slices; i++) {
            double c, s;
            alpi_builder_turn(i, ball->slices, &c, &s);
            ball_vertex(builder, ball, sin(polar) * c, -cos(polar), sin(polar) * s);
        }
    }
    uint32_t top = closed ? ball_vertex(builder, ball, 0.0, 1.0, 0.0) : ALPI_NONE;
    for (uint32_t i = 0; i < ball->slices; i++) {
        uint32_t next = (i + 1) % ball->slices;
        ball_triangle(builder, ball, bottom, first + i, first + next);
        for (uint32_t j = 0; j + 1 < rings; j++) {
            uint32_t low = first + j * ball->slices, high = low + ball->slices;
            ball_triangle(builder, ball, low + i, high + i, high + next);
            ball_triangle(builder, ball, low + i, high + next, low + next);
        }
        if (closed) {
            uint32_t last = first + (rings - 1) * ball->slices;
            ball_triangle(builder, ball, last + i, top, last + next);
        }
    }
}

void alpi_builder_ring(alpi_builder *builder, const alpi_ring *ring)
{
    uint32_t first = builder->result == ALP_OK ? builder->scene->vertex_count : 0;
    for (uint32_t i = 0; i < ring->slices; i++) {
        double c, s;
        alpi_builder_turn(i, ring->slices, &c, &s);
        for (uint32_t j = 0; j < ring->sides; j++) {
            double out, up;
            alpi_builder_turn(j, ring->sides, &out, &up);
            double away = (double)ring->major_radius + (double)ring->minor_radius * out;
            vec3 position = {(float)((double)ring->center.x + away * c),
                             (float)((double)ring->center.y + (double)ring->minor_radius * up),
                             (float)((double)ring->center.z + away * s)};
            alpi_builder_vertex(builder, position,
                                (vec3){(float)(out * c), (float)up, (float)(out * s)});
        }
    }
    for (uint32_t i = 0; i < ring->slices; i++) {
        uint32_t here = first + i * ring->sides,
                 there = first + (i + 1) % ring->slices * ring->sides;
        for (uint32_t j = 0; j < ring->sides; j++) {
            uint32_t next = (j + 1) % ring->sides;
            alpi_builder_triangle(builder, here + j, here + next, there + next);
            alpi_builder_triangle(builder, here + j, there + next, there + j);
        }
    }
}

/// A ring of vertices at profile point p.
static uint32_t lathe_ring(alpi_builder *builder, const alpi_lathe *lathe, const float p[2],
                           const double normal[2])
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < lathe->slices; i++) {
        double c, s;
        alpi_builder_turn(i, lathe->slices, &c, &s);
        vec3 position = {(float)((double)lathe->foot.x + (double)p[0] * c), lathe->foot.y + p[1],
                         (float)((double)lathe->foot.z + (double)p[0] * s)};
        uint32_t vertex = alpi_builder_vertex(
            builder, position,
            (vec3){(float)(normal[0] * c), (float)normal[1], (float)(normal[0] * s)});
        first = i == 0 ? vertex : first;
    }
    return first;
}

void alpi_builder_lathe(alpi_builder *builder, const alpi_lathe *lathe)
{
    for (uint32_t k = 0; k + 1 < lathe->point_count; k++) {
        const float *p = lathe->profile[k], *q = lathe->profile[k + 1];
        double across = (double)q[0] - (double)p[0], up = (double)q[1] - (double)p[1];
        double length = sqrt(across * across + up * up);
        const double normal[2] = {up / length, -across / length};
        uint32_t low = lathe_ring(builder, lathe, p, normal);
        uint32_t high = lathe_ring(builder, lathe, q, normal);
        for (uint32_t i = 0; i < lathe->slices; i++) {
            uint32_t next = (i + 1) % lathe->slices;
            if (q[0] > 0.0f) { // else the ring is one point
                alpi_builder_triangle(builder, low + i, high + i, high + next);
            }
            if (p[0] > 0.0f) {
                alpi_builder_triangle(builder, low + i, high + next, low + next);
            }
        }
    }
}
