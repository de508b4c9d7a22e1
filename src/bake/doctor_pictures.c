// SPDX-License-Identifier: MIT
// The doctor's pictures: the scene from where most of it is seen, with what is wrong in colour.
#include "bake/doctor.h"

#include "base/tasks.h"
#include "render/automatic_camera.h"
#include "render/camera_rays.h"

#include <alpenglow/render.h>

#include <math.h>

enum { WIDTH = 960, HEIGHT = 720, SAMPLES = 16, ROWS_PER_RANGE = 8 };
/// The sky of the picture: soft light from above, a third of it from below.
static const float SKY_UP = 1.1f, SKY_DOWN = 0.35f;
/// Linear; what is behind the scene, at the top and at the bottom.
static const vec3 TOP = {0.32f, 0.36f, 0.42f}, BOTTOM = {0.72f, 0.74f, 0.77f};
/// Linear; normals that look to the back, and backs of single-sided surfaces.
static const vec3 RED = {0.80f, 0.03f, 0.03f}, ORANGE = {0.90f, 0.32f, 0.02f};
static const float TINT = 0.75f; // so much of the colour, the rest is the picture

typedef struct scene_picture {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_view view;
    const float *light, *open; // [HEIGHT][WIDTH][4] of the two renderings
    uint8_t *bytes;            // [HEIGHT][WIDTH][3]
} scene_picture;

/// What is wrong at a hit; false where nothing is.
static bool tint_of(const alp_scene *scene, uint32_t triangle, vec3 direction, vec3 *tint)
{
    if (triangle == ALPI_NONE) {
        return false;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    bool reversed = true;
    for (int k = 0; k < 3; k++) {
        const vec3 normal = vec3_load(scene->normals[scene->triangles[triangle][k]]);
        reversed = reversed && vec3_dot(face, normal) < 0.0f;
    }
    *tint = reversed ? RED : ORANGE;
    return reversed ||
           (vec3_dot(face, direction) > 0.0f && !alpi_surface_is_double_sided(scene, triangle));
}

static vec3 mix(vec3 a, vec3 b, float share)
{
    return vec3_add(vec3_scale(a, 1.0f - share), vec3_scale(b, share));
}

static void put_pixel(const scene_picture *p, uint32_t x, uint32_t y, bool tinted, vec3 tint)
{
    const size_t i = (size_t)y * WIDTH + x;
    const float *light = &p->light[4 * i], open = p->open[4 * i];
    const float covered = fminf(fmaxf(light[3], 0.0f), 1.0f);
    const vec3 behind = mix(TOP, BOTTOM, (float)y / (HEIGHT - 1));
    const vec3 surface = vec3_scale(vec3_load(light), open);
    vec3 color = mix(behind, surface, covered);
    if (tinted) { // darker where it is closed, so that the shape stays visible
        color = mix(color, vec3_scale(tint, 0.35f + 0.65f * open), TINT);
    }
    p->bytes[3 * i] = (uint8_t)(255.0f * alpi_linear_to_srgb(color.x) + 0.5f);
    p->bytes[3 * i + 1] = (uint8_t)(255.0f * alpi_linear_to_srgb(color.y) + 0.5f);
    p->bytes[3 * i + 2] = (uint8_t)(255.0f * alpi_linear_to_srgb(color.z) + 0.5f);
}

static alp_result put_rows(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const scene_picture *p = user;
    for (uint32_t i = begin * WIDTH; i < end * WIDTH; i += ALPI_PACKET) {
        float x[ALPI_PACKET], y[ALPI_PACKET], d[3][ALPI_PACKET];
        alpi_rays rays;
        alpi_hits hits;
        for (uint32_t k = 0; k < ALPI_PACKET; k++) {
            x[k] = (float)((i + k) % WIDTH) + 0.5f;
            y[k] = (float)((i + k) / WIDTH) + 0.5f;
        }
        p->view.loops->aim(&p->view, ALPI_PACKET, x, y, (float *const[3]){d[0], d[1], d[2]});
        alpi_rays_clear(&rays);
        for (int k = 0; k < ALPI_PACKET; k++) {
            alpi_rays_set(&rays, k, p->view.origin, (vec3){d[0][k], d[1][k], d[2][k]},
                          (float)INFINITY);
        }
        alpi_trace_nearest_coherent(p->tracer, &rays, (1u << ALPI_PACKET) - 1u,
                                    (alpi_trace_filter){.one_sided = false}, &hits);
        for (uint32_t k = 0; k < ALPI_PACKET; k++) {
            vec3 tint = RED;
            const bool tinted =
                tint_of(p->scene, hits.triangle[k], (vec3){d[0][k], d[1][k], d[2][k]}, &tint);
            put_pixel(p, (i + k) % WIDTH, (i + k) / WIDTH, tinted, tint);
        }
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
    return alp_render(scene, &o, open);
}

alp_result alpi_doctor_draw_scene(const alp_scene *scene, alp_image **image)
{
    scene_picture p = {.scene = scene};
    alpi_tracer *tracer = NULL;
    alp_camera camera;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ALP_TRY(alpi_camera_choose(scene, UINT32_MAX, NULL, NULL, &camera));
    ALP_TRY(alpi_view_place(scene->context, &camera, WIDTH, HEIGHT, &p.view));
    alp_image *light = NULL, *open = NULL;
    alp_result result = render_parts(scene, &camera, &light, &open);
    if (result == ALP_OK) {
        result = alp_image_create(scene->context,
                                  (alp_image_info){WIDTH, HEIGHT, 3, ALP_COMPONENT_U8}, image);
    }
    if (result == ALP_OK) {
        p.tracer = tracer;
        p.light = alp_image_floats(light);
        p.open = alp_image_floats(open);
        p.bytes = alp_image_bytes(*image);
        result = alpi_parallel_for(scene->context, HEIGHT, ROWS_PER_RANGE, put_rows, &p, NULL);
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
    return diagnosis == NULL || diagnosis->scene->usable_count == 0 ? 0
                                                                    : 1 + diagnosis->uv_set_count;
}

const char *alp_diagnosis_picture_name(const alp_diagnosis *diagnosis, uint32_t index)
{
    static const char *const names[] = {"uv0", "uv1", "uv2", "uv3"};
    if (index >= alp_diagnosis_picture_count(diagnosis)) {
        return "";
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
    return index == 0 ? alpi_doctor_draw_scene(diagnosis->scene, image)
                      : alpi_doctor_draw_uv_set(diagnosis->scene, diagnosis->uv_sets[index - 1].set,
                                                image);
}
