// SPDX-License-Identifier: MIT
// Which texels a map of bounced light traces: on a square in the dark, where all is smooth, those
// alone that nothing else may stand for; and on one of made-up light, those that differ by more
// than the limits let pass.
#include "test_scenes.h"

#include "maps/radiosity/bounced_map.h"
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
    uint8_t near[SIZE * SIZE], states[SIZE * SIZE];
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
    const alpi_bounced_options options = {.gather = &gather,
                                          .order = s->lattice.order,
                                          .count = s->texels.count,
                                          .near = s->near,
                                          .adaptive = o->adaptive,
                                          .straight = true,
                                          .beside = o->gatherer};
    alpi_bounced_report report = {0};
    ASSERT_OK(s->context, alpi_bounced_map(&options, &s->lattice, NULL, s->states, &report));
    assert_int_equal(report.traced + report.interpolated, SIZE * SIZE);
}

/// By rays in the dark.
static void map(setting *s, bool adaptive)
{
    const alpi_gather_scene from = {.scene = s->scene, .tracer = s->tracer};
    const alpi_cosine_rays rays = {
        .context = s->context, .samples = 64, .replicates = 4, .seed = 1};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
    map_by(s, &(map_options){.from = &from, .gatherer = &gatherer, .adaptive = adaptive});
}

/// Whether others could stand for a texel if all were known.
static bool has_stencil(setting *s, uint32_t texel)
{
    alpi_stencil stencil;
    alpi_lattice l = s->lattice;
    uint8_t known[SIZE * SIZE];
    memset(known, ALPI_TEXEL_TRACED, sizeof known);
    l.states = known;
    l.along_borders = true;
    return alpi_lattice_stencil(&l, texel, &stencil);
}

TEST(touching_texels_are_traced_by_every_second)
{
    static const alpi_nearness all[] = {ALPI_FAR, ALPI_NEAR, ALPI_TOUCHING};
    enum { OF = 16 };
    uint32_t traced[3] = {0};
    setting s;
    set_up(&s);
    for (int k = 0; k < 3; k++) {
        memset(s.near, (int)all[k], sizeof s.near);
        map(&s, true);
        for (uint32_t t = 0; t < SIZE * SIZE; t++) {
            const bool coarse = alpi_lattice_is_coarse(s.texels.pixels[t]);
            const bool wanted = !has_stencil(&s, t) || (all[k] == ALPI_TOUCHING && coarse);
            assert_int_equal(s.states[t], wanted ? ALPI_TEXEL_TRACED : ALPI_TEXEL_INTERPOLATED);
            traced[k] += wanted;
        }
    }
    // One of so many, or a quarter, and some of two borders.
    assert_true(traced[0] == traced[1] && traced[0] < SIZE * SIZE / OF + 2 * SIZE);
    assert_true(traced[0] >= SIZE * SIZE / OF);
    assert_true(traced[2] >= SIZE * SIZE / 4 && traced[2] < SIZE * SIZE / 4 + SIZE);
    map(&s, false);
    for (uint32_t t = 0; t < SIZE * SIZE; t++) {
        assert_int_equal(s.states[t], ALPI_TEXEL_TRACED);
    }
    tear_down(&s);
}

// --- made-up light -------------------------------------------------------------------------------

/// Light of texels: base, and along x a slope or a bend; and of replicates a little more or less.
typedef struct made_up {
    const setting *s;
    double slope, bend; // of light a texel, and a texel² about a column
    uint32_t column;
} made_up;
enum { REPLICATES = 4 };
static const double BASE = 0.5, APART = 1e-4;

/// Aims at where on the square x is the light that a replicate finds.
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

/// Maps it. @return the share that is traced of the texels halfway between two of a row of the
/// lattice; where light bends, of those in the column about which it does
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
        // Of its row are two on either side, or there is no cubic; nor is it in a border's.
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

/// Noise of a texel, as light: of the mean of four replicates, two of them over it and two below.
static double noise_of_texel(void)
{
    return APART / sqrt(REPLICATES - 1.0);
}

/// Between two texels of a lattice that differ by so many times their noise.
static double traced_by_spread(double noises)
{
    return traced_where(noises * noise_of_texel() / SPACING, 0.0);
}

/// Where the cubic of four texels, d apart, is so many times the noise off the straight line
/// between the two in the middle: (f(−3d/2) − f(−d/2) − f(d/2) + f(3d/2)) / 16 = d² / 4 of x².
static double traced_by_bend(double noises)
{
    return traced_where(0.0, noises * noise_of_texel() / (SPACING * SPACING / 4.0));
}

TEST(what_differs_too_much_is_traced)
{
    static const double spread = 20.0, bend = 1.0; // the limits
    // A little more or less: limits go with the light of a texel, which is not that of all.
    assert_true(traced_by_spread(0.95 * spread) == 0.0);
    assert_true(traced_by_spread(1.05 * spread) == 1.0);
    assert_true(traced_by_bend(0.95 * bend) == 0.0);
    assert_true(traced_by_bend(1.05 * bend) == 1.0);
}
