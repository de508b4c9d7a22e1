// SPDX-License-Identifier: MIT
// Rays against few triangles, each of which is met: against brute force, at edges, in batches.
#include "soup.h"

#include "base/memory.h"
#include "trace/few.h"

enum { PACKETS = 2000, BATCH = 24, ENDING = 5 }; // of a batch, those first whose reach ends

static const uint32_t ALL[ALPI_PACKET] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX,
                                          UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
static const uint32_t SOME[ALPI_PACKET] = {UINT32_MAX, UINT32_MAX, 0,          UINT32_MAX,
                                           UINT32_MAX, 0,          UINT32_MAX, UINT32_MAX};

typedef struct rig {
    alp_context *context;
    alp_scene *scene;
    alpi_few *few;
} rig;

static void open_rig(alp_scene *scene, rig *r)
{
    uint32_t triangles[ALPI_FEW_LIMIT];
    uint32_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            triangles[count++] = t;
        }
    }
    *r = (rig){.context = scene->context, .scene = scene};
    ASSERT_OK(r->context, alpi_few_create(scene, triangles, count, &r->few));
    assert_non_null(r->few);
}

static void close_rig(rig *r)
{
    alpi_release(r->context, r->few);
    alp_scene_destroy(r->scene);
    alp_context_destroy(r->context);
}

enum { LOOPS = 3 };

/// Loops that this machine can run.
static int list_loops(const rig *r, const alpi_few_loops *loops[LOOPS])
{
    const alpi_few_loops *middle = &ALPI_COMPILED_FOR(r->context, alpi_few_loops);
    int count = 0;
    loops[count++] = &alpi_few_loops_baseline;
    if (middle != loops[0]) {
        loops[count++] = middle;
    }
    if (r->few->loops != loops[count - 1]) {
        loops[count++] = r->few->loops;
    }
    return count;
}

/// What one packet meets.
static void meet(const alpi_few_loops *loops, const alpi_few *few, const alpi_rays *rays,
                 uint32_t active, bool one_sided, alpi_hits *hits)
{
    loops->nearest(few, &rays, &active, 1, one_sided, hits);
}

static int agree_with_brute_force(const rig *r, const alpi_few_loops *loops, bool one_sided)
{
    const alpi_trace_filter filter = {.one_sided = one_sided};
    int hits = 0;
    for (uint32_t packet = 0; packet < PACKETS; packet++) {
        alpi_rays rays;
        alpi_hits fast, slow;
        soup_rays(&rays, packet);
        for (int i = 0; i < ALPI_PACKET && packet % 5 == 0; i++) {
            rays.minimum[i] = 0.4f;
        }
        const uint32_t active = packet % 4 == 0 ? 0x5bu : 0xffu; // lanes left out too
        uint32_t lanes[ALPI_PACKET];
        for (int i = 0; i < ALPI_PACKET; i++) {
            lanes[i] = (active >> i & 1u) != 0 ? UINT32_MAX : 0;
            rays.origin_x[i] = lanes[i] != 0 ? rays.origin_x[i] : NAN; // must not matter
            if (packet % 3 == 0) { // some polygons alone are within reach
                rays.maximum[i] = 0.2f + 0.05f * (float)(i + (int)(packet % 8));
                rays.origin_y[i] = 0.3f * rays.origin_y[i] + 0.002f * (float)(packet % 301) - 0.3f;
            }
        }
        memset(&fast, 0x55, sizeof fast);
        memset(&slow, 0x55, sizeof slow);
        meet(loops, r->few, &rays, active, one_sided, &fast);
        alpi_brute_force_nearest(r->scene, &rays, active, filter, &slow);
        alpi_rays shadow = rays;
        loops->occluded(r->few, &shadow, 1, lanes, one_sided);
        assert_int_equal(fast.behind & ~active, slow.behind & ~active);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            assert_int_equal(fast.triangle[i], slow.triangle[i]);
            if ((active >> i & 1u) == 0) {
                assert_true(shadow.maximum[i] == rays.maximum[i]);
                continue;
            }
            const bool hit = slow.triangle[i] != ALPI_NONE;
            hits += hit;
            assert_int_equal(shadow.maximum[i] < 0.0f, hit);
            assert_true(hit || shadow.maximum[i] == rays.maximum[i]);
            if (hit) {
                ASSERT_NEAR(fast.distance[i], slow.distance[i], 2e-5);
                ASSERT_NEAR(fast.b1[i], slow.b1[i], 2e-3);
                ASSERT_NEAR(fast.b2[i], slow.b2[i], 2e-3);
                assert_true(fast.b1[i] >= 0.0f && fast.b2[i] >= 0.0f);
                assert_true(fast.b1[i] + fast.b2[i] <= 1.0f + 0x1p-22f);
                assert_int_equal(fast.behind >> i & 1u, slow.behind >> i & 1u);
            } else {
                assert_true(isinf(fast.distance[i]));
            }
        }
    }
    return hits;
}

static void agree_by_all_loops(rig *r)
{
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(r, loops);
    for (int k = 0; k < count; k++) {
        const int both = agree_with_brute_force(r, loops[k], false);
        const int front = agree_with_brute_force(r, loops[k], true);
        print_message("%d hits, %d with single-sided surfaces open from behind\n", both, front);
        assert_true(both > PACKETS / 5 && front > PACKETS / 10 && front < both);
    }
    close_rig(r);
}

TEST(few_triangles_are_hit_as_by_brute_force)
{
    rig r;
    open_rig(soup_make(test_context(1), ALPI_FEW_LIMIT, 1.6f), &r);
    assert_int_equal(r.few->polygon_count, r.few->count); // none has a side in common
    agree_by_all_loops(&r);
}

/// Six faces of two triangles each, whose diagonals run any way.
static void add_turned_box(test_mesh *mesh, const double middle[3], double half, double angle)
{
    static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    uint32_t v[8];
    for (int c = 0; c < 8; c++) {
        const double x = half * (c / 4 * 2 - 1), y = half * (c / 2 % 2 * 2 - 1);
        v[c] = test_mesh_vertex(mesh, middle[0] + x * cos(angle) - y * sin(angle),
                                middle[1] + x * sin(angle) + y * cos(angle),
                                middle[2] + half * (c % 2 * 2 - 1));
    }
    for (int f = 0; f < 6; f++) {
        const int *c = faces[f], k = f % 2;
        test_mesh_triangle(mesh, v[c[0]], v[c[1]], v[c[2 + k]]);
        test_mesh_triangle(mesh, v[c[2]], v[c[3]], v[c[k]]);
    }
}

static alp_scene *make_boxes(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i < 5; i++) {
        const double middle[3] = {0.7 * (i % 3) - 0.7, 0.8 * (i / 3) - 0.4, 0.25 * i - 0.5};
        add_turned_box(mesh, middle, 0.15 + 0.05 * i, 0.3 * i);
    }
    return test_mesh_scene(context, mesh, 0);
}

/// Two triangles of a face are met as one, and which of them it was is told.
TEST(faces_are_hit_as_by_brute_force)
{
    rig r;
    open_rig(make_boxes(test_context(1)), &r);
    assert_int_equal(r.few->count, 60);
    assert_int_equal(r.few->polygon_count, 30);
    assert_int_equal(r.few->edge_count, 60);
    assert_int_equal(r.few->corner_count, 40);
    agree_by_all_loops(&r);
}

/// Two triangles are one only where they lie in a plane, as far as rays from either can tell, turn
/// the same way, and make no corner that turns in.
TEST(only_flat_and_convex_pairs_are_joined)
{
    const struct {
        double first[3], fourth[3]; // corners, beside (0, 0, 0) and (1, 0, 0), above them and below
        bool turned;                // the second triangle
        uint32_t polygons;
    } cases[] = {
        {{0, 1, 0}, {1, -1, 0}, false, 1},
        {{0, 1, 0}, {1, -1, 0}, true, 2},
        {{0, 1, 0}, {1, -1, 1e-3}, false, 2},
        {{0, 1, 0}, {1, -1, 1e-9}, false, 1},
        {{0, 1, 0}, {1, -1, 1e-7}, false, 2}, // two steps of a float
        {{0, 1, 0}, {0.5, -0.1, 0}, false, 1},
        {{0, 1, 0}, {2, -1, 0}, false, 2},   // straight on
        {{0, 1, 0}, {2.1, -1, 0}, false, 2}, // turned in
        {{0, 1, 0}, {-0.1, -1, 0}, false, 2},
        // The large one's plane would be above the small one, farther than rays are lifted.
        {{0.5, 0.1, 2e-6}, {0.5, -100, 0}, false, 2},
        {{0.5, 100, 0}, {0.5, -0.1, 2e-6}, false, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        rig r;
        test_mesh *mesh = test_mesh_start();
        const double *a = cases[i].first, *d = cases[i].fourth;
        test_mesh_vertex(mesh, 0, 0, 0);
        test_mesh_vertex(mesh, 1, 0, 0);
        test_mesh_vertex(mesh, a[0], a[1], a[2]);
        test_mesh_vertex(mesh, d[0], d[1], d[2]);
        test_mesh_triangle(mesh, 0, 1, 2);
        test_mesh_triangle(mesh, 0, cases[i].turned ? 1 : 3, cases[i].turned ? 3 : 1);
        open_rig(test_mesh_scene(test_context(1), mesh, 0), &r);
        assert_int_equal(r.few->polygon_count, cases[i].polygons);
        close_rig(&r);
    }
}

/// A closed sphere of 60 triangles: rays from inside are stopped, at edges too.
TEST(no_ray_slips_between_two)
{
    rig r;
    alp_context *context = test_context(1);
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1, 6, 6, 1.0, 1);
    open_rig(test_mesh_scene(context, mesh, 0), &r);
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(&r, loops);
    for (uint32_t packet = 0; packet < 20000; packet++) {
        alpi_rays rays;
        soup_rays(&rays, packet);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays.origin_x[i] *= 0.4f;
            rays.origin_y[i] *= 0.4f;
            rays.origin_z[i] *= 0.4f;
            rays.maximum[i] = INFINITY;
        }
        soup_aim_at_edges(r.scene, packet, &rays);
        for (int k = 0; k < count; k++) {
            alpi_rays shadow = rays;
            alpi_hits hits = {.behind = 0};
            loops[k]->occluded(r.few, &shadow, 1, ALL, false);
            meet(loops[k], r.few, &rays, 0xffu, false, &hits);
            for (int i = 0; i < ALPI_PACKET; i++) {
                assert_true(shadow.maximum[i] < 0.0f);
                assert_true(hits.triangle[i] != ALPI_NONE && hits.distance[i] < 2.0f);
            }
        }
    }
    close_rig(&r);
}

/// Rays that graze a face and end at its edges: the point that is told lies within.
TEST(grazing_rays_end_within)
{
    rig r;
    test_mesh *mesh = test_mesh_start();
    add_turned_box(mesh, (double[]){3.0, 2.0, 1.0}, 5.0, 0.7);
    open_rig(test_mesh_scene(test_context(1), mesh, 0), &r);
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(&r, loops);
    uint32_t hits_seen = 0;
    for (uint32_t packet = 0; packet < 4000; packet++) {
        alpi_rays rays;
        soup_rays(&rays, packet);
        const float off = powf(0.1f, (float)(2 + packet % 4)); // above the face x' = 5
        const float x = 3.0f + (5.0f + off) * cosf(0.7f), y = 2.0f + (5.0f + off) * sinf(0.7f);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays.origin_x[i] = x - 4.0f * rays.origin_y[i] * sinf(0.7f);
            rays.origin_y[i] = y + 4.0f * rays.origin_y[i] * cosf(0.7f);
            rays.origin_z[i] = 1.0f + 4.0f * rays.origin_z[i];
            rays.maximum[i] = INFINITY;
        }
        soup_aim_at_edges(r.scene, packet, &rays);
        for (int k = 0; k < count; k++) {
            alpi_hits hits = {.behind = 0};
            meet(loops[k], r.few, &rays, 0xffu, false, &hits);
            for (int i = 0; i < ALPI_PACKET; i++) {
                const float rest = 1.0f - hits.b1[i] - hits.b2[i];
                assert_true(hits.b1[i] >= 0.0f && hits.b2[i] >= 0.0f && rest >= -0x1p-22f);
                hits_seen += hits.triangle[i] != ALPI_NONE;
            }
        }
    }
    assert_true(hits_seen > 4000);
    close_rig(&r);
}

/// From the middle of a solid exactly through its corners, and the middles of edges and faces.
static void meet_every_corner(alp_scene *scene)
{
    rig r;
    open_rig(scene, &r);
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(&r, loops);
    for (int way = 0; way < 27; way++) {
        if (way == 13) {
            continue; // none
        }
        alpi_rays rays;
        memset(&rays, 0, sizeof rays);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays.direction_x[i] = (float)(way % 3 - 1); // not unit, but without rounding
            rays.direction_y[i] = (float)(way / 3 % 3 - 1);
            rays.direction_z[i] = (float)(way / 9 - 1);
            rays.maximum[i] = INFINITY;
        }
        for (int k = 0; k < count; k++) {
            alpi_rays shadow = rays;
            alpi_hits hits = {.behind = 0};
            loops[k]->occluded(r.few, &shadow, 1, ALL, false);
            meet(loops[k], r.few, &rays, 0xffu, false, &hits);
            for (int i = 0; i < ALPI_PACKET; i++) {
                assert_true(shadow.maximum[i] < 0.0f);
                assert_true(hits.triangle[i] != ALPI_NONE && hits.distance[i] <= 1.0f);
            }
        }
    }
    close_rig(&r);
}

TEST(corners_stop_rays)
{
    test_mesh *cube = test_mesh_start();
    add_turned_box(cube, (double[]){0, 0, 0}, 1.0, 0.0);
    meet_every_corner(test_mesh_scene(test_context(1), cube, 0));
    test_mesh *octahedron = test_mesh_start();
    for (int k = 0; k < 6; k++) {
        const double at = k % 2 == 0 ? 1.0 : -1.0;
        test_mesh_vertex(octahedron, k / 2 == 0 ? at : 0, k / 2 == 1 ? at : 0, k / 2 == 2 ? at : 0);
    }
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t x = k % 2, y = 2 + k / 2 % 2, z = 4 + k / 4;
        const bool turned = (k % 2 + k / 2 % 2 + k / 4) % 2 != 0;
        test_mesh_triangle(octahedron, x, turned ? z : y, turned ? y : z);
    }
    meet_every_corner(test_mesh_scene(test_context(1), octahedron, 0));
}

/// Rays within the plane of a triangle pass it, whatever their reach.
TEST(planes_are_passed_within)
{
    rig r;
    alp_context *context = test_context(1);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){1, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    open_rig(test_mesh_scene(context, mesh, 0), &r);
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(&r, loops);
    alpi_rays rays;
    memset(&rays, 0, sizeof rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays.maximum[i] = i < 4 ? INFINITY : 5.0f;
        rays.origin_z[i] = 0.25f;
    }
    for (int i = 0; i < ALPI_PACKET; i += 4) {
        rays.direction_x[i] = 1.0f; // towards it
        rays.direction_x[i + 1] = -1.0f;
        rays.direction_z[i + 2] = 1.0f;
        rays.direction_x[i + 3] = 0.8f; // from above
        rays.direction_y[i + 3] = -0.6f;
        rays.origin_y[i + 3] = 0.9f;
    }
    for (int k = 0; k < count; k++) {
        alpi_rays shadow = rays;
        alpi_hits hits = {.behind = 0};
        loops[k]->occluded(r.few, &shadow, 1, ALL, false);
        meet(loops[k], r.few, &rays, 0xffu, false, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            assert_int_equal(shadow.maximum[i] < 0.0f, i % 4 == 3);
            assert_int_equal(hits.triangle[i] != ALPI_NONE, i % 4 == 3);
        }
    }
    close_rig(&r);
}

/// The nearest hits of a batch. @return rays that met something
static int meet_nearest(const rig *r, const alpi_rays rays[BATCH], bool one_sided)
{
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(r, loops);
    const alpi_rays *packets[BATCH];
    uint32_t active[BATCH];
    alpi_hits alone[BATCH], together[BATCH];
    int met = 0;
    memset(alone, 0x55, sizeof alone);
    for (uint32_t p = 0; p < BATCH; p++) {
        packets[p] = &rays[p];
        active[p] = p % 4 == 2 ? 0xdbu : 0xffu;
        meet(&alpi_few_loops_baseline, r->few, packets[p], active[p], one_sided, &alone[p]);
        for (int i = 0; i < ALPI_PACKET; i++) {
            met += (active[p] >> i & 1u) != 0 && alone[p].triangle[i] != ALPI_NONE;
        }
    }
    for (int k = 0; k < count; k++) {
        memset(together, 0x55, sizeof together);
        loops[k]->nearest(r->few, packets, active, BATCH, one_sided, together);
        assert_memory_equal(together, alone, sizeof alone);
    }
    return met;
}

/// Shadow rays of a batch, and of its first packets alone, whose reaches end.
/// @param alone [BATCH] out: what they are packet by packet
static void stop_batch(const rig *r, const alpi_rays rays[BATCH], bool one_sided,
                       alpi_rays alone[BATCH])
{
    const alpi_few_loops *loops[LOOPS];
    const int count = list_loops(r, loops);
    memcpy(alone, rays, BATCH * sizeof *rays);
    for (uint32_t p = 0; p < BATCH; p++) {
        alpi_few_loops_baseline.occluded(r->few, &alone[p], 1, SOME, one_sided);
    }
    for (int k = 0; k < count; k++) {
        for (uint32_t packets = ENDING; packets <= BATCH; packets += BATCH - ENDING) {
            alpi_rays together[BATCH];
            memcpy(together, rays, sizeof together);
            loops[k]->occluded(r->few, together, packets, SOME, one_sided);
            assert_memory_equal(together, alone, packets * sizeof *alone);
        }
    }
}

/// Batches of packets, some of which share their origins, with reaches of their own: what a packet
/// gets does not depend on what is beside it, nor on the instructions.
static void meet_batches(alp_scene *scene)
{
    rig r;
    open_rig(scene, &r);
    const alpi_few_loops *loops[LOOPS];
    print_message("by %d loops\n", list_loops(&r, loops));
    int stopped = 0, left = 0, met = 0;
    for (uint32_t batch = 0; batch < 100; batch++) {
        alpi_rays rays[BATCH], alone[BATCH];
        for (uint32_t p = 0; p < BATCH; p++) {
            soup_rays(&rays[p], batch * BATCH + p);
            for (int i = 0; i < ALPI_PACKET; i++) {
                const float far = 0.1f + 0.1f * (float)(p % 7);
                rays[p].maximum[i] = p % 11 == 10 || p / ENDING % 2 == 1 ? INFINITY : far;
            }
            // Five packets from the same eight points; of the first five, three and two.
            const uint32_t first = p < ENDING ? p / 3 * 3 : p / ENDING * ENDING;
            memcpy(rays[p].origin_x, rays[first].origin_x, sizeof rays[p].origin_x);
            memcpy(rays[p].origin_y, rays[first].origin_y, sizeof rays[p].origin_y);
            memcpy(rays[p].origin_z, rays[first].origin_z, sizeof rays[p].origin_z);
        }
        met += meet_nearest(&r, rays, batch % 2 == 1);
        stop_batch(&r, rays, batch % 2 == 1, alone);
        for (uint32_t p = 0; p < BATCH; p++) {
            for (int i = 0; i < ALPI_PACKET; i++) {
                stopped += alone[p].maximum[i] < 0.0f;
                left += alone[p].maximum[i] >= 0.0f;
            }
        }
    }
    print_message("%d rays stopped, %d not; %d met something\n", stopped, left, met);
    assert_true(stopped > 200 && left > 200 && met > 200);
    close_rig(&r);
}

static void add_box(test_mesh *mesh, const double low[3], double size)
{
    for (int k = 0; k < 3; k++) {
        double u[3] = {0.0}, v[3] = {0.0}, far[3] = {low[0], low[1], low[2]};
        u[(k + 1) % 3] = v[(k + 2) % 3] = size;
        far[k] += size;
        test_mesh_quad(mesh, low, v, u);
        test_mesh_quad(mesh, far, u, v);
    }
}

TEST(batches_are_what_packets_are)
{
    meet_batches(soup_make(test_context(1), ALPI_FEW_LIMIT, 1.6f));
    meet_batches(make_boxes(test_context(1)));
}

/// A room of 12 triangles; boxes of 12 each in it.
static alp_scene *make_room(alp_context *context, int boxes)
{
    test_mesh *mesh = test_mesh_start();
    add_box(mesh, (double[]){0, 0, 0}, 10.0);
    for (int i = 0; i < boxes; i++) {
        add_box(mesh, (double[]){1.0 + 2.0 * i, 0.0, 4.0}, 1.0);
    }
    return test_mesh_scene(context, mesh, 0);
}

TEST(few_is_what_is_within_reach)
{
    const struct {
        int boxes;
        float reach;
        bool few;
    } cases[] = {{0, INFINITY, true},  // 12 triangles
                 {1, INFINITY, false}, // 24
                 {4, INFINITY, false}, {4, 0.5f, true},
                 {4, 20.0f, false},    {5, 0.5f, false}}; // 72: too many to be looked through
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make_room(context, cases[i].boxes);
        alpi_tracer *tracer = NULL;
        ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
        assert_int_equal(alpi_tracer_meets_few(tracer, cases[i].reach), cases[i].few);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Too many triangles, none, or too narrow ones are left to the hierarchy.
TEST(others_are_refused)
{
    const struct {
        double height; // of a triangle 1 m long, 10 m from the origin
        uint32_t count;
        bool few;
    } cases[] = {{1.0, 0, false},    {1.0, 1, true},      {1.0, 64, true},  {1.0, 65, false},
                 {1.1e-3, 64, true}, {0.9e-3, 64, false}, {1e-30, 1, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        test_mesh *mesh = test_mesh_start();
        uint32_t triangles[ALPI_FEW_LIMIT + 1];
        for (uint32_t t = 0; t < ALPI_FEW_LIMIT + 1; t++) {
            const double z = 0.1 * t, v = cases[i].height;
            triangles[t] = 2 * t; // one of a quad, with both its edges
            test_mesh_quad(mesh, (double[]){9, 0, z}, (double[]){1, 0, 0}, (double[]){0, v, 0});
        }
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alpi_few *few = NULL;
        ASSERT_OK(context, alpi_few_create(scene, triangles, cases[i].count, &few));
        assert_int_equal(few != NULL, cases[i].few);
        alpi_release(context, few);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
