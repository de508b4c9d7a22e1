// SPDX-License-Identifier: MIT
// Rays that are kept: what they find is what traced rays find, bit for bit, however the light
// changes and however many workers there are.
#include "test_probe.h"

#include "transport/gather/cosine_rays.h"
#include "transport/gather/kept_rays.h"

#include <string.h>

enum { RECEIVERS = 40, CELLS = 3 };

static const vec3 ONE = {1, 1, 1}, ZERO = {0, 0, 0}, UP = {0, 1, 0};

/// A room without a front wall, from inside: rays meet its surfaces, leave, and, from below its
/// floor, meet black backs.
static alp_scene *make_stage(alp_context *context)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "stage");
    const uint32_t dull = alpi_builder_material(&b, "dull", ONE, ZERO);
    alpi_builder_surface(&b, "floor", dull);
    alpi_builder_box(&b, ONE, ZERO, ALPI_FACE_BOTTOM);
    alpi_builder_surface(&b, "walls", dull);
    alpi_builder_box(&b, ONE, ZERO,
                     ALPI_FACE_ALL & ~(unsigned)(ALPI_FACE_BOTTOM | ALPI_FACE_FRONT));
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// A cell for each surface.
static void find_cells(const void *user, const alpi_hits *hits, const uint32_t *met, uint32_t count,
                       uint32_t (*cells)[ALPI_PACKET])
{
    const alp_scene *scene = user;
    for (uint32_t k = 0; k < count; k++) {
        assert_int_equal(hits[k].behind & met[k], 0);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            if ((met[k] >> i & 1u) != 0) {
                cells[k][i] = ALPI_CELL_FIRST + scene->triangle_surface[hits[k].triangle[i]];
            }
        }
    }
}

typedef struct setting {
    alp_context *context;
    test_stage stage;
    alpi_cosine_rays rays;
    alpi_hemicube *cube;
    alpi_hemicube_options cubes;
    alpi_gatherer gatherer;
    alpi_gather_scene from;
    test_patch patches[RECEIVERS];
    test_patches all;
    alpi_receivers receivers;
    float light[ALPI_CELL_FIRST + CELLS][4];
    alpi_reference_value values[RECEIVERS];
    float lost[RECEIVERS][2];
} setting;

static void open_setting(setting *s, uint32_t workers, bool hemicube)
{
    *s = (setting){.context = test_context(workers)};
    s->stage = test_stage_open(s->context, make_stage(s->context), NULL, 0, NULL);
    s->rays = (alpi_cosine_rays){.context = s->context, .samples = 320, .replicates = 4, .seed = 3};
    ASSERT_OK(s->context, alpi_hemicube_create(s->context, 10, &s->cube));
    s->cubes = (alpi_hemicube_options){
        .context = s->context, .cube = s->cube, .turned = true, .scattered = true, .seed = 3};
    s->gatherer =
        hemicube ? alpi_hemicube_gatherer(&s->cubes) : alpi_cosine_rays_gatherer(&s->rays);
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        const float at = (float)i / RECEIVERS, height = i % 2 ? 0.125f : -0.5f;
        s->patches[i] = (test_patch){{at, height, 0.25f}, {0.01f, 0, 0}, {0, 0, 0.5f}, UP};
    }
    s->all = (test_patches){.count = RECEIVERS, .patches = s->patches, .offset = 1e-6f};
    s->receivers = test_patches_receivers(&s->all);
    s->from = (alpi_gather_scene){.scene = s->stage.scene,
                                  .tracer = s->stage.tracer,
                                  .light = {.find = find_cells,
                                            .user = s->stage.scene,
                                            .cells = (const float(*)[4])s->light}};
}

static void close_setting(setting *s)
{
    alpi_hemicube_destroy(s->cube);
    test_stage_close(&s->stage);
    alp_context_destroy(s->context);
}

static void set_light(setting *s, float floor, float walls)
{
    for (int k = 0; k < 3; k++) {
        s->light[ALPI_CELL_FIRST][k] = floor * (float)(k + 1);
        s->light[ALPI_CELL_FIRST + 1][k] = walls / (float)(k + 1);
    }
}

static alpi_gather_job job_of(setting *s, const uint32_t *list, uint32_t count)
{
    memset(s->values, 0x55, sizeof s->values);
    memset(s->lost, 0x55, sizeof s->lost);
    return (alpi_gather_job){.context = s->context,
                             .from = &s->from,
                             .gatherer = &s->gatherer,
                             .receivers = &s->receivers,
                             .list = list,
                             .count = count,
                             .values = s->values,
                             .lost = s->lost};
}

static void keep_all(setting *s, alpi_kept_rays *kept)
{
    const alpi_gather_job job = job_of(s, NULL, RECEIVERS);
    assert_true(alpi_gather_meets_cells(&s->from));
    ASSERT_OK(s->context, alpi_kept_rays_reserve(s->context, &s->gatherer, RECEIVERS, kept));
    ASSERT_OK(s->context, alpi_kept_rays_trace(&job, NULL, kept));
}

TEST(kept_rays_find_what_traced_rays_find)
{
    static const uint32_t workers[] = {1, 2, 7};
    static alpi_reference_value first[2][RECEIVERS];
    static setting s;
    for (int k = 0; k < 6; k++) {
        alpi_kept_rays kept = {0};
        open_setting(&s, workers[k / 2], k % 2 == 1);
        keep_all(&s, &kept);
        for (int pass = 0; pass < 3; pass++) {
            alpi_reference_value traced[RECEIVERS];
            float lost[RECEIVERS][2];
            set_light(&s, 0.25f + (float)pass, 1.0f / (float)(1 + pass));
            alpi_gather_job job = job_of(&s, NULL, RECEIVERS);
            ASSERT_OK(s.context, alpi_gather_irradiance(&job, NULL));
            memcpy(traced, s.values, sizeof traced);
            memcpy(lost, s.lost, sizeof lost);
            job = job_of(&s, NULL, RECEIVERS);
            ASSERT_OK(s.context, alpi_kept_rays_gather(&job, &kept, NULL));
            assert_memory_equal(s.values, traced, sizeof traced);
            assert_memory_equal(s.lost, lost, sizeof lost);
        }
        if (k < 2) {
            memcpy(first[k % 2], s.values, sizeof s.values);
        }
        assert_memory_equal(s.values, first[k % 2], sizeof s.values);
        alpi_kept_rays_destroy(&kept);
        close_setting(&s);
    }
}

/// Rays of a list alone take room for no others, and find the same.
TEST(rays_of_a_list_are_kept_by_it)
{
    static setting s;
    static const uint32_t list[] = {RECEIVERS - 1, 2, 5};
    enum { LISTED = 3 };
    alpi_kept_rays kept = {0};
    alpi_reference_value traced[RECEIVERS];
    open_setting(&s, 2, false);
    ASSERT_OK(s.context, alpi_kept_rays_reserve(s.context, &s.gatherer, LISTED, &kept));
    kept.by_list = true;
    alpi_gather_job job = job_of(&s, list, LISTED);
    ASSERT_OK(s.context, alpi_kept_rays_trace(&job, NULL, &kept));
    alpi_kept_rays all = {0};
    keep_all(&s, &all);
    for (uint32_t i = 0; i < LISTED; i++) {
        assert_memory_equal(kept.cells + (size_t)i * kept.rays,
                            all.cells + (size_t)list[i] * all.rays, kept.rays * sizeof *kept.cells);
    }
    alpi_kept_rays_destroy(&all);
    set_light(&s, 0.75f, 0.5f);
    job = job_of(&s, list, LISTED);
    ASSERT_OK(s.context, alpi_gather_irradiance(&job, NULL));
    memcpy(traced, s.values, sizeof traced);
    job = job_of(&s, list, LISTED);
    ASSERT_OK(s.context, alpi_kept_rays_gather(&job, &kept, NULL));
    assert_memory_equal(s.values, traced, sizeof traced); // those of others untouched
    alpi_kept_rays_destroy(&kept);
    close_setting(&s);
}

/// What rays bring, what leaves, and what black backs swallow make the whole; from below the floor
/// nothing but backs and the open is seen.
TEST(rays_that_are_lost_are_counted)
{
    static setting s;
    open_setting(&s, 2, false);
    set_light(&s, 1.0f, 1.0f);
    const alpi_gather_job job = job_of(&s, NULL, RECEIVERS);
    ASSERT_OK(s.context, alpi_gather_irradiance(&job, NULL));
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        const double met = (double)s.values[i].mean[0] / ALPI_PI;
        ASSERT_NEAR(met + (double)s.lost[i][0] + (double)s.lost[i][1], 1.0, 1e-6);
        if (i % 2 == 0) {
            assert_true(s.values[i].mean[0] == 0.0f && s.lost[i][1] > 0.1f);
        } else {
            assert_true(met > 0.5 && s.lost[i][0] > 0.01f && s.lost[i][1] == 0.0f);
        }
    }
    close_setting(&s);
}

/// Those listed alone are traced and written; what was kept before more room was made stays.
TEST(lists_and_more_room)
{
    static setting s;
    static const uint32_t odd[3] = {1, 5, 3}, late[2] = {33, 20};
    alpi_kept_rays kept = {0};
    alpi_reference_value traced[RECEIVERS];
    open_setting(&s, 2, false);
    set_light(&s, 0.5f, 2.0f);
    alpi_gather_job job = job_of(&s, NULL, RECEIVERS);
    ASSERT_OK(s.context, alpi_gather_irradiance(&job, NULL));
    memcpy(traced, s.values, sizeof traced);
    assert_int_equal(alpi_kept_rays_size(&s.gatherer), 320 * 4);
    ASSERT_OK(s.context, alpi_kept_rays_reserve(s.context, &s.gatherer, 8, &kept));
    job = job_of(&s, odd, 3);
    ASSERT_OK(s.context, alpi_kept_rays_trace(&job, NULL, &kept));
    ASSERT_OK(s.context, alpi_kept_rays_reserve(s.context, &s.gatherer, RECEIVERS, &kept));
    assert_int_equal(kept.receivers, RECEIVERS);
    job = job_of(&s, late, 2);
    ASSERT_OK(s.context, alpi_kept_rays_trace(&job, NULL, &kept));
    const uint32_t both[5] = {20, 3, 33, 1, 5};
    job = job_of(&s, both, 5);
    ASSERT_OK(s.context, alpi_kept_rays_gather(&job, &kept, NULL));
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        bool listed = false;
        for (int k = 0; k < 5; k++) {
            listed = listed || both[k] == i;
        }
        // Bit for bit. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
        assert_true((memcmp(&s.values[i], &traced[i], sizeof traced[i]) == 0) == listed);
    }
    alpi_kept_rays_destroy(&kept);
    alpi_kept_rays_destroy(&kept);
    close_setting(&s);
}

TEST(lack_of_memory_is_told)
{
    int left;
    alp_context *failing = test_context_failing(&left);
    const alpi_cosine_rays rays = {.context = failing, .samples = 64, .replicates = 1};
    const alpi_gatherer g = alpi_cosine_rays_gatherer(&rays);
    alpi_kept_rays kept = {0};
    ASSERT_OK(failing, alpi_kept_rays_reserve(failing, &g, 2, &kept));
    left = 0;
    assert_int_equal(alpi_kept_rays_reserve(failing, &g, 4, &kept), ALP_ERROR_OUT_OF_MEMORY);
    assert_int_equal(kept.receivers, 2); // what there was is still there
    alpi_kept_rays_destroy(&kept);
    alp_context_destroy(failing);
}
