// SPDX-License-Identifier: MIT
// Texels that a final gather traces. On a dark square all is smooth, so it traces only those
// without a stencil. On a square of synthetic light it traces those that exceed the limits of the
// judge.
#include "test_scenes.h"

#include "maps/radiosity/final_gather.h"
#include "maps/texels/validity.h"
#include "transport/gather/cosine_rays.h"

enum { SIZE = 32, SPACING = ALPI_LATTICE_SPACING };

typedef struct setting {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    const alpi_tracer *tracer;
    alpi_reference_value values[SIZE * SIZE];
    uint8_t proximity[SIZE * SIZE], states[SIZE * SIZE];
} setting;

/// A square that fills a page.
static void set_up(setting *s)
{
    *s = (setting){.context = test_context(2)};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    s->scene = test_mesh_scene(s->context, mesh, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = SIZE;
    options.texels_per_metre = SIZE;
    options.padding = 0;
    alpi_tracer *tracer = NULL;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &options, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    ASSERT_OK(s->context, alpi_tracer_for_scene(s->scene, NULL, NULL, &tracer, NULL));
    s->tracer = tracer;
    assert_int_equal(s->texels.count, SIZE * SIZE);
}

static void tear_down(setting *s)
{
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

typedef struct map_options {
    const alpi_gather_scene *from;
    const alpi_gatherer *gatherer;
    bool adaptive;
} map_options;

static void map_by(setting *s, const map_options *o)
{
    const alpi_receivers receivers = alpi_texels_receivers(&s->texels);
    const alpi_gather_job gather = {.context = s->context,
                                    .from = o->from,
                                    .gatherer = o->gatherer,
                                    .receivers = &receivers,
                                    .values = s->values};
    const alpi_final_gather_options options = {.gather = &gather,
                                               .order = s->lattice.order,
                                               .count = s->texels.count,
                                               .proximity = s->proximity,
                                               .adaptive = o->adaptive,
                                               .independent = o->gatherer};
    alpi_final_gather_report report = {0};
    ASSERT_OK(s->context, alpi_final_gather(&options, &s->lattice, NULL, s->states, &report));
    assert_int_equal(report.traced + report.interpolated, SIZE * SIZE);
}

/// Gathers by rays in the dark.
static void map(setting *s, bool adaptive)
{
    const alpi_gather_scene from = {.scene = s->scene, .tracer = s->tracer};
    const alpi_cosine_rays rays = {
        .context = s->context, .samples = 64, .replicates = 4, .seed = 1};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
    map_by(s, &(map_options){.from = &from, .gatherer = &gatherer, .adaptive = adaptive});
}

/// Whether a texel has a stencil if all texels are known.
static bool has_stencil(setting *s, uint32_t texel)
{
    alpi_stencil stencil;
    alpi_lattice l = s->lattice;
    uint8_t known[SIZE * SIZE];
    memset(known, ALPI_TEXEL_TRACED, sizeof known);
    l.states = known;
    l.straight = true;
    return alpi_lattice_stencil(&l, texel, &stencil);
}

TEST(touching_texels_are_traced_by_every_second)
{
    static const alpi_proximity all[] = {ALPI_FAR, ALPI_NEAR, ALPI_TOUCHING};
    enum { OF = 16 };
    uint32_t traced[3] = {0};
    setting s;
    set_up(&s);
    for (int k = 0; k < 3; k++) {
        memset(s.proximity, (int)all[k], sizeof s.proximity);
        map(&s, true);
        for (uint32_t t = 0; t < SIZE * SIZE; t++) {
            const bool coarse = alpi_lattice_is_coarse(s.texels.pixels[t]);
            const bool wanted = !has_stencil(&s, t) || (all[k] == ALPI_TOUCHING && coarse);
            assert_int_equal(s.states[t], wanted ? ALPI_TEXEL_TRACED : ALPI_TEXEL_INTERPOLATED);
            traced[k] += wanted;
        }
    }
    // One of 16 or a quarter of all, plus some at two borders.
    assert_true(traced[0] == traced[1] && traced[0] < SIZE * SIZE / OF + 2 * SIZE);
    assert_true(traced[0] >= SIZE * SIZE / OF);
    assert_true(traced[2] >= SIZE * SIZE / 4 && traced[2] < SIZE * SIZE / 4 + SIZE);
    map(&s, false);
    for (uint32_t t = 0; t < SIZE * SIZE; t++) {
        assert_int_equal(s.states[t], ALPI_TEXEL_TRACED);
    }
    tear_down(&s);
}

// --- synthetic light -----------------------------------------------------------------------------

/// Light of texels: a base with a slope or a bend along x. Replicates are a little above and below.
typedef struct made_up {
    const setting *s;
    double slope, bend; // of light a texel, and a texel² about a column
    uint32_t column;
} made_up;
enum { REPLICATES = 4 };
static const double BASE = 0.5, APART = 1e-4;

/// Aims at the place of the square whose x is the light that a replicate shall measure.
static void aim_at_light(const void *user, const alpi_receivers *receivers, uint32_t receiver,
                         uint32_t first, uint32_t count, alpi_gather_packet *packets,
                         alpi_gather_ways *ways)
{
    (void)receivers;
    (void)ways;
    const made_up *m = user;
    const double x = m->s->texels.pixels[receiver][0];
    const double light = BASE + m->slope * x + m->bend * (x - m->column) * (x - m->column);
    for (uint32_t k = 0; k < count; k++) {
        const double found = light + ((first + k) % 2 == 0 ? APART : -APART);
        alpi_rays_clear(&packets[k].rays);
        for (int i = 0; i < ALPI_PACKET; i++) {
            alpi_rays_set(&packets[k].rays, i, (vec3){(float)found, 1.0f, 0.25f},
                          (vec3){0.0f, -1.0f, 0.0f}, INFINITY);
        }
        packets[k].active = (1u << ALPI_PACKET) - 1u;
    }
}

static void reflect_x(const void *user, const alpi_surface_point *points, uint32_t count,
                      vec3 *radiance)
{
    const alp_scene *scene = user;
    for (uint32_t i = 0; i < count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, points[i].triangle, c);
        const float x =
            c[0].x + points[i].b1 * (c[1].x - c[0].x) + points[i].b2 * (c[2].x - c[0].x);
        radiance[i] = (vec3){x, x, x};
    }
}

/// Gathers synthetic light. @return the traced share of the texels halfway between two texels of a
/// lattice row; with a bend, of those in its column
static double traced_where(double slope, double bend)
{
    setting s;
    set_up(&s);
    const made_up light = {&s, slope, bend, SPACING * 3 / 2};
    const alpi_gather_scene from = {
        .scene = s.scene, .tracer = s.tracer, .light = {.reflected = reflect_x, .user = s.scene}};
    const alpi_gatherer gatherer = {
        .aim = aim_at_light, .user = &light, .packet_count = REPLICATES, .replicates = REPLICATES};
    map_by(&s, &(map_options){.from = &from, .gatherer = &gatherer, .adaptive = true});
    uint32_t traced = 0, all = 0;
    for (uint32_t t = 0; t < SIZE * SIZE; t++) {
        const uint16_t *p = s.texels.pixels[t];
        const bool halfway = p[0] % SPACING == SPACING / 2 && p[1] % SPACING == 0;
        // A cubic needs two texels of the row on either side; stencils of borders have none.
        const bool inside = p[0] >= SPACING * 3 / 2 && p[0] + SPACING * 3 / 2 < SIZE &&
                            p[1] >= SPACING && p[1] < SIZE - SPACING;
        if (halfway && inside && (bend == 0.0 || p[0] == light.column)) {
            all++;
            traced += s.states[t] == ALPI_TEXEL_TRACED;
        }
    }
    tear_down(&s);
    assert_true(all > 0);
    return (double)traced / all;
}

/// Noise of a texel: standard error of the mean of four replicates, two above it and two below.
static double noise_of_texel(void)
{
    return APART / sqrt(REPLICATES - 1.0);
}

/// Traced share between two texels of the lattice that differ by `times` the noise.
static double traced_by_spread(double noises)
{
    return traced_where(noises * noise_of_texel() / SPACING, 0.0);
}

/// Traced share if the cubic of four texels, d apart, is `times` the noise off the straight line
/// between the inner two: (f(−3d/2) − f(−d/2) − f(d/2) + f(3d/2)) / 16 = d² / 4 of x².
static double traced_by_bend(double noises)
{
    return traced_where(0.0, noises * noise_of_texel() / (SPACING * SPACING / 4.0));
}

TEST(what_differs_too_much_is_traced)
{
    static const double spread = 20.0, bend = 1.0; // the limits
    // With some margin: limits scale with the light of a texel, which differs from the mean.
    assert_true(traced_by_spread(0.95 * spread) == 0.0);
    assert_true(traced_by_spread(1.05 * spread) == 1.0);
    assert_true(traced_by_bend(0.95 * bend) == 0.0);
    assert_true(traced_by_bend(1.05 * bend) == 1.0);
}
