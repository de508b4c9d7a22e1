// SPDX-License-Identifier: MIT
// Which samples go together: all of them once, in the quarter they belong to, those of a packet in
// about one direction, and those of a point spread over all directions.
#include "test_scenes.h"

#include "transport/occlusion/occlusion_run.h"

/// A setup of some scene: only its sequence and its places matter.
static void set_up(uint32_t samples, alp_context **context, alp_scene **scene,
                   alpi_occlusion_setup *setup)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    *context = test_context(1);
    *scene = test_mesh_scene(*context, mesh, 1);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(*context, alpi_tracer_for_scene(*scene, NULL, NULL, &tracer, NULL));
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    ASSERT_OK(*context, alpi_occlusion_prepare(*scene, tracer, &options, setup));
}

static void tear_down(alp_context *context, alp_scene *scene, alpi_occlusion_setup *setup)
{
    alpi_occlusion_release(setup);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

/// Which sample of a setup a packet's lane holds.
static uint32_t find_sample(const alpi_occlusion_setup *setup, const alpi_sample_packet *packet,
                            uint32_t lane)
{
    uint32_t s = 0;
    while (s < setup->samples &&
           (setup->sequence[s][0] != packet->u[lane] || setup->sequence[s][1] != packet->v[lane])) {
        s++;
    }
    assert_true(s < setup->samples);
    assert_int_equal(packet->w[lane], setup->sequence[s][2]);
    return s;
}

/// A run, sample by sample: its point, and how often it is there.
typedef struct found_run {
    uint32_t times[4096], point[4096];
} found_run;

static void read_chunk(const alpi_occlusion_setup *setup, const alpi_sample_run *run,
                       const alpi_sample_chunk *chunk, uint32_t parted, uint32_t total,
                       found_run *found)
{
    const uint32_t all = (1u << ALPI_PACKET) - 1u;
    for (uint32_t k = 0; k < chunk->packet_count; k++) {
        const uint32_t active = k + 1 < chunk->packet_count ? all : chunk->last;
        assert_true(active != 0 && active <= all);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const uint32_t s = find_sample(setup, &run->packets[chunk->first_packet + k], i);
            if ((active >> i & 1u) == 0) {
                continue;
            }
            const uint32_t quarter = s < parted ? s / (parted / ALPI_QUARTERS)
                                                : (s - parted) / ((total - parted) / ALPI_QUARTERS);
            const uint32_t place = chunk->place[k / chunk->block][i];
            assert_int_equal(chunk->quarter[i], quarter);
            assert_true(place < chunk->place_count && k / chunk->block < chunk->groups);
            found->times[s]++;
            found->point[s] = chunk->first_place + place;
        }
    }
}

TEST(every_sample_is_there_once)
{
    static const struct {
        uint32_t first, count, parted, total;
    } runs[] = {
        {0, 4, 0, 4},        {0, 8, 0, 8},           {0, 100, 0, 100},      {0, 256, 0, 256},
        {64, 192, 64, 256},  {64, 100, 64, 256},     {3, 1, 0, 4},          {0, 1024, 0, 1024},
        {0, 3000, 0, 4096},  {256, 3840, 256, 4096}, {100, 924, 100, 4096}, {0, 1028, 0, 1028},
        {17, 1000, 0, 4096}, {0, 4096, 0, 4096},     {60, 8, 64, 256},      {250, 12, 256, 512},
    };
    alp_context *context;
    alp_scene *scene;
    alpi_occlusion_setup setup;
    set_up(4096, &context, &scene, &setup);
    for (size_t k = 0; k < 2 * sizeof runs / sizeof *runs; k++) {
        const uint32_t first = runs[k / 2].first, count = runs[k / 2].count;
        const bool extended = k % 2 != 0;
        found_run found = {{0}, {0}};
        alpi_sample_run run;
        const alpi_sample_range range = {first, count, runs[k / 2].parted, runs[k / 2].total};
        ASSERT_OK(context, alpi_sample_run_create(&setup, extended, &range, &run));
        for (uint32_t c = 0; c < run.chunk_count; c++) {
            read_chunk(&setup, &run, &run.chunks[c], runs[k / 2].parted, runs[k / 2].total, &found);
        }
        uint32_t of_point[4096 / ALPI_SAMPLES_PER_POINT + 2 + ALPI_PACKET] = {0};
        for (uint32_t s = 0; s < 4096; s++) {
            assert_int_equal(found.times[s], s >= first && s < first + count ? 1 : 0);
            assert_true(extended || found.point[s] == 0);
            of_point[found.point[s]] += found.times[s];
        }
        for (uint32_t p = 0; p < sizeof of_point / sizeof *of_point && extended; p++) {
            // twice as many where a chunk that ends within a quarter's block begins another
            assert_true(of_point[p] <= (run.chunk_count > 1 ? 2u : 1u) * ALPI_SAMPLES_PER_POINT);
        }
        alpi_sample_run_destroy(&run);
    }
    tear_down(context, scene, &setup);
}

/// Bits of the two coordinates that number the cells of 2^bits samples along the curve.
static uint32_t cell_of(const alpi_sample_packet *packet, uint32_t lane, uint32_t bits)
{
    const uint32_t of_u = (bits + 1) / 2, of_v = bits / 2;
    return packet->u[lane] >> (32 - of_u) << of_v | packet->v[lane] >> (32 - of_v);
}

TEST(packets_go_into_one_cell)
{
    for (uint32_t bits = 3; bits <= 7; bits++) {
        const uint32_t samples = (uint32_t)ALPI_PACKET << bits;
        for (int extended = 0; extended < 2; extended++) {
            alp_context *context;
            alp_scene *scene;
            alpi_occlusion_setup setup;
            alpi_sample_run run;
            bool seen[128] = {false};
            set_up(samples, &context, &scene, &setup);
            const alpi_sample_range all = {.count = samples, .total = samples};
            ASSERT_OK(context, alpi_sample_run_create(&setup, extended != 0, &all, &run));
            assert_int_equal(run.chunk_count, 1);
            assert_int_equal(run.chunks[0].packet_count, samples / ALPI_PACKET);
            for (uint32_t k = 0; k < run.chunks[0].packet_count; k++) {
                const uint32_t cell = cell_of(&run.packets[k], 0, bits);
                for (uint32_t i = 1; i < ALPI_PACKET; i++) {
                    assert_int_equal(cell_of(&run.packets[k], i, bits), cell);
                }
                assert_false(seen[cell]);
                seen[cell] = true;
            }
            alpi_sample_run_destroy(&run);
            tear_down(context, scene, &setup);
        }
    }
}

/// A point sends the samples that follow each other in the sequence, eight of which are in all
/// directions: any other choice errs more where a texel has many triangles (by a quarter of the
/// error, teapot-room at 64² and 256 samples).
TEST(points_keep_their_samples)
{
    alp_context *context;
    alp_scene *scene;
    alpi_occlusion_setup setup;
    alpi_sample_run run;
    found_run found = {{0}, {0}};
    set_up(1024, &context, &scene, &setup);
    for (uint32_t first = 0; first < 1024; first += 256) {
        const alpi_sample_range range = {first, 256, 0, 1024};
        ASSERT_OK(context, alpi_sample_run_create(&setup, true, &range, &run));
        for (uint32_t c = 0; c < run.chunk_count; c++) {
            read_chunk(&setup, &run, &run.chunks[c], 0, 1024, &found);
        }
        alpi_sample_run_destroy(&run);
    }
    for (uint32_t s = 0; s < 1024; s++) {
        assert_int_equal(found.point[s], s / ALPI_SAMPLES_PER_POINT);
    }
    tear_down(context, scene, &setup);
}
