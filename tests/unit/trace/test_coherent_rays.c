// SPDX-License-Identifier: MIT
// Packets that are traced together, two at a time where the machine has vectors of sixteen, find
// the bits that each finds alone: any number of them, with any lanes left out, on every level of
// instructions.
#include "soup.h"

#include "scene/builtin/mesh_builder.h"

/// MOST: packets of a round, past the eight that are laid out together and past two times as many.
enum { MOST = 21, ROUNDS = 9, ALL_LANES = 0xff };

/// Of instructions. NULL: the best of this machine.
static const char *const LEVELS[] = {NULL, "avx2", "avx", "sse4.2", "sse2"};

static alp_context *context_of(const char *level)
{
    alp_context *context = NULL;
    alp_context_options o = alp_context_options_default();
    o.worker_count = 1;
    o.max_isa = level;
    assert_int_equal(alp_context_create(&o, &context), ALP_OK);
    return context;
}

// --- rays ----------------------------------------------------------------------------------------

typedef enum ray_aim { AIM_ANYWHERE, AIM_CAMERA, AIM_EDGES, AIM_COUNT } ray_aim;

/// Rays from one point outside through neighbouring pixels.
static void camera_rays(alpi_rays *rays, uint32_t round, uint32_t packet)
{
    const vec3 eye = {0.3f, 2.0f, -2.5f};
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float x = 0.02f * (float)(i % 4) + 0.08f * (float)(packet % 5);
        const float y = 0.02f * (float)(i / 4) + 0.04f * (float)(packet / 5 + 5 * round);
        const vec3 to = {x - 0.2f, 1.0f - y, 0.0f};
        alpi_rays_set(rays, i, eye, vec3_normalize_or(vec3_sub(to, eye), eye), INFINITY);
    }
}

static void aim_packet(const alp_scene *scene, ray_aim aim, uint32_t round, uint32_t packet,
                       alpi_rays *rays)
{
    alpi_rays_clear(rays);
    soup_rays(rays, MOST * round + packet);
    if (aim == AIM_CAMERA) {
        camera_rays(rays, round, packet);
    } else if (aim == AIM_EDGES) {
        soup_aim_at_edges(scene, MOST * round + packet, rays);
    }
}

/// Of a packet: mostly all, else any, or none; in every third round all of all.
static uint32_t pick_lanes(uint32_t round, uint32_t packet)
{
    const uint32_t bits = alpi_hash32(77 * round + packet);
    const bool all = round % 3 == 0 || bits % 4 != 0;
    return all ? ALL_LANES : bits % 16 == 0 ? 0 : bits >> 8 & ALL_LANES;
}

// --- together and alone --------------------------------------------------------------------------

/// What is counted: lanes that met something; and those that met an edge of two triangles, and
/// together another of the two than alone.
typedef struct hit_tally {
    uint32_t met, either;
    uint32_t blocked; // lanes of shadow packets
} hit_tally;

/// What lanes that are left out, and packets past the last, must keep.
static void mark(alpi_hits *hits, uint32_t count)
{
    memset(hits, 0x55, count * sizeof *hits);
}

/// Bits, of lanes that are left out too.
static bool are_same(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

static bool have_an_edge_in_common(const alp_scene *scene, uint32_t a, uint32_t b)
{
    int common = 0;
    for (int i = 0; i < 9; i++) { // corners of a sphere's seam are there twice
        const float *p = scene->positions[scene->triangles[a][i / 3]];
        const float *q = scene->positions[scene->triangles[b][i % 3]];
        common += p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    }
    return a != b && common == 2;
}

/// Takes it that a lane met an edge exactly, at one distance from both triangles: which of the two
/// it is told hangs on the order in which they are met, and that on the rays beside it.
static void allow_edges(const alp_scene *scene, const alpi_hits *alone, alpi_hits *together,
                        hit_tally *tally)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t bit = 1u << i, a = alone->triangle[i], b = together->triangle[i];
        if (a < scene->triangle_count && b < scene->triangle_count &&
            have_an_edge_in_common(scene, a, b)) {
            together->triangle[i] = a;
            together->b1[i] = alone->b1[i];
            together->b2[i] = alone->b2[i];
            together->behind = (together->behind & ~bit) | (alone->behind & bit);
            tally->either++;
        }
    }
}

/// Shadow rays by runs of each length: blocked together as alone.
static void hold_shadows(const alpi_tracer *tracer, alpi_trace_filter filter, ray_aim aim,
                         const alpi_rays rays[MOST], uint32_t *blocked)
{
    alpi_rays alone[MOST], together[MOST];
    memcpy(alone, rays, sizeof alone);
    for (uint32_t p = 0; p < MOST; p++) {
        alpi_trace_occluded(tracer, &alone[p], 1, ALL_LANES, filter, ALPI_RAYS_NEAR);
        for (int i = 0; i < ALPI_PACKET; i++) {
            *blocked += alone[p].maximum[i] < 0.0f;
        }
    }
    for (uint32_t count = 1; count <= MOST; count++) {
        memcpy(together, rays, sizeof together);
        alpi_trace_occluded(tracer, together, count, ALL_LANES, filter, ALPI_RAYS_PAIRED);
        for (uint32_t p = 0; p < MOST; p++) {
            const alpi_rays *expected = p < count ? &alone[p] : &rays[p];
            if (!are_same(&together[p], expected, sizeof *expected)) {
                fail_msg("aim %d: packet %u of %u shadow packets has other bits", (int)aim, p,
                         count);
            }
        }
    }
}

/// The same packets by runs of each length.
static void hold_round(const alp_scene *scene, const alpi_tracer *tracer, alpi_trace_filter filter,
                       ray_aim aim, uint32_t round, hit_tally *tally)
{
    alpi_rays rays[MOST];
    const alpi_rays *packets[MOST];
    uint32_t active[MOST];
    alpi_hits alone[MOST], together[MOST], kept;
    mark(alone, MOST);
    mark(&kept, 1);
    for (uint32_t p = 0; p < MOST; p++) {
        aim_packet(scene, aim, round, p, &rays[p]);
        packets[p] = &rays[p];
        active[p] = pick_lanes(round, p);
        alpi_trace_nearest_coherent_many(tracer, &packets[p], &active[p], 1, filter, &alone[p]);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            tally->met += (active[p] >> i & 1u) != 0 && alone[p].triangle[i] != ALPI_NONE;
        }
    }
    hold_shadows(tracer, filter, aim, rays, &tally->blocked);
    for (uint32_t count = 0; count <= MOST; count++) {
        const uint32_t first = alpi_hash32(round + count) % (MOST - count + 1);
        mark(together, MOST);
        alpi_trace_nearest_coherent_many(tracer, packets + first, active + first, count, filter,
                                         together + first);
        for (uint32_t p = 0; p < MOST; p++) {
            const bool traced = p >= first && p < first + count;
            if (traced && aim == AIM_EDGES) {
                allow_edges(scene, &alone[p], &together[p], tally);
            }
            if (!are_same(&together[p], traced ? &alone[p] : &kept, sizeof kept)) {
                fail_msg("aim %d, round %u: packet %u of %u from %u on, lanes %#x, has other bits",
                         (int)aim, round, p, count, first, active[p]);
            }
        }
    }
}

static void hold_tracer(const alp_scene *scene, const alpi_tracer *tracer, const char *level)
{
    hit_tally all = {0, 0, 0};
    for (int kind = 0; kind < 3; kind++) {
        const alpi_trace_filter filter = {.one_sided = kind == 1, .panes = kind == 2};
        for (int aim = 0; aim < AIM_COUNT; aim++) {
            hit_tally tally = {0, 0, 0};
            for (uint32_t round = 0; round < ROUNDS; round++) {
                hold_round(scene, tracer, filter, (ray_aim)aim, round, &tally);
            }
            assert_true(tally.met > ROUNDS * MOST / 4 && tally.blocked > ROUNDS * MOST / 4);
            all.met += tally.met;
            all.either += tally.either;
        }
    }
    print_message("%u triangles, %s: %u rays met something, %u times an edge's other triangle\n",
                  alpi_tracer_triangle_count(tracer), level != NULL ? level : "best", all.met,
                  all.either);
}

/// @param surfaces as alpi_tracer_create
static void hold_every_level(alp_scene *(*make)(alp_context *context), const bool *surfaces)
{
    for (size_t i = 0; i < sizeof LEVELS / sizeof *LEVELS; i++) {
        alp_context *context = context_of(LEVELS[i]);
        alp_scene *scene = make(context);
        alpi_tracer *tracer = NULL;
        ASSERT_OK(context, alpi_tracer_create(scene, surfaces, NULL, NULL, &tracer));
        assert_true(LEVELS[i] == NULL || !alpi_tracer_takes_pairs(tracer));
        hold_tracer(scene, tracer, LEVELS[i]);
        alpi_tracer_destroy(tracer);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

// --- scenes --------------------------------------------------------------------------------------

static alp_scene *make_many(alp_context *context)
{
    return soup_make(context, 3000, 0.4f);
}

TEST(many_triangles)
{
#if defined(__x86_64__)
    print_message("this machine %s vectors of sixteen\n",
                  __builtin_cpu_supports("avx512f") ? "has" : "lacks");
#endif
    hold_every_level(make_many, NULL);
}

static alp_scene *make_few(alp_context *context)
{
    return soup_make(context, 30, 2.5f);
}

TEST(few_triangles)
{
    hold_every_level(make_few, NULL);
}

/// Of 1,520 triangles, whose edges are those of two.
static alp_scene *make_sphere(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1, 40, 20, 1.0, 1);
    return test_mesh_scene(context, mesh, 0);
}

TEST(edges_of_two_triangles)
{
    hold_every_level(make_sphere, NULL);
}

enum { MIXED_SURFACES = 4 };

/// Solid triangles, panes, what is cut away wholly, and solid ones again.
static alp_scene *make_mixed(alp_context *context)
{
    const vec3 black = {0, 0, 0}, up = {0, 1, 0};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "mixed");
    for (uint32_t s = 0; s < MIXED_SURFACES; s++) {
        alpi_builder_surface(&b, "soup", alpi_builder_material(&b, "soup", black, black));
        for (uint32_t t = 0; t < 300; t++) {
            uint32_t v[3];
            const float size = 0.1f + 0.3f * alpi_unit_float(alpi_hash32(4 * t + s));
            for (uint32_t c = 0; c < 3; c++) {
                float at[3];
                for (uint32_t k = 0; k < 3; k++) {
                    const uint32_t key = 1000 * (300 * s + t) + k;
                    at[k] = 2.0f * alpi_unit_float(alpi_hash32(key)) - 1.0f +
                            size * alpi_unit_float(alpi_hash32(key + 10 * c + 10));
                }
                v[c] = alpi_builder_vertex(&b, vec3_load(at), up);
            }
            alpi_builder_triangle(&b, v[0], v[1], v[2]);
        }
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[1].alpha_mode = ALPI_ALPHA_BLEND;
    scene->materials[1].base_color[3] = 0.75f;
    scene->materials[2].alpha_mode = ALPI_ALPHA_MASK;
    scene->materials[2].base_color[3] = 0.25f;
    scene->materials[3].double_sided = true;
    return scene;
}

TEST(surfaces_of_all_kinds)
{
    static const bool last[MIXED_SURFACES] = {false, false, false, true};
    hold_every_level(make_mixed, NULL);
    hold_every_level(make_mixed, last); // all solid, but not from the scene's first triangle on
}
