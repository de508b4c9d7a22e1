// SPDX-License-Identifier: MIT
// The hash grid finds exactly the texels that a look at every texel finds.
#include "base/context.h"
#include "base/random.h"
#include "maps/neighbours.h"
#include "test_support.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = 3000, LIMIT = COUNT };

typedef struct cloud {
    float positions[COUNT][3], normals[COUNT][3], sides[COUNT];
    uint32_t near[COUNT];
} cloud;

static float draw(uint32_t i, uint32_t k)
{
    return (float)alpi_hash32(alpi_hash32(i) ^ k) / 4294967296.0f;
}

/// Points in a box of 2 m about the origin, with sides of .02 to .3 m.
static void scatter(cloud *c)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            c->positions[i][k] = 2.0f * draw(i, k) - 1.0f;
        }
        const vec3 n = {draw(i, 4) - 0.5f, draw(i, 5) - 0.5f, draw(i, 6) - 0.5f};
        vec3_store(c->normals[i], vec3_normalize_or(n, (vec3){0.0f, 1.0f, 0.0f}));
        c->sides[i] = 0.02f * powf(15.0f, draw(i, 7));
    }
}

static bool is_near(const alpi_site *centre, const alpi_site *s, float radius)
{
    const vec3 away = vec3_sub(s->position, centre->position);
    return vec3_dot(away, away) <= radius * radius &&
           fabsf(vec3_dot(away, centre->normal)) <= centre->side &&
           s->side <= 2.0f * centre->side && s->side >= 0.5f * centre->side;
}

TEST_WITH_CONTEXT(the_grid_finds_what_looking_at_all_finds, 1)
{
    static cloud c;
    static bool listed[COUNT];
    scatter(&c);
    alpi_neighbours n;
    ASSERT_OK(context, alpi_neighbours_create(context, COUNT, (const float(*)[3])c.positions,
                                              (const float(*)[3])c.normals, c.sides, &n));
    assert_int_equal(alpi_neighbours_placed(&n), COUNT);
    uint32_t sum = 0;
    for (uint32_t i = 0; i < COUNT; i += 7) {
        const float radius = 8.0f * n.sites[i].side;
        const uint32_t found = alpi_neighbours_around(&n, &n.sites[i], radius, LIMIT, c.near);
        memset(listed, 0, sizeof listed);
        for (uint32_t k = 0; k < found; k++) {
            assert_false(listed[c.near[k]]); // once each
            listed[c.near[k]] = true;
        }
        for (uint32_t k = 0; k < COUNT; k++) {
            assert_int_equal(listed[k], is_near(&n.sites[i], &n.sites[k], radius));
        }
        assert_true(listed[i]);
        sum += found;
        if (found > 1) {
            assert_int_equal(alpi_neighbours_around(&n, &n.sites[i], radius, found - 1, c.near),
                             found);
        }
    }
    assert_true(sum > COUNT); // or the test shows nothing
    alpi_neighbours_destroy(&n);
}

TEST_WITH_CONTEXT(places_that_are_none_are_nobodys_neighbours, 1)
{
    static cloud c;
    scatter(&c);
    c.positions[0][1] = NAN;
    c.positions[1][2] = INFINITY;
    c.normals[2][0] = NAN;
    c.sides[3] = 0.0f;
    c.sides[4] = INFINITY;
    c.positions[5][0] = 1e30f;
    c.sides[6] = 1e-40f;
    c.sides[7] = 1e38f;
    c.positions[8][0] = 1e12f; // far, but a place
    c.sides[9] = 1e-14f;
    c.sides[10] = 1e14f;
    alpi_neighbours n;
    ASSERT_OK(context, alpi_neighbours_create(context, COUNT, (const float(*)[3])c.positions,
                                              (const float(*)[3])c.normals, c.sides, &n));
    assert_int_equal(alpi_neighbours_placed(&n), COUNT - 8);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(n.sites[i].texel < 8, i >= COUNT - 8);
    }
    for (uint32_t i = 0; i < COUNT - 8; i++) {
        const float radius = 8.0f * n.sites[i].side;
        const uint32_t found = alpi_neighbours_around(&n, &n.sites[i], radius, LIMIT, c.near);
        assert_true(n.sites[i].texel > 10 ? found > 0 : found == 1);
        for (uint32_t k = 0; k < found; k++) {
            assert_true(n.sites[c.near[k]].texel >= 8);
        }
    }
    alpi_neighbours_destroy(&n);
}
