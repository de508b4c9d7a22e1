// SPDX-License-Identifier: MIT
#include "test_gl.h"

#include "gl/gl_context.h"
#include "options/options.h"
#include "picture.h"
#include "render/camera_rays.h"
#include "scene/scene.h"
#include "test_shadows.h"
#include "trace/trace.h"

#include <stdio.h>
#include <stdlib.h>

static gl_context gl;

static void close_gl(void)
{
    gl_context_close(&gl);
}

bool test_gl_open(void)
{
    static bool tried;
    if (!tried) {
        tried = true;
        atexit(close_gl);
        (void)gl_context_open(&gl); // prints what is missing
    }
    if (gl.display == NULL) {
        printf("there is no OpenGL 4.5 without a window: skipped\n");
        return false;
    }
    gl.failed = false;
    return true;
}

void test_gl_check(void)
{
    assert_int_equal(gl_context_check(&gl), EXIT_DONE);
}

void test_gl_expect_failure(void)
{
    assert_int_equal(gl_context_check(&gl), EXIT_FAILED);
}

// --- what rays see -------------------------------------------------------------------------------

/// The triangles in the middles of pixels, by rays.
static void trace_triangles(const alp_scene *scene, const alp_render_options *o,
                            const alp_camera *camera, uint32_t *triangles)
{
    alpi_tracer *tracer = NULL;
    alpi_view view;
    alpi_rays rays;
    const alpi_trace_filter filter = {.panes = o->method != ALP_RENDER_ALBEDO};
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(scene->context, alpi_view_place(scene->context, camera, o->width, o->height, &view));
    view.centred = true;
    alpi_rays_clear(&rays);
    for (uint32_t i = 0; i < o->width * o->height; i++) {
        alpi_hits hits;
        view.loops->packet(&view, i, 0, 0, &rays);
        alpi_trace_nearest_coherent(tracer, &rays, 1u, filter, &hits);
        triangles[i] = hits.triangle[0];
    }
}

/// The same of the scene with the object, whose triangles follow those of the scene.
static void trace_object(const alp_scene *scene, const alp_render_options *o,
                         const alp_camera *camera, uint32_t *triangles)
{
    alp_scene *object = NULL;
    alpi_tracer *tracers[2] = {NULL, NULL};
    alpi_view view;
    alpi_rays rays;
    ASSERT_OK(scene->context, alp_render_object_mesh(scene->context, &o->object, &object));
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &tracers[0], NULL));
    ASSERT_OK(scene->context, alpi_tracer_for_scene(object, NULL, NULL, &tracers[1], NULL));
    ASSERT_OK(scene->context, alpi_view_place(scene->context, camera, o->width, o->height, &view));
    view.centred = true;
    alpi_rays_clear(&rays);
    for (uint32_t i = 0; i < o->width * o->height; i++) {
        alpi_hits hits, own;
        view.loops->packet(&view, i, 0, 0, &rays);
        alpi_trace_nearest_coherent(tracers[0], &rays, 1u, (alpi_trace_filter){.panes = true},
                                    &hits);
        alpi_trace_nearest_coherent(tracers[1], &rays, 1u, (alpi_trace_filter){.one_sided = true},
                                    &own);
        const bool hidden = triangles[i] != ALPI_NONE && hits.distance[0] < own.distance[0];
        if (own.triangle[0] != ALPI_NONE && !hidden) {
            triangles[i] = scene->triangle_count + own.triangle[0];
        }
    }
    alp_scene_destroy(object);
}

/// Whether the pixels around one, itself included, see the same by both.
static bool is_alike(const uint32_t *a, const uint32_t *b, uint32_t x, uint32_t y,
                     const alp_render_options *o)
{
    for (uint32_t row = y > 0 ? y - 1 : 0; row <= y + 1 && row < o->height; row++) {
        for (uint32_t column = x > 0 ? x - 1 : 0; column <= x + 1 && column < o->width; column++) {
            const size_t at = (size_t)row * o->width + column;
            if (a[at] != b[at]) {
                return false;
            }
        }
    }
    return true;
}

static void compare_triangles(const alp_scene *scene, const alp_render_options *o,
                              const alp_camera *camera, const uint32_t *drawn, test_pair *pair)
{
    const size_t count = (size_t)o->width * o->height;
    uint32_t *traced = malloc(count * sizeof *traced), alike = 0;
    pair->alike = malloc(count * sizeof *pair->alike);
    assert_non_null(traced);
    pair->on_object = malloc(count * sizeof *pair->on_object);
    assert_non_null(pair->alike);
    assert_non_null(pair->on_object);
    trace_triangles(scene, o, camera, traced);
    if (o->object.kind != ALP_OBJECT_NONE) {
        trace_object(scene, o, camera, traced);
    }
    for (uint32_t i = 0; i < count; i++) {
        pair->alike[i] = is_alike(drawn, traced, i % o->width, i / o->width, o);
        alike += pair->alike[i] ? 1 : 0;
        pair->on_object[i] = drawn[i] != ALPI_NONE && drawn[i] >= scene->triangle_count;
    }
    pair->alike_share = (double)alike / (double)count;
    free(traced);
}

/// Whether the pixels around one have its value.
static bool is_even(const uint32_t *values, uint32_t x, uint32_t y, const alp_render_options *o)
{
    for (uint32_t row = y > 0 ? y - 1 : 0; row <= y + 1 && row < o->height; row++) {
        for (uint32_t column = x > 0 ? x - 1 : 0; column <= x + 1 && column < o->width; column++) {
            if (values[(size_t)row * o->width + column] != values[(size_t)y * o->width + x]) {
                return false;
            }
        }
    }
    return true;
}

/// Takes out pixels near the edge of a shadow: around them other lights arrive.
static void compare_shadows(const alp_scene *scene, const alp_render_options *o,
                            const alp_camera *camera, test_pair *pair)
{
    const uint32_t count = o->width * o->height;
    uint32_t *reached = malloc(count * sizeof *reached), alike = 0;
    assert_non_null(reached);
    test_shadows_trace(scene, o, camera, reached);
    for (uint32_t i = 0; i < count; i++) {
        pair->alike[i] = pair->alike[i] && is_even(reached, i % o->width, i / o->width, o);
        alike += pair->alike[i] ? 1 : 0;
    }
    pair->alike_share = (double)alike / (double)count;
    free(reached);
}

// --- both pictures -------------------------------------------------------------------------------

static const view_mode *mode_of(const alp_render_options *o)
{
    command_line line = {.command = COMMAND_VIEW};
    enum { ALBEDO = 1, LIGHTMAP, DIRECT, AMBIENT }; // choices of --with
    const alp_ambient_info info = alp_field_get_ambient(o->field);
    line.values[OPTION_WITH].choice = o->method == ALP_RENDER_ALBEDO     ? ALBEDO
                                      : o->method == ALP_RENDER_LIGHTMAP ? LIGHTMAP
                                      : info.color_count == 0            ? DIRECT
                                                              : AMBIENT + (int)info.model;
    return view_mode_of(&line);
}

const view_mode *test_gl_mode(const char *name)
{
    command_line line = {.command = COMMAND_VIEW};
    const char *at = option_find(COMMAND_VIEW, "--with", 6)->choices;
    const size_t length = strlen(name);
    while (strncmp(at, name, length) != 0 || (at[length] != '|' && at[length] != '\0')) {
        at = strchr(at, '|') + 1;
        line.values[OPTION_WITH].choice++;
    }
    return view_mode_of(&line);
}

/// The light of the mode of render's method.
static mode_light light_of(const alp_scene *scene, const alp_render_options *o)
{
    mode_light light = {0};
    if (o->lightmap != NULL) {
        assert_int_equal(gl_lightmap_create(scene, o->lightmap, ALP_MAP_LIGHT, ALP_BLEND_NORMAL,
                                            &light.lightmap),
                         EXIT_DONE);
    }
    if (o->field != NULL) {
        gl_ambient_create(o->field, &light.ambient);
    }
    return light;
}

static void draw(const alp_scene *scene, const alp_render_options *o, const alp_camera *camera,
                 alp_film_options film, const drawing_options *mode, test_pair *pair)
{
    const drawing_options options = {.context = scene->context,
                                     .mode = mode->mode,
                                     .light = mode->light,
                                     .lighting = &o->lighting,
                                     .width = o->width,
                                     .height = o->height,
                                     .object = o->object,
                                     .direct = !o->without_direct,
                                     .metals_black = scene->metals_black,
                                     .level_zero = true};
    drawing d;
    uint32_t *triangles = malloc((size_t)o->width * o->height * sizeof *triangles);
    assert_non_null(triangles);
    assert_int_equal(drawing_create(scene, &options, &d), EXIT_DONE);
    drawing_draw(&d, camera);
    ASSERT_OK(scene->context,
              drawing_develop(&d, scene->context, &film, &pair->drawn, &pair->drawn_light));
    picture_read_triangles(&d.targets, triangles);
    test_gl_check();
    compare_triangles(scene, o, camera, triangles, pair);
    if (o->field != NULL) {
        compare_shadows(scene, o, camera, pair);
    }
    free(triangles);
    drawing_destroy(&d);
    test_gl_check();
}

static test_pair make_pair(const drawing_options *mode, const alp_scene *scene,
                           const alp_render_options *options)
{
    test_pair pair = {.width = options->width, .height = options->height};
    alp_render_options o = *options;
    alp_camera camera;
    o.samples = 1;
    alp_film_options film = alp_render_film_options(o.method);
    film.dither = ALP_DITHER_NONE; // it would turn a difference of nothing into a byte
    ASSERT_OK(scene->context, alp_render_find_camera(scene, &o, &camera));
    ASSERT_OK(scene->context, alp_render(scene, &o, &pair.rendered_light));
    ASSERT_OK(scene->context,
              alp_film_develop(pair.rendered_light, &film, &pair.rendered, &film.exposure));
    film.auto_exposure = false; // the same of both
    draw(scene, &o, &camera, film, mode, &pair);
    return pair;
}

test_pair test_gl_pair(const alp_scene *scene, const alp_render_options *options)
{
    const drawing_options mode = {.mode = mode_of(options), .light = light_of(scene, options)};
    return make_pair(&mode, scene, options);
}

test_pair test_gl_pair_in(const char *mode, mode_light light, const alp_scene *scene,
                          const alp_render_options *options)
{
    return make_pair(&(drawing_options){.mode = test_gl_mode(mode), .light = light}, scene,
                     options);
}

void test_pair_destroy(test_pair *pair)
{
    alp_image_destroy(pair->drawn);
    alp_image_destroy(pair->rendered);
    alp_image_destroy(pair->drawn_light);
    alp_image_destroy(pair->rendered_light);
    free(pair->alike);
    free(pair->on_object);
    *pair = (test_pair){0};
}

double test_pair_equal_share(const test_pair *pair)
{
    const uint8_t *a = alp_image_bytes(pair->drawn), *b = alp_image_bytes(pair->rendered);
    size_t alike = 0, equal = 0;
    for (size_t i = 0; i < (size_t)pair->width * pair->height; i++) {
        bool near = true;
        for (size_t k = 3 * i; k < 3 * i + 3; k++) {
            near = near && abs((int)a[k] - (int)b[k]) <= 1;
        }
        alike += pair->alike[i] ? 1 : 0;
        equal += pair->alike[i] && near ? 1 : 0;
    }
    return alike > 0 ? (double)equal / (double)alike : 0.0;
}
