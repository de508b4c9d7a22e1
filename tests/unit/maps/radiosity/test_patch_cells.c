// SPDX-License-Identifier: MIT
// Packets read the same cells as single points do, on every instruction set.
#include "patch_setting.h"

#include "maps/radiosity/patch_lookup.h"

#include <stdlib.h>

enum { ROUNDS = 1500, LEFT_ALONE = 77, ALL_LANES = 0xff };

// --- settings ------------------------------------------------------------------------------------

typedef struct cells_case {
    const char *name;
    int slices, stacks;
    uint32_t size, each; // each: see open_on
    double texels_per_metre;
    float max_angle;
    int double_sided;
} cells_case;

static const cells_case CASES[] = {
    {"large charts", 24, 12, 64, 1, 0.0, 0.3f, 0},
    {"several pages", 24, 12, 64, 1, 14.0, 0.3f, 1},
    {"charts of a facet, few texels with light", 96, 48, 160, 3, 0.0, 0.01f, 1},
    {"no texel with light", 24, 12, 64, 0, 0.0, 0.3f, 1},
};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

/// A ball over the ground, and triangles of no size, which have no chart.
static void open_case(const cells_case *c, setting *s)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){0, 0, 0}, 1.0, c->slices, c->stacks, 1.0, 1);
    test_mesh_quad(mesh, (double[]){-2, -2, -2}, (double[]){0, 0, 4}, (double[]){4, 0, 0});
    for (uint32_t v = 0; v < 3; v++) {
        test_mesh_triangle(mesh, v, v, v);
    }
    alp_atlas_options a = alp_atlas_options_default();
    a.size = c->size;
    a.texels_per_metre = c->texels_per_metre;
    a.max_angle = c->max_angle;
    open_on(s, test_mesh_scene(test_context(1), mesh, c->double_sided), &a, 4, c->each);
    if (c->each == 0) {
        alpi_patches_destroy(&s->patches);
        ASSERT_OK(s->context, alpi_patches_create(&s->lattice, s->atlas, s->lattice.order, 0, NULL,
                                                  &s->patches));
    }
}

// --- packets -------------------------------------------------------------------------------------

static uint32_t draw(uint32_t round, uint32_t packet, uint32_t what)
{
    return alpi_random_key(round, packet, what);
}

/// Fills a lane without a hit with values that no look-up may read.
static void put_nothing(alpi_hits *hits, int lane)
{
    hits->triangle[lane] = ALPI_NONE;
    hits->b1[lane] = hits->b2[lane] = NAN;
}

/// A packet of one triangle, of one except for a lane, or of any. All lanes hit, some or none, some
/// from behind, at corners, at edges and beside the triangle, also off its page.
/// @return lanes that hit
static uint32_t draw_packet(const setting *s, uint32_t round, uint32_t packet, alpi_hits *hits)
{
    const uint32_t kind = draw(round, packet, 0), count = s->scene->triangle_count;
    const uint32_t one = draw(round, packet, 1) % count, lanes = draw(round, packet, 2);
    const uint32_t met = kind % 4 != 0 ? ALL_LANES : kind % 32 == 0 ? 0 : lanes & ALL_LANES;
    const bool together = kind / 32 % 4 != 0, all_but_one = kind / 128 % 8 == 0;
    const bool beside = kind / 1024 % 4 == 0, front = kind / 4096 % 2 == 0;
    hits->behind = front ? 0 : lanes >> 8 & ALL_LANES;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const uint32_t bits = draw(round, packet, 3 + (uint32_t)i);
        const bool other = !together || (all_but_one && i == (int)(lanes >> 16) % ALPI_PACKET);
        if ((met >> i & 1u) == 0) {
            put_nothing(hits, i);
            continue;
        }
        hits->triangle[i] = other ? bits % count : one;
        pick_point(hits->triangle[i], bits % 64, &hits->b1[i], &hits->b2[i]);
        if (beside) {
            const float far = bits % 3 == 0 ? 1e-5f : bits % 3 == 1 ? 1.0f : 100.0f;
            hits->b1[i] += far * (alpi_unit_float(alpi_hash32(bits)) - 0.5f);
            hits->b2[i] += far * (alpi_unit_float(alpi_hash32(bits + 1)) - 0.5f);
        }
    }
    return met;
}

/// Packets of one call, and their cells.
typedef struct batch {
    uint32_t count;
    alpi_hits hits[ALPI_LIGHT_BATCH];
    uint32_t met[ALPI_LIGHT_BATCH];
    uint32_t cells[ALPI_LIGHT_BATCH][ALPI_PACKET];
} batch;

static void draw_batch(const setting *s, uint32_t round, batch *b)
{
    b->count = round % (ALPI_LIGHT_BATCH + 1);
    for (uint32_t k = 0; k < b->count; k++) {
        b->met[k] = draw_packet(s, round, k, &b->hits[k]);
    }
}

static void forget_backs(const setting *s)
{
    if (s->patches.two_sided) {
        memset(s->patches.seen_backs, ALPI_BACK_UNSEEN, s->patches.patch_count);
    }
}

static void find(const setting *s, alpi_light_cells_fn *find_cells, batch *b)
{
    for (int i = 0; i < ALPI_LIGHT_BATCH * ALPI_PACKET; i++) {
        b->cells[i / ALPI_PACKET][i % ALPI_PACKET] = LEFT_ALONE;
    }
    forget_backs(s);
    find_cells(&s->patches, b->hits, b->met, b->count, b->cells);
}

// --- tests ---------------------------------------------------------------------------------------

/// The cell of a single point. Marks backs too.
static uint32_t cell_alone(const alpi_patches *p, const alpi_hits *hits, int lane)
{
    const uint32_t texel =
        alpi_patches_find(p, hits->triangle[lane], hits->b1[lane], hits->b2[lane]);
    return alpi_patches_side_cell(p, texel, (hits->behind >> lane & 1u) != 0);
}

/// Counts of each kind of cell.
typedef struct cell_counts {
    uint32_t black, front, back;
} cell_counts;

static void hold_batch(const setting *s, uint32_t round, cell_counts *counts)
{
    static uint8_t seen[1u << 16];
    static batch b;
    const alpi_patches *p = &s->patches;
    const uint32_t patches = p->two_sided ? p->patch_count : 0;
    draw_batch(s, round, &b);
    find(s, alpi_patches_find_cells_baseline, &b);
    assert_true(patches <= sizeof seen);
    if (patches > 0) {
        memcpy(seen, p->seen_backs, patches);
    }
    forget_backs(s);
    for (int n = 0; n < ALPI_LIGHT_BATCH * ALPI_PACKET; n++) {
        const int k = n / ALPI_PACKET, i = n % ALPI_PACKET;
        const bool met = k < (int)b.count && (b.met[k] >> i & 1u) != 0;
        const uint32_t wanted = met ? cell_alone(p, &b.hits[k], i) : LEFT_ALONE;
        if (b.cells[k][i] != wanted) {
            fail_msg("round %u, packet %d, lane %d: cell %u, alone %u", round, k, i, b.cells[k][i],
                     wanted);
        }
        counts->black += met && wanted == ALPI_CELL_BLACK;
        counts->front +=
            met && wanted >= ALPI_CELL_FIRST && wanted < ALPI_CELL_FIRST + s->texels.count;
        counts->back += met && wanted >= ALPI_CELL_FIRST + s->texels.count;
    }
    assert_true(patches == 0 || memcmp(seen, p->seen_backs, patches) == 0);
}

TEST(packets_find_what_points_find)
{
    for (int c = 0; c < CASE_COUNT; c++) {
        setting s;
        cell_counts counts = {0};
        open_case(&CASES[c], &s);
        for (uint32_t round = 0; round < ROUNDS; round++) {
            hold_batch(&s, round, &counts);
        }
        print_message("%s: %u fronts, %u backs, %u black\n", CASES[c].name, counts.front,
                      counts.back, counts.black);
        assert_true(counts.black > 0);
        assert_true(CASES[c].each == 0 || counts.front > ROUNDS);
        assert_true((CASES[c].each != 0 && CASES[c].double_sided) == (counts.back > ROUNDS / 10));
        close_setting(&s);
    }
}

TEST(any_instructions_find_the_same)
{
    static batch any, best;
    for (int c = 0; c < CASE_COUNT; c++) {
        setting s;
        open_case(&CASES[c], &s);
        const alpi_patches *p = &s.patches;
        alpi_light_cells_fn *find_cells = alpi_patches_light(p).find;
        const uint32_t patches = p->two_sided ? p->patch_count : 0;
        uint8_t *seen = calloc(patches + 1, 1);
        assert_non_null(seen);
        for (uint32_t r = 0; r < ROUNDS && find_cells != alpi_patches_find_cells_baseline; r++) {
            draw_batch(&s, r, &any);
            best = any;
            find(&s, alpi_patches_find_cells_baseline, &any);
            if (patches > 0) {
                memcpy(seen, p->seen_backs, patches);
            }
            find(&s, find_cells, &best);
            assert_memory_equal(best.cells, any.cells, sizeof any.cells);
            assert_true(patches == 0 || memcmp(p->seen_backs, seen, patches) == 0);
        }
        free(seen);
        close_setting(&s);
        if (find_cells == alpi_patches_find_cells_baseline) {
            print_message("this machine has no x86-64-v3, of which there are other loops\n");
            skip();
        }
    }
}
