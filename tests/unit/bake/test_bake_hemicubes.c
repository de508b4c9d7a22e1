// SPDX-License-Identifier: MIT
// Whole bakes by hemicubes fine enough that their rays are traced together: the same bits for any
// workers, on every level of instructions.
#include "scene/scene.h"
#include "test_scenes.h"

#include <math.h>

enum { SIZE = 12, WAYS = 4 };

static const uint32_t WORKERS[WAYS] = {1, 2, 7, 32};
/// Of instructions. NULL: the best of this machine, which comes first.
static const char *const LEVELS[] = {NULL, "avx2", "avx", "sse4.2", "sse2"};
enum { LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS };

typedef struct bake_kind {
    const char *name, *scene; // NULL: a ball on the ground
    uint32_t hemicube; // from 32 on together; 34: packets that are not full, an odd number of them
    alp_sky_kind sky;
    alp_emitters emitters;
    bool layers;
    bool glows; // the ball and the ground do
} bake_kind;

static const bake_kind KINDS[] = {
    // The room's triangles are so few that packets meet each of them.
    {"a room", "builtin:cornell", 32, ALP_SKY_NONE, ALP_EMITTERS_ANALYTIC, false, false},
    {"a room, counted", "builtin:cornell", 32, ALP_SKY_NONE, ALP_EMITTERS_COUNTED, false, false},
    {"layers of a room", "builtin:cornell", 34, ALP_SKY_CONSTANT, ALP_EMITTERS_ANALYTIC, true,
     false},
    {"counted", NULL, 32, ALP_SKY_NONE, ALP_EMITTERS_COUNTED, false, true},
    {"under a sky", NULL, 34, ALP_SKY_CLEAR, ALP_EMITTERS_ANALYTIC, false, false},
    {"layers", NULL, 34, ALP_SKY_CONSTANT, ALP_EMITTERS_ANALYTIC, true, true},
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

typedef struct made {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
} made;

/// Of 1,010 triangles, whose rays may leave.
static alp_scene *make_ball(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0.6, 0}, 0.5, 28, 19, 1.0, 1);
    test_mesh_quad(mesh, (double[]){-1, 0, -1}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    return test_mesh_scene(context, mesh, 0);
}

static void make(const bake_kind *kind, const char *level, uint32_t workers, made *m)
{
    alp_context_options c = alp_context_options_default();
    c.worker_count = workers;
    c.max_isa = level;
    assert_int_equal(alp_context_create(&c, &m->context), ALP_OK);
    if (kind->scene == NULL) {
        m->scene = make_ball(m->context);
        for (int k = 0; k < 3; k++) {
            m->scene->materials[0].emission[k] = kind->glows ? 1.0f : 0.0f;
        }
    } else {
        ASSERT_OK(m->context, alp_scene_load(m->context, kind->scene, &m->scene));
    }
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = SIZE;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.maps = ALP_MAP_LIGHT | (kind->layers ? 0u : ALP_MAP_SH | ALP_MAP_DIRECTION);
    o.light.gather = ALP_GATHER_HEMICUBE;
    o.light.hemicube = kind->hemicube;
    o.light.emitters = kind->emitters;
    o.light.layers = kind->layers;
    o.light.bounces = 2;
    o.light.lighting.sky.kind = kind->sky;
    o.light.lighting.sun.illuminance = kind->sky == ALP_SKY_CLEAR ? 1000.0f : 0.0f;
    ASSERT_OK(m->context, alp_bake(m->scene, &o, &m->lightmap, NULL));
}

static void unmake(made *m)
{
    alp_lightmap_destroy(m->lightmap);
    alp_scene_destroy(m->scene);
    alp_context_destroy(m->context);
}

enum { PAGE_LIMIT = 16, FLOATS = 4 * SIZE * SIZE };

/// @return how many there are, of which some are NULL
static uint32_t pages_of(const alp_lightmap *l, const float *pages[PAGE_LIMIT])
{
    uint32_t count = 0;
    pages[count++] = alp_lightmap_map_page(l, ALP_MAP_LIGHT, 0, NULL, NULL);
    pages[count++] = alp_lightmap_map_page(l, ALP_MAP_DIRECTION, 0, NULL, NULL);
    for (uint32_t i = 0; i < 4; i++) {
        pages[count++] = alp_lightmap_sh_page(l, i, 0, NULL, NULL);
    }
    for (uint32_t i = 0; i < alp_lightmap_layer_count(l); i++) {
        assert_true(count < PAGE_LIMIT);
        pages[count++] = alp_lightmap_layer_page(l, i, 0, NULL, NULL);
    }
    return count;
}

static bool are_same_bits(float a, float b)
{
    uint32_t bits_a, bits_b;
    memcpy(&bits_a, &a, sizeof a);
    memcpy(&bits_b, &b, sizeof b);
    return bits_a == bits_b;
}

/// What two bakes differ in.
typedef struct difference {
    uint32_t pages, floats; // that there are
    uint32_t differ;        // of the floats
    double light, apart;    // sums of values, and of how far they are apart
} difference;

static difference compare(const made *a, const made *b)
{
    const float *of_a[PAGE_LIMIT], *of_b[PAGE_LIMIT];
    const uint32_t count = pages_of(a->lightmap, of_a);
    difference d = {0};
    assert_int_equal(pages_of(b->lightmap, of_b), count);
    for (uint32_t i = 0; i < count; i++) {
        assert_true((of_a[i] == NULL) == (of_b[i] == NULL));
        for (uint32_t k = 0; k < FLOATS && of_a[i] != NULL; k++) {
            const double value = (double)of_a[i][k];
            d.differ += !are_same_bits(of_a[i][k], of_b[i][k]);
            d.light += fabs(value);
            d.apart += fabs(value - (double)of_b[i][k]);
            d.floats++;
        }
        d.pages += of_a[i] != NULL;
    }
    return d;
}

/// Whether the map of light is more than black.
static bool is_lit(const made *m)
{
    const float *page = alp_lightmap_map_page(m->lightmap, ALP_MAP_LIGHT, 0, NULL, NULL);
    uint32_t lit = 0;
    assert_non_null(page);
    for (uint32_t k = 0; k < SIZE * SIZE; k++) {
        lit += page[4 * k] > 0.0f;
    }
    return lit > SIZE * SIZE / 4;
}

static const char *name_of(const char *level)
{
    return level != NULL ? level : "best";
}

/// @param best made by the best level, or NULL: this is it
static void hold_level(const bake_kind *kind, const char *level, const made *best, made *first)
{
    make(kind, level, 1, first);
    assert_true(is_lit(first));
    for (int w = 1; w < WAYS; w++) {
        made other;
        if (best != NULL && WORKERS[w] != 7) {
            continue; // it is the same code but for a few loops
        }
        make(kind, level, WORKERS[w], &other);
        const difference d = compare(first, &other);
        assert_true(d.pages >= 2);
        if (d.differ != 0) {
            fail_msg("%s, %s: %u workers change %u floats", kind->name, name_of(level), WORKERS[w],
                     d.differ);
        }
        unmake(&other);
    }
    if (best != NULL) {
        // Bits are promised on one level only: a ray that meets an edge may be told either of its
        // triangles. Such rays are few.
        const difference d = compare(best, first);
        print_message("%s, %s: of %u floats %u are other bits than by the best level\n", kind->name,
                      name_of(level), d.floats, d.differ);
        ASSERT_NEAR(d.apart / d.light, 0.0, 1e-3);
    }
}

TEST(workers_change_no_bit)
{
    for (int k = 0; k<KIND_COUNT; k += TEST_STEP> 1 ? KIND_COUNT - 1 : 1) {
        made best;
        hold_level(&KINDS[k], NULL, NULL, &best);
        for (int l = 1; l < LEVEL_COUNT; l++) {
            made other;
            hold_level(&KINDS[k], LEVELS[l], &best, &other);
            unmake(&other);
        }
        unmake(&best);
    }
}
