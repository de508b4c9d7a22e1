// SPDX-License-Identifier: MIT
// Batches of paths against one picture of many.
#include "test_gl.h"

#include "path_picture.h"
#include "picture.h"

#include <math.h>

enum { SIDE = 24, PIXELS = SIDE * SIDE };

static alp_render_options paths(uint32_t samples, uint64_t seed)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_REFERENCE;
    o.width = o.height = SIDE;
    o.samples = samples;
    o.occlusion.seed = seed;
    return o;
}

/// The picture of `samples` paths by batches. The caller destroys it.
static alp_image *accumulate(alp_context *context, const alp_scene *scene, path_picture *p)
{
    gl_targets targets;
    alp_camera camera;
    alp_image *image = NULL;
    assert_int_equal(gl_targets_create(SIDE, SIDE, &targets), EXIT_DONE);
    ASSERT_OK(context, alp_render_find_camera(scene, &p->options, &camera));
    ASSERT_OK(context, path_picture_draw(p, scene, &camera, &targets));
    ASSERT_OK(context, picture_read_light(context, &targets, &image));
    gl_targets_destroy(&targets);
    test_gl_check();
    return image;
}

/// Mean of green, times alpha.
static double mean_of(alp_image *image)
{
    const float *pixels = alp_image_floats(image);
    double sum = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        sum += (double)pixels[4 * i + 1] * (double)pixels[4 * i + 3];
    }
    return sum / PIXELS;
}

/// Mean square of the difference of green.
static double square_of(alp_image *a, alp_image *b)
{
    const float *x = alp_image_floats(a), *y = alp_image_floats(b);
    double sum = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double d = (double)x[4 * i + 1] - (double)y[4 * i + 1];
        sum += d * d;
    }
    return sum / PIXELS;
}

/// Standard error of the mean of green, from that of the pixels.
static double error_of(alp_image *error)
{
    const float *pixels = alp_image_floats(error);
    double sum = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        sum += (double)pixels[4 * i + 1] * (double)pixels[4 * i + 1];
    }
    return sqrt(sum) / PIXELS;
}

TEST_WITH_CONTEXT(one_batch_of_paths_is_the_picture_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    path_picture p = {.options = paths(16, 5), .samples = 1}; // rounded up
    alp_image *drawn = accumulate(context, scene, &p), *rendered = NULL;
    ASSERT_OK(context, alp_render(scene, &p.options, &rendered));
    assert_true(square_of(drawn, rendered) <= 1e-12 * mean_of(rendered) * mean_of(rendered));
    alp_image_destroy(rendered);
    alp_image_destroy(drawn);
    alp_scene_destroy(scene);
}

/// Four batches of 64 and one of 16: the mean lies within its error. Its noise is that of
/// independent batches that count by their paths.
TEST_WITH_CONTEXT(batches_of_paths_average_to_the_picture_of_render, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    path_picture p = {.options = paths(16, 0), .samples = 260};
    alp_render_options truth = paths(4096, 77), batch = paths(64, 78);
    alp_image *drawn = accumulate(context, scene, &p), *rendered = NULL, *one = NULL;
    alp_image *error = NULL;
    batch.error = &error;
    ASSERT_OK(context, alp_render(scene, &truth, &rendered));
    ASSERT_OK(context, alp_render(scene, &batch, &one));
    assert_int_equal(p.batches, 5);
    const double difference = mean_of(drawn) - mean_of(rendered);
    const double expected = square_of(one, rendered) / 4.0;
    const double noise = square_of(drawn, rendered) / expected;
    if (!(fabs(difference) <= 4.0 * error_of(error) / 2.0 && noise < 1.5)) {
        fail_msg("the mean differs by %.3g, error %.3g; noise is %.3g of the expected one",
                 difference, error_of(error) / 2.0, noise);
    }
    alp_image_destroy(drawn);
    alp_image_destroy(rendered);
    alp_image_destroy(one);
    alp_image_destroy(error);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(frames_have_paths_of_their_own, 2)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = test_load(context, "builtin:cornell");
    path_picture p = {.options = paths(16, 0), .samples = 16};
    alp_image *first = accumulate(context, scene, &p), *second = accumulate(context, scene, &p);
    assert_true(square_of(first, second) > 0.0);
    alp_image_destroy(first);
    alp_image_destroy(second);
    alp_scene_destroy(scene);
}
