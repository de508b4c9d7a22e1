// SPDX-License-Identifier: MIT
// The doctor's pictures: the scene from where most of it is seen, with what is wrong in colour.
#include "doctor/doctor.h"

#include "doctor/doctor_spot.h"

#include "base/tasks.h"
#include "render/automatic_camera.h"
#include "render/camera_rays.h"

#include <alpenglow/render.h>

#include <math.h>

enum { WIDTH = 960, HEIGHT = 720, SAMPLES = 8, OCCLUSION_SAMPLES = 128, ROWS_PER_RANGE = 8 };
/// The sky of the picture: soft light from above, a third of it from below.
static const float SKY_UP = 1.1f, SKY_DOWN = 0.35f;
/// Linear; what is behind the scene, at the top and at the bottom.
static const vec3 TOP = {0.32f, 0.36f, 0.42f}, BOTTOM = {0.72f, 0.74f, 0.77f};
/// Linear; normals that look to the back, and backs of single-sided surfaces.
static const vec3 RED = {0.80f, 0.03f, 0.03f}, ORANGE = {0.90f, 0.32f, 0.02f};
/// Linear: the triangle of a spot.
static const vec3 MAGENTA = {0.85f, 0.02f, 0.60f};
static const float TINT = 0.9f; // so much of the colour, the rest is the picture
/// A lamp over the left shoulder: factors of what faces away from it, and towards it.
static const float KEY_LOW = 0.72f, KEY_HIGH = 1.25f;

typedef struct scene_picture {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_view view;
    vec3 key;                  // unit, towards the lamp
    const float *light, *open; // [HEIGHT][WIDTH][4] of the two renderings
    uint8_t *bytes;            // [HEIGHT][WIDTH][3]
    uint32_t marked;           // triangle in magenta, ALPI_NONE = none
} scene_picture;

/// What a point of the picture shows, and means of several.
typedef struct look {
    float key;  // light of a lamp beside the camera, which tells faces of one slope apart
    float tint; // share of what is wrong
    vec3 color; // of it, times the share
} look;

static look look_at(const scene_picture *p, const alpi_hits *hits, int lane, vec3 direction)
{
    const alp_scene *scene = p->scene;
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE) {
        return (look){.key = 1.0f};
    }
    vec3 c[3], normal = {0.0f, 0.0f, 0.0f};
    alpi_triangle_corners(scene, triangle, c);
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const float weights[3] = {1.0f - hits->b1[lane] - hits->b2[lane], hits->b1[lane],
                              hits->b2[lane]};
    bool reversed = true;
    for (int k = 0; k < 3; k++) {
        const vec3 corner = vec3_load(scene->normals[scene->triangles[triangle][k]]);
        reversed = reversed && vec3_dot(face, corner) < 0.0f;
        normal = vec3_mad(normal, weights[k], corner);
    }
    normal = vec3_normalize_or(normal, face);
    const float side = vec3_dot(normal, direction) > 0.0f ? -1.0f : 1.0f;
    const float cosine = fmaxf(side * vec3_dot(normal, p->key), 0.0f);
    const bool behind =
        vec3_dot(face, direction) > 0.0f && !alpi_surface_is_double_sided(scene, triangle);
    const bool marked = triangle == p->marked;
    const float tint = marked || reversed || behind ? TINT : 0.0f;
    return (look){.key = KEY_LOW + (KEY_HIGH - KEY_LOW) * cosine,
                  .tint = tint,
                  .color = vec3_scale(marked     ? MAGENTA
                                      : reversed ? RED
                                                 : ORANGE,
                                      tint)};
}

static vec3 mix(vec3 a, vec3 b, float share)
{
    return vec3_add(vec3_scale(a, 1.0f - share), vec3_scale(b, share));
}

static void put_pixel(const scene_picture *p, uint32_t pixel, const look *l)
{
    const float *light = &p->light[4 * (size_t)pixel], open = p->open[4 * (size_t)pixel];
    const uint32_t row = pixel / WIDTH;
    const float covered = fminf(fmaxf(light[3], 0.0f), 1.0f);
    const vec3 behind = mix(TOP, BOTTOM, (float)row / (HEIGHT - 1));
    const vec3 surface = vec3_scale(vec3_load(light), open * l->key);
    // What is wrong is darker where it is closed, so that its shape stays visible.
    const vec3 color = vec3_add(vec3_scale(mix(behind, surface, covered), 1.0f - l->tint),
                                vec3_scale(l->color, (0.35f + 0.65f * open) * l->key));
    const float channels[3] = {color.x, color.y, color.z};
    for (int k = 0; k < 3; k++) {
        p->bytes[3 * (size_t)pixel + (size_t)k] =
            (uint8_t)(255.0f * alpi_linear_to_srgb(channels[k]) + 0.5f);
    }
}

/// Two pixels: four rays through each.
static void put_two(const scene_picture *p, uint32_t first)
{
    float x[ALPI_PACKET], y[ALPI_PACKET], d[3][ALPI_PACKET];
    alpi_rays rays;
    alpi_hits hits;
    look looks[2] = {{.key = 0.0f}, {.key = 0.0f}};
    for (uint32_t k = 0; k < ALPI_PACKET; k++) {
        const uint32_t pixel = first + k / 4, row = pixel / WIDTH;
        x[k] = (float)(pixel % WIDTH) + (k % 2 == 0 ? 0.25f : 0.75f);
        y[k] = (float)row + (k % 4 < 2 ? 0.25f : 0.75f);
    }
    p->view.loops->aim(&p->view, ALPI_PACKET, x, y, (float *const[3]){d[0], d[1], d[2]});
    alpi_rays_clear(&rays);
    for (int k = 0; k < ALPI_PACKET; k++) {
        alpi_rays_set(&rays, k, p->view.origin, (vec3){d[0][k], d[1][k], d[2][k]}, (float)INFINITY);
    }
    alpi_trace_nearest_coherent(p->tracer, &rays, (1u << ALPI_PACKET) - 1u,
                                (alpi_trace_filter){.one_sided = false}, &hits);
    for (int k = 0; k < ALPI_PACKET; k++) {
        const look l = look_at(p, &hits, k, (vec3){d[0][k], d[1][k], d[2][k]});
        looks[k / 4].key += 0.25f * l.key;
        looks[k / 4].tint += 0.25f * l.tint;
        looks[k / 4].color = vec3_mad(looks[k / 4].color, 0.25f, l.color);
    }
    put_pixel(p, first, &looks[0]);
    put_pixel(p, first + 1, &looks[1]);
}

static alp_result put_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t i = begin * WIDTH; i < end * WIDTH; i += 2) {
        put_two(user, i);
    }
    return ALP_OK;
}

/// The colour of surfaces under an even sky, and how much of it they see: two renderings that make
/// one picture, of any scene, lit or not.
static alp_result render_parts(const alp_scene *scene, const alp_camera *camera, alp_image **light,
                               alp_image **open)
{
    alp_render_options o = alp_render_options_default();
    o.width = WIDTH;
    o.height = HEIGHT;
    o.samples = SAMPLES;
    o.camera = *camera;
    o.method = ALP_RENDER_HEMISPHERE;
    o.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    for (int k = 0; k < 3; k++) {
        o.lighting.sky.up[k] = SKY_UP;
        o.lighting.sky.down[k] = SKY_DOWN;
    }
    ALP_TRY(alp_render(scene, &o, light));
    o.method = ALP_RENDER_AO;
    o.occlusion.samples = OCCLUSION_SAMPLES;
    return alp_render(scene, &o, open);
}

/// The triangle of a spot, in the scene.
static uint32_t marked_triangle(const alp_scene *scene, const alp_finding_spot *spot)
{
    return spot != NULL ? scene->surfaces[spot->surface].first_triangle + spot->triangle
                        : ALPI_NONE;
}

alp_result alpi_doctor_draw_scene(const alp_scene *scene, const alp_finding_spot *spot,
                                  alp_image **image)
{
    scene_picture p = {.scene = scene, .marked = marked_triangle(scene, spot)};
    alpi_tracer *tracer = NULL;
    alp_camera camera;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ALP_TRY(alpi_camera_choose(scene, UINT32_MAX, NULL, NULL, &camera));
    alpi_camera_frame(scene, (float)WIDTH / HEIGHT, &camera);
    if (spot != NULL) {
        alpi_doctor_aim(scene, tracer, spot, &camera);
    }
    ALP_TRY(alpi_view_place(scene->context, &camera, WIDTH, HEIGHT, &p.view));
    alp_image *light = NULL, *open = NULL;
    alp_result result = render_parts(scene, &camera, &light, &open);
    if (result == ALP_OK) {
        result = alp_image_create(scene->context,
                                  (alp_image_info){WIDTH, HEIGHT, 3, ALP_COMPONENT_U8}, image);
    }
    if (result == ALP_OK) {
        const vec3 right = vec3_normalize_or(p.view.right, (vec3){1.0f, 0.0f, 0.0f});
        const vec3 up = vec3_normalize_or(p.view.up, (vec3){0.0f, 1.0f, 0.0f});
        p.key = vec3_normalize_or(
            vec3_mad(vec3_mad(vec3_scale(p.view.forward, -0.6f), -0.6f, right), 0.5f, up), up);
        p.tracer = tracer;
        p.light = alp_image_floats(light);
        p.open = alp_image_floats(open);
        p.bytes = alp_image_bytes(*image);
        result = alpi_parallel_for(scene->context, HEIGHT, ROWS_PER_RANGE, put_rows, &p, NULL);
    }
    if (result == ALP_OK && spot != NULL) {
        alpi_doctor_ring_in_view(&p.view, vec3_load(spot->at), p.bytes);
    }
    alp_image_destroy(light);
    alp_image_destroy(open);
    if (result != ALP_OK) {
        alp_image_destroy(*image);
        *image = NULL;
    }
    return result;
}

// --- what there is to see ------------------------------------------------------------------------

uint32_t alp_diagnosis_picture_count(const alp_diagnosis *diagnosis)
{
    return diagnosis == NULL || diagnosis->scene->usable_count == 0
               ? 0
               : 1 + diagnosis->uv_set_count + diagnosis->spot_count;
}

const char *alp_diagnosis_picture_name(const alp_diagnosis *diagnosis, uint32_t index)
{
    static const char *const names[] = {"uv0", "uv1", "uv2", "uv3"};
    if (index >= alp_diagnosis_picture_count(diagnosis)) {
        return "";
    }
    if (index > diagnosis->uv_set_count) {
        return diagnosis->spot_names[index - diagnosis->uv_set_count - 1];
    }
    return index == 0 ? "scene" : names[diagnosis->uv_sets[index - 1].set % ALPI_UV_SET_LIMIT];
}

alp_result alp_diagnosis_picture(const alp_diagnosis *diagnosis, uint32_t index, alp_image **image)
{
    if (image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *image = NULL;
    if (index >= alp_diagnosis_picture_count(diagnosis)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const uint32_t sets = diagnosis->uv_set_count;
    if (index > sets) {
        const uint32_t finding = diagnosis->spots[index - sets - 1];
        return alpi_doctor_draw_scene(diagnosis->scene, &diagnosis->findings[finding].view.spot,
                                      image);
    }
    return index == 0
               ? alpi_doctor_draw_scene(diagnosis->scene, NULL, image)
               : alpi_doctor_draw_uv_set(diagnosis, diagnosis->uv_sets[index - 1].set, image);
}
