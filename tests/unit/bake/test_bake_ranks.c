// SPDX-License-Identifier: MIT
// Bakes of several ranks, without MPI: the same bits as one process, for any number of ranks and
// workers. A rank that fails, stops or is gone ends all of them with a message.
#include "base/memory.h"
#include "base/tiles/rank_calls.h"
#include "fields/probes/probes.h"
#include "transport/gather/kept_rays.h"

#include "test_ranks.h"
#include "test_scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIZE = 32, PAGES = 24 };

typedef struct bake_kind {
    const char *name, *scene; // scene NULL: the mesh of the test, from both sides
    unsigned maps;
    float error;
    bool layers, probes;
    uint32_t size;
    uint32_t samples;
    const char *folder;
    alp_progress_fn *progress;
    double time_limit;
    bool shard;
    uint64_t budget; // of the context, bytes beside the scene; 0: none
    void (*alter)(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp); // of probes; or NULL
} bake_kind;

static const bake_kind OCCLUSION = {
    .name = "occlusion", .scene = "builtin:cornell", .maps = ALP_MAP_AO | ALP_MAP_BENT};
static const bake_kind IN_ROUNDS = {
    .name = "occlusion in rounds", .scene = "builtin:cornell", .maps = ALP_MAP_AO, .error = 0.02f};
static const bake_kind LIGHT = {.name = "light in rounds",
                                .scene = "builtin:cornell",
                                .maps = ALP_MAP_LIGHT | ALP_MAP_SH,
                                .error = 0.05f};
static const bake_kind LAYERS = {.name = "layers",
                                 .scene = "builtin:cornell",
                                 .maps = ALP_MAP_LIGHT | ALP_MAP_DIRECTION,
                                 .layers = true,
                                 .error = 0.05f};
static const bake_kind PANES = {
    .name = "panes", .scene = "builtin:windows", .maps = ALP_MAP_AO | ALP_MAP_LIGHT};
static const bake_kind TWO_SIDED = {.name = "two sides", .maps = ALP_MAP_AO | ALP_MAP_LIGHT};
static const bake_kind PROBES = {.name = "probes", .scene = "builtin:cornell", .probes = true};

// --- a bake --------------------------------------------------------------------------------------

static test_mesh *mesh;

/// A half open sphere over a quad.
static void make_mesh(void)
{
    mesh = test_mesh_start();
    test_mesh_sphere(mesh, (const double[]){0.0, 1.0, 0.0}, 0.8, 8, 5, 0.4, 1);
    test_mesh_quad(mesh, (const double[]){-2, 0, -2}, (const double[]){0, 0, 4},
                   (const double[]){4, 0, 0});
}

static alp_result load(alp_context *context, const char *name, alp_scene **scene)
{
    if (name != NULL) {
        return alp_scene_load(context, name, scene);
    }
    const alp_mesh m = {.name = "test",
                        .vertex_count = mesh->vertex_count,
                        .positions = mesh->positions[0],
                        .triangle_count = mesh->triangle_count,
                        .indices = mesh->triangles[0],
                        .base_color = {0.5f, 0.5f, 0.5f},
                        .double_sided = true};
    return alp_scene_create_from_meshes(context, &m, 1, scene);
}

static void keep(test_rank *r, const void *bytes, size_t size)
{
    r->bytes = realloc(r->bytes, r->size + size);
    memcpy((char *)r->bytes + r->size, bytes, size);
    r->size += size;
}

/// Keeps the bytes of all maps.
static void keep_maps(test_rank *r, const alp_lightmap *l)
{
    uint32_t w, h;
    for (uint32_t i = 0; i < PAGES; i++) {
        const bool sh = i >= 16 && i < 20;
        const float *page = i < 16 ? alp_lightmap_map_page(l, (alp_map)(1u << i), 0, &w, &h)
                            : sh   ? alp_lightmap_sh_page(l, i - 16, 0, &w, &h)
                            : i - 20 < alp_lightmap_layer_count(l)
                                ? alp_lightmap_layer_page(l, i - 20, 0, &w, &h)
                                : NULL;
        if (page != NULL) {
            keep(r, page, sizeof *page * 4 * w * h);
        }
    }
}

static void bake_probes(test_rank *r, alp_scene *scene, alp_lamp *lamp)
{
    const bake_kind *kind = r->what;
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    o.lighting.lamps = lamp;
    o.lighting.lamp_count = 1;
    o.spacing = 0.14f;
    o.atlas_size = 32;
    o.rays = 384;
    o.layers = o.direct = true;
    if (kind->alter != NULL) {
        kind->alter(scene, &o, lamp);
    }
    r->result = alp_probes_bake(scene, &o, &probes);
    if (r->result == ALP_OK) {
        const alpi_probe_volume *v = &probes->volume;
        keep(r, v->coefficients, v->count * v->coefficient_count * 3 * sizeof *v->coefficients);
        keep(r, v->moments, v->count * 64 * sizeof *v->moments);
        keep(r, &v->interpolation, sizeof v->interpolation);
    }
    alp_probes_destroy(probes);
}

static void bake_maps(test_rank *r, const alp_scene *scene, const alp_lamp *lamp)
{
    const bake_kind *kind = r->what;
    alp_bake_options o = alp_bake_options_default();
    alp_lightmap *lightmap = NULL;
    o.atlas.size = kind->size > 0 ? kind->size : SIZE;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = kind->maps;
    o.occlusion.samples = kind->samples > 0 ? kind->samples : kind->error > 0.0f ? 256 : 16;
    o.sampling.error = kind->error;
    o.sampling.time_limit = kind->time_limit;
    o.light.samples = 16;
    o.light.error = kind->error;
    o.light.bounces = 2;
    o.light.layers = kind->layers;
    o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
    o.light.lighting.lamps = lamp;
    o.light.lighting.lamp_count = 1;
    o.maps_folder = kind->folder;
    o.progress = kind->progress;
    o.progress_user = r;
    if (kind->shard) {
        o.checkpoint.folder = "none";
        o.checkpoint.shard = 1;
        o.checkpoint.shards = 2;
        o.sampling.accuracy = ALP_ADAPTIVE_OFF;
    }
    r->result = alp_bake(scene, &o, &lightmap, NULL);
    if (r->result == ALP_OK) {
        keep_maps(r, lightmap);
    }
    alp_lightmap_destroy(lightmap);
}

static void bake(test_rank *r)
{
    const bake_kind *kind = r->what;
    alp_lamp lamp = alp_lamp_default();
    alp_scene *scene = NULL;
    lamp.intensity = 0.2f;
    lamp.position[1] = 0.2f;
    r->result = load(r->context, kind->scene, &scene);
    if (r->result == ALP_OK && kind->probes) {
        bake_probes(r, scene, &lamp);
    } else if (r->result == ALP_OK) {
        if (kind->budget > 0) {
            const uint64_t held = alpi_memory_held(r->context);
            alpi_set_budget(r->context, (alpi_budget){.limit = held + kind->budget});
        }
        bake_maps(r, scene, &lamp);
    }
    alp_scene_destroy(scene);
}

// --- the same bits -------------------------------------------------------------------------------

static void run(const bake_kind *kind, uint32_t count, uint32_t workers, test_rank *ranks)
{
    test_ranks_run(&(test_ranks_options){.count = count, .workers = workers, .what = {kind}}, bake,
                   ranks);
}

static void release(test_rank *ranks, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        free(ranks[i].bytes);
    }
}

/// Every rank ends with the maps of a bake alone.
static void check_same(const test_rank *alone, test_rank *ranks, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_string_equal(ranks[i].result == ALP_OK ? "" : ranks[i].message, "");
        assert_int_equal(ranks[i].size, alone->size);
        assert_memory_equal(ranks[i].bytes, alone->bytes, alone->size);
    }
    release(ranks, count);
}

static void check_any_ranks(const bake_kind *kind)
{
    test_rank alone, ranks[TEST_RANKS_MOST];
    run(kind, 1, 1, &alone);
    assert_string_equal(alone.result == ALP_OK ? "" : alone.message, "");
    assert_true(alone.size > 0);
    for (uint32_t count = test_is_quick() ? 3 : 1; count <= (test_is_quick() ? 3 : 4); count++) {
        for (uint32_t workers = 1; workers <= 2; workers++) {
            run(kind, count, workers, ranks);
            check_same(&alone, ranks, count);
        }
    }
    release(&alone, 1);
}

TEST(ranks_change_no_bit_of_occlusion)
{
    check_any_ranks(&OCCLUSION);
    check_any_ranks(&IN_ROUNDS);
}

TEST(ranks_change_no_bit_of_light)
{
    check_any_ranks(&LIGHT);
}

TEST(ranks_change_no_bit_of_layers)
{
    check_any_ranks(&LAYERS);
}

TEST(ranks_change_no_bit_of_probes)
{
    check_any_ranks(&PROBES);
}

TEST(ranks_change_no_bit_behind_panes)
{
    check_any_ranks(&PANES);
}

TEST(ranks_change_no_bit_of_two_sided_surfaces)
{
    make_mesh();
    check_any_ranks(&TWO_SIDED);
}

TEST(more_ranks_than_tiles)
{
    test_rank alone, ranks[TEST_RANKS_MOST];
    bake_kind kind = OCCLUSION;
    kind.size = 8;
    run(&kind, 1, 1, &alone);
    run(&kind, TEST_RANKS_MOST, 1, ranks);
    check_same(&alone, ranks, TEST_RANKS_MOST);
    release(&alone, 1);
}

TEST(a_slow_rank_changes_no_bit)
{
    test_rank alone, ranks[3];
    run(&LIGHT, 1, 1, &alone);
    for (uint32_t slow = 1; slow <= 3; slow += 2) {
        test_ranks_run(
            &(test_ranks_options){.count = 3, .workers = 1, .slow = slow, .what = {&LIGHT}}, bake,
            ranks);
        check_same(&alone, ranks, 3);
    }
    release(&alone, 1);
}

/// Machines of 512 KB to 64 MB beside others: rays are kept on all or on none.
TEST(a_rank_with_less_memory_changes_no_bit)
{
    test_rank alone, ranks[3];
    uint32_t baked = 0, refused = 0;
    run(&LIGHT, 1, 1, &alone);
    for (uint64_t budget = 1 << 19; budget < 1 << 26; budget = budget * 5 / 4) {
        bake_kind poor = LIGHT;
        poor.budget = budget;
        test_ranks_run(
            &(test_ranks_options){.count = 3, .workers = 1, .what = {&LIGHT, &poor, &LIGHT}}, bake,
            ranks);
        if (ranks[1].result == ALP_OK) {
            check_same(&alone, ranks, 3);
            baked++;
            continue;
        }
        for (int i = 0; i < 3; i++) {
            assert_int_equal(ranks[i].result, ALP_ERROR_LIMIT);
        }
        // A forecast beyond the shared limit is refused by every rank itself.
        assert_true(refused > 0 || strncmp(ranks[0].message, "bake: stage", 11) == 0);
        release(ranks, 3);
        refused++;
    }
    assert_true(baked > 4);
    assert_true(refused > 0);
    release(&alone, 1);
}

enum { BUDGET = 1 << 20 };

/// Holds bytes of its own, as buffers of threads do. @param r->what bytes of kept rays
static void find_room(test_rank *r)
{
    const uint64_t *bytes = r->what;
    bool began, fit = false;
    alpi_set_budget(r->context, (alpi_budget){.limit = BUDGET});
    void *held = alpi_allocate(r->context, 1000 * (r->rank + 1), 1);
    r->result = alpi_ranks_begin(r->context, "", &began);
    if (r->result == ALP_OK) {
        r->result = alpi_kept_rays_fit(r->context, *bytes, UINT64_MAX, &fit);
    }
    r->result = alpi_ranks_end(r->context, r->result);
    alpi_release(r->context, held);
    keep(r, &fit, sizeof fit);
}

TEST(ranks_keep_rays_together)
{
    const uint64_t held = 3000, least = BUDGET - held - held / 4; // room of the last rank
    for (uint64_t bytes = least; bytes <= least + 1; bytes++) {
        test_rank ranks[3];
        test_ranks_run(&(test_ranks_options){.count = 3, .workers = 1, .what = {&bytes}}, find_room,
                       ranks);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(ranks[i].result, ALP_OK);
            assert_int_equal(*(const bool *)ranks[i].bytes, bytes == least);
        }
        release(ranks, 3);
    }
}

// --- faults --------------------------------------------------------------------------------------

/// All ranks fail. The lowest rank other than `cause` has a message with this text.
static void check_all_fail(test_rank *ranks, uint32_t count, uint32_t cause, const char *text)
{
    const test_rank *other = &ranks[cause == 0 ? 1 : 0];
    for (uint32_t i = 0; i < count; i++) {
        assert_true(ranks[i].result != ALP_OK);
        assert_true(ranks[i].message[0] != '\0');
    }
    if (strstr(other->message, text) == NULL) {
        fail_msg("\"%s\" is not in \"%s\"", text, other->message);
    }
    release(ranks, count);
}

/// Fails after any number of allocations, mostly outside of loops: no rank hangs.
TEST(a_rank_without_memory_ends_all)
{
    test_rank ranks[3];
    uint32_t failures = 0;
    for (int left = 400; left < 3000 * TEST_STEP; left = left * 3 / 2) {
        const test_ranks_options o = {.count = 3,
                                      .workers = 1,
                                      .starved = (uint32_t)(left % 3) + 1,
                                      .allocations = left,
                                      .what = {&OCCLUSION}};
        test_ranks_run(&o, bake, ranks);
        if (ranks[left % 3].result == ALP_OK) {
            release(ranks, 3);
            continue;
        }
        if (strstr(ranks[left % 3].message, "memory") != NULL) {
            char text[32];
            snprintf(text, sizeof text, "rank %d stopped: ", left % 3);
            check_all_fail(ranks, 3, (uint32_t)(left % 3), text);
            failures++;
        }
    }
    assert_true(failures > 1);
}

TEST(a_rank_that_is_gone_ends_all)
{
    test_rank ranks[3];
    for (uint32_t calls = 0; calls < 4; calls++) {
        const test_ranks_options o = {
            .count = 3, .workers = 1, .leaves = 2, .calls = calls, .what = {&IN_ROUNDS}};
        test_ranks_run(&o, bake, ranks);
        check_all_fail(ranks, 3, 1, "another rank is gone");
    }
}

/// Rank 1 says no to its progress.
static bool cancel(void *user, const alp_progress *progress)
{
    const test_rank *r = user;
    return r->rank != 1 || strcmp(progress->stage, "occlusion") != 0;
}

TEST(a_rank_that_is_cancelled_ends_all)
{
    test_rank ranks[3];
    bake_kind kind = OCCLUSION;
    kind.progress = cancel;
    kind.samples = 256;
    run(&kind, 3, 1, ranks);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ranks[i].result, ALP_ERROR_CANCELLED);
    }
    check_all_fail(ranks, 3, 1, "rank 1 stopped");
}

TEST(ranks_with_other_options_refuse)
{
    test_rank ranks[3];
    bake_kind kind = OCCLUSION, scene = OCCLUSION;
    kind.samples = 32;
    scene.scene = "builtin:cornell";
    test_ranks_run(
        &(test_ranks_options){.count = 3, .workers = 1, .what = {&OCCLUSION, &kind, &scene}}, bake,
        ranks);
    check_all_fail(ranks, 3, 1, "rank 0 has \"--ao-samples 16\", rank 1 has not");
    scene.scene = "builtin:sphere-plane";
    test_ranks_run(
        &(test_ranks_options){.count = 3, .workers = 1, .what = {&OCCLUSION, &OCCLUSION, &scene}},
        bake, ranks);
    check_all_fail(ranks, 3, 2, "the ranks run different bakes");
}

static void alter_cone(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp)
{
    (void)scene, (void)o;
    lamp->outer_cone = 0.5f;
}

static void alter_sides(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp)
{
    (void)scene, (void)lamp;
    o->one_sided = true;
}

static void alter_page(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp)
{
    (void)scene, (void)lamp;
    o->atlas_size = 48;
}

static void alter_metals(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp)
{
    (void)o, (void)lamp;
    scene->metals_black = true;
}

static void alter_pose(alp_scene *scene, alp_probe_options *o, alp_lamp *lamp)
{
    (void)o, (void)lamp;
    scene->positions[0][0] += 0.01f;
}

TEST(ranks_with_other_probes_refuse)
{
    static const struct {
        void (*alter)(alp_scene *, alp_probe_options *, alp_lamp *);
        const char *text;
    } cases[] = {{alter_cone, "\"light "},
                 {alter_sides, "\"one-sided 0\""},
                 {alter_page, "\"size 32\""},
                 {alter_metals, "\"metals 0\""},
                 {alter_pose, "\"pose "}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_rank ranks[2];
        bake_kind other = PROBES;
        other.alter = cases[i].alter;
        test_ranks_run(&(test_ranks_options){.count = 2, .workers = 1, .what = {&PROBES, &other}},
                       bake, ranks);
        check_all_fail(ranks, 2, 1, cases[i].text);
    }
}

TEST(ranks_refuse_time_limits_and_shards)
{
    test_rank ranks[2];
    bake_kind kind = OCCLUSION;
    kind.time_limit = 10.0;
    run(&kind, 2, 1, ranks);
    check_all_fail(ranks, 2, 0, "--time-limit");
    kind.time_limit = 0.0;
    kind.shard = true;
    run(&kind, 2, 1, ranks);
    check_all_fail(ranks, 2, 0, "--shard");
}

/// Rank 0 writes. If it cannot, all fail.
TEST(rank_0_alone_writes)
{
    test_rank ranks[2];
    const char *folder = test_path(test_folder(), "maps"), *file = test_path(folder, "ao.exr");
    bake_kind first = OCCLUSION, second = OCCLUSION;
    first.folder = folder;
    second.folder = "/nowhere/at/all"; // would fail if rank 1 wrote there
    test_ranks_run(&(test_ranks_options){.count = 2, .workers = 1, .what = {&first, &second}}, bake,
                   ranks);
    assert_int_equal(ranks[0].result, ALP_OK);
    assert_int_equal(ranks[1].result, ALP_OK);
    release(ranks, 2);
    assert_int_equal(access(file, R_OK), 0);
    test_ranks_run(&(test_ranks_options){.count = 2, .workers = 1, .what = {&first, &second}}, bake,
                   ranks);
    check_all_fail(ranks, 2, 0, "exists already");
}
