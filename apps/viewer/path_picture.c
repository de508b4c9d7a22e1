// SPDX-License-Identifier: MIT
#include "path_picture.h"

#include "printing/messages.h"
#include "printing/progress.h"

#include <stdlib.h>
#include <string.h>

/// Paths a pixel of a batch, and the fewest that alp_render traces. Paths of one batch are spread
/// more evenly than those of several.
enum { BATCH = 64, FEWEST = 16 };

/// An odd number, whose multiples keep seeds of batches far from seeds that users give.
static const uint64_t SEED_STEP = 0x9e3779b97f4a7c15u;

/// Progress of all batches of a frame.
typedef struct frame_progress {
    alp_progress_fn *progress; // NULL: none
    void *user;
    uint64_t done, total; // paths a pixel
    uint64_t batch;       // of the batch that is traced
    double start;         // seconds
} frame_progress;

static bool show(void *user, const alp_progress *state)
{
    const frame_progress *f = user;
    alp_progress all = *state;
    all.done = f->done * state->total + f->batch * state->done;
    all.total = f->total * state->total;
    const double seconds = clock_seconds() - f->start;
    all.seconds_left =
        all.done > 0 ? seconds * (double)(all.total - all.done) / (double)all.done : -1.0;
    return f->progress == NULL || f->progress(f->user, &all);
}

/// Adds a picture. Its light counts by its alpha.
static void add(alp_image *image, size_t count, float weight, float (*sums)[4])
{
    const float *pixels = alp_image_floats(image);
    for (size_t i = 0; i < count; i++) {
        const float covered = weight * pixels[4 * i + 3];
        for (size_t k = 0; k < 3; k++) {
            sums[i][k] += covered * pixels[4 * i + k];
        }
        sums[i][3] += covered;
    }
}

static void average(float (*sums)[4], size_t count, float weight)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 3 && sums[i][3] > 0.0f; k++) {
            sums[i][k] /= sums[i][3];
        }
        sums[i][3] /= weight;
    }
}

/// @param o of the next batch
static alp_result trace(path_picture *p, const alp_scene *scene, alp_render_options *o,
                        float (*sums)[4])
{
    alp_image *image = NULL;
    o->occlusion.seed = p->options.occlusion.seed + p->batches++ * SEED_STEP;
    const alp_result result = alp_render(scene, o, &image);
    if (result == ALP_OK) {
        add(image, (size_t)o->width * o->height, (float)o->samples, sums);
    }
    alp_image_destroy(image);
    return result;
}

alp_result path_picture_draw(path_picture *p, const alp_scene *scene, const alp_camera *camera,
                             const gl_targets *t)
{
    alp_render_options o = p->options;
    const size_t count = (size_t)o.width * o.height;
    frame_progress f = {.progress = o.progress,
                        .user = o.progress_user,
                        .total = (uint64_t)(p->samples + FEWEST - 1) / FEWEST * FEWEST,
                        .start = clock_seconds()};
    float(*sums)[4] = allocate_or_exit(NULL, count * sizeof *sums);
    alp_result result = ALP_OK;
    memset(sums, 0, count * sizeof *sums);
    o.camera = *camera;
    o.progress = show;
    o.progress_user = &f;
    for (; f.done < f.total && result == ALP_OK; f.done += f.batch) {
        f.batch = f.total - f.done < BATCH ? f.total - f.done : BATCH;
        o.samples = (uint32_t)f.batch;
        result = trace(p, scene, &o, sums);
    }
    if (result == ALP_OK) {
        average(sums, count, (float)f.total);
        glTextureSubImage2D(t->light, 0, 0, 0, (GLsizei)t->width, (GLsizei)t->height, GL_RGBA,
                            GL_FLOAT, sums);
    }
    free(sums);
    return result;
}
