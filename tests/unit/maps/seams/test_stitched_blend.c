// SPDX-License-Identifier: MIT
// Seams of overlapping charts: samples are blended look-ups, and stitching finds the minimum.
#include "maps/seams/seam_edges.h"
#include "maps/seams/stitch.h"

#include "base/random.h"
#include "scene/builtin/mesh_builder.h"
#include "test_support.h"

#include <math.h>
#include <stdlib.h>

typedef struct fixture {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
    alpi_seams seams;
} fixture;

static void set_up(fixture *f)
{
    alpi_builder builder;
    alp_atlas_options options = alp_atlas_options_default();
    alp_atlas *atlas = NULL;
    options.mode = ALP_ATLAS_BLEND;
    options.size = 64;
    *f = (fixture){.context = test_context(1)};
    alpi_builder_start(&builder, f->context, "sphere");
    alpi_builder_surface(&builder, "sphere", ALPI_NONE);
    alpi_builder_ball(&builder,
                      &(alpi_ball){.radius = 1.0f, .top = 1.0f, .slices = 24, .stacks = 12});
    ASSERT_OK(f->context, alpi_builder_finish(&builder, &f->scene));
    ASSERT_OK(f->context, alp_atlas_create(f->scene, &options, &atlas));
    ASSERT_OK(f->context, alpi_lightmap_create(atlas, &f->lightmap));
    const uint32_t count = f->lightmap->texels.count;
    float *values = calloc(count, sizeof *values);
    assert_non_null(values);
    for (uint32_t i = 0; i < count; i++) {
        values[i] = 0.2f + 0.6f * alpi_unit_float(alpi_random_key(5, i, 0));
    }
    ASSERT_OK(f->context, alpi_lightmap_store(f->lightmap, values));
    free(values);
    // Which a bake does.
    for (uint32_t i = 0; i < count; i++) {
        f->lightmap->states[i] = ALPI_TEXEL_TRACED;
    }
    ASSERT_OK(f->context, alpi_seams_create(f->lightmap, NULL, &f->seams));
    assert_true(f->seams.sample_count > 50);
}

static void tear_down(fixture *f)
{
    alpi_seams_destroy(&f->seams);
    alp_lightmap_destroy(f->lightmap);
    alp_scene_destroy(f->scene);
    alp_context_destroy(f->context);
}

typedef struct sums {
    const alp_lightmap *lightmap;
    double differences, length;
} sums;

static alp_result add_pair(void *user, const alpi_seam_pair *pair)
{
    sums *s = user;
    const double texel = fmin((double)pair->edges[0].texel, (double)pair->edges[1].texel);
    const int count = (int)ceil(2.0 * pair->length / texel - 1e-3);
    for (int i = 0; i < count; i++) {
        float values[2];
        for (int side = 0; side < 2; side++) {
            const uint32_t k = pair->edges[side].half_edge % 3;
            const double share =
                pair->begins[side] + (i + 0.5) / count * (pair->ends[side] - pair->begins[side]);
            float b[3] = {0.0f, 0.0f, 0.0f}, rgb[3];
            b[k] = (float)(1.0 - share);
            b[(k + 1) % 3] = (float)share;
            alpi_lightmap_sample(s->lightmap, pair->edges[side].half_edge / 3, b[1], b[2], rgb);
            values[side] = rgb[0];
        }
        s->differences += fabs((double)values[0] - (double)values[1]) * pair->length / count;
    }
    return ALP_OK;
}

TEST(samples_are_blended_look_ups)
{
    fixture f;
    set_up(&f);
    alpi_seam_edges edges;
    alpi_seam_step step;
    sums s = {.lightmap = f.lightmap};
    ASSERT_OK(f.context, alpi_seam_edges_create(f.lightmap, &edges));
    ASSERT_OK(f.context, alpi_seam_pairs_visit(f.scene, &edges, add_pair, &s));
    ASSERT_OK(f.context, alpi_seams_measure(f.lightmap, &f.seams, f.lightmap->pages, &step));
    assert_true(step.mean > 1e-3);
    // Coordinates of the one are floats; samples whose sides read the same are left out there.
    ASSERT_NEAR(step.mean * f.seams.length, s.differences, 1e-4 * f.seams.length);
    alpi_seam_edges_destroy(&edges);
    tear_down(&f);
}

/// The sum is least where its gradient is nothing: Σ l d w + λ (x − x⁰) = 0 for each texel, with d
/// of the stitched map.
TEST(the_sum_is_least)
{
    fixture f;
    set_up(&f);
    const alpi_seams *s = &f.seams;
    alpi_stitch stitch;
    const alpi_stitch_options free_range = {
        .channels = 1, .low = -HUGE_VALF, .high = HUGE_VALF, .part = true};
    float **pages = f.lightmap->pages;
    double *old = calloc(s->pixel_count, sizeof *old), worst = 0.0, terms = 0.0;
    double *gradient = calloc(s->pixel_count, sizeof *gradient);
    assert_non_null(old);
    assert_non_null(gradient);
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        old[i] = (double)pages[0][4 * s->pixels[i]];
    }
    ASSERT_OK(f.context, alpi_stitch_create(f.lightmap, s, pages, NULL, NULL, &stitch));
    ASSERT_OK(f.context, alpi_stitch_apply(&stitch, &free_range, pages, NULL));
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        gradient[i] = (double)stitch.holds[i] * ((double)pages[0][4 * s->pixels[i]] - old[i]);
        terms = fmax(terms, fabs(gradient[i]));
    }
    for (uint32_t i = 0; i < s->sample_count; i++) {
        double d[3];
        alpi_seams_difference(f.lightmap, s, i, pages, d);
        assert_true(s->first[i + 1] - s->first[i] <= 24); // of three charts on both sides
        for (uint32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            gradient[s->texels[k]] += (double)s->spans[i] * (double)s->weights[k] * d[0];
        }
    }
    for (uint32_t i = 0; i < s->pixel_count; i++) {
        worst = fmax(worst, fabs(gradient[i]));
    }
    // Of the terms, about 6e-5, cancels all but what the method leaves and floats round.
    assert_true(terms > 1e-5);
    assert_true(worst < 1e-3 * terms);
    free(old);
    free(gradient);
    alpi_stitch_destroy(&stitch);
    tear_down(&f);
}
