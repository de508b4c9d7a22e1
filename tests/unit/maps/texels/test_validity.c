// SPDX-License-Identifier: MIT
// Texels inside other geometry are found stratum by stratum, and lifts that would pass through
// something are not made.
#include "atlas/facet.h"
#include "base/context.h"
#include "maps/texels/inside.h"
#include "maps/texels/validity.h"
#include "scene/builtin/mesh_builder.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 16, PAGE = 128 };

typedef struct validity_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_receivers receivers;
    alpi_lattice lattice;
    alpi_occlusion_setup setup;
    alpi_validity validity;
} validity_setup;

/// Looks at all texels of a scene, in charts at SIZE texels per metre or as its coordinates say.
static void look_in(validity_setup *s, alp_scene *scene, alp_context *context, alp_atlas_mode mode)
{
    *s = (validity_setup){.context = context, .scene = scene};
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.mode = mode;
    atlas.size = PAGE;
    atlas.texels_per_metre = SIZE;
    ASSERT_OK(context, alp_atlas_create(scene, &atlas, &s->atlas));
    ASSERT_OK(context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    s->receivers = alpi_texels_receivers(&s->texels);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    const alp_occlusion_options options = alp_occlusion_options_default();
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &s->setup));
    ASSERT_OK(context, alpi_validity_create(&s->setup, &s->receivers, &s->texels, &s->lattice,
                                            s->lattice.order, s->texels.count, NULL, &s->validity));
}

static void look(validity_setup *s, alp_scene *scene, alp_context *context)
{
    look_in(s, scene, context, ALP_ATLAS_CHARTS);
}

static void end(validity_setup *s)
{
    alpi_validity_destroy(&s->validity);
    alpi_occlusion_release(&s->setup);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// A floor of 2 × 2 m and a closed box that stands on it, its sides at odd parts of texels.
static test_mesh *box_on_floor(void)
{
    const double a = 0.52, b = 1.4, h = 0.5; // 8.32 and 22.4 texels
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    test_mesh_quad(mesh, (double[]){a, h, a}, (double[]){0, 0, b - a}, (double[]){b - a, 0, 0});
    test_mesh_quad(mesh, (double[]){a, 0, a}, (double[]){0, h, 0}, (double[]){b - a, 0, 0});
    test_mesh_quad(mesh, (double[]){a, 0, b}, (double[]){b - a, 0, 0}, (double[]){0, h, 0});
    test_mesh_quad(mesh, (double[]){a, 0, a}, (double[]){0, 0, b - a}, (double[]){0, h, 0});
    test_mesh_quad(mesh, (double[]){b, 0, a}, (double[]){0, h, 0}, (double[]){0, 0, b - a});
    return mesh;
}

static bool is_under_box(vec3 p)
{
    return p.x > 0.52f && p.x < 1.4f && p.z > 0.52f && p.z < 1.4f;
}

TEST(strata_under_a_box_are_left_out)
{
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, test_mesh_scene(context, box_on_floor(), 0), context);
    assert_non_null(s.texels.valid);
    uint32_t mixed = 0, dropped = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        if (s.texels.triangles[t] > 1) {
            continue; // of the box
        }
        uint16_t *mask = s.texels.valid;
        const uint16_t valid = mask[t];
        s.texels.valid = NULL; // so that the square is the whole texel
        int inside = 0, wrong = 0;
        for (int i = 0; i < 16; i++) {
            const float square[1][2] = {
                {((float)(i % 4) + 0.5f) / 4.0f, ((float)(i / 4) + 0.5f) / 4.0f}};
            alpi_receiver_point p;
            s.receivers.place(s.receivers.user, t, 1, square, &p);
            const bool under = is_under_box(p.position);
            inside += under;
            wrong += valid != 0 && ((valid >> i & 1) == 0) != under;
        }
        s.texels.valid = mask;
        if (inside > 0 && inside < 16) {
            assert_int_equal(wrong, 0);
            assert_true(valid != 0);
            mixed++;
        }
        dropped += s.validity.dropped[t];
        assert_true(!s.validity.dropped[t] || inside == 16);
    }
    assert_true(mixed >= 4 * 13);      // the box is 14.1 texels wide
    assert_int_equal(dropped, 4 * 12); // the rim of the 13 × 13 wholly under it
    assert_int_equal(s.validity.moved_count >= mixed, 1);
    end(&s);
}

TEST(double_sided_walls_hide_no_inside)
{
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, test_mesh_scene(context, box_on_floor(), 1), context);
    assert_null(s.texels.valid);
    assert_int_equal(s.validity.moved_count + s.validity.dropped_count, 0);
    uint32_t near = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        near += s.validity.proximity[t];
    }
    assert_true(near > 0 && near < s.texels.count);
    end(&s);
}

TEST(a_one_sided_wall_has_a_behind)
{
    // Seen from +x only, at 8.4 texels: what lies within a texel behind it is left out.
    alp_context *context = test_context(2);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    test_mesh_quad(mesh, (double[]){0.525, 0, 0}, (double[]){0, 1, 0}, (double[]){0, 0, 2});
    validity_setup s;
    look(&s, test_mesh_scene(context, mesh, 0), context);
    assert_non_null(s.texels.valid);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        alpi_receiver_point middle;
        alpi_texels_point(&s.texels, t, &middle);
        if (s.texels.triangles[t] > 1) {
            continue;
        }
        const float x = middle.position.x * (float)SIZE;
        if (x > 9.0f || x < 6.0f) {
            assert_true(s.texels.valid[t] == 0);
        } else if (x > 8.0f) { // cut by the wall: its part in front stays
            assert_true(s.texels.valid[t] != 0 && s.texels.valid[t] != UINT16_MAX);
        }
    }
    end(&s);
}

/// .3 m behind a wall of one side: one of texels of half a metre is inside, of a tenth is not.
/// @param others quads far below
static void look_behind_a_wall(int others)
{
    alp_context *context = test_context(1);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0.3, 0, -1}, (double[]){0, 1, 0}, (double[]){0, 0, 2});
    for (int i = 0; i < others; i++) {
        test_mesh_quad(mesh, (double[]){2.0 * i, -9, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    }
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    const vec3 up = {0.0f, 1.0f, 0.0f};
    alpi_receiver_point points[32];
    float sides[32];
    uint32_t large = 0;
    for (uint32_t i = 0; i < 32; i++) {
        points[i] = (alpi_receiver_point){.position = {0.0f, 0.2f, 0.01f * (float)i},
                                          .geometric_normal = up,
                                          .shading_normal = up,
                                          .offset = 1e-5f};
        sides[i] = i % 3 == 1 ? 0.5f : 0.1f;
        large |= (i % 3 == 1 ? 1u : 0u) << i;
    }
    assert_int_equal(alpi_are_inside(tracer, scene, points, sides, UINT32_MAX), large);
    assert_int_equal(alpi_are_inside(tracer, scene, points, sides, 0xff0ff0f0u),
                     large & 0xff0ff0f0u);
    assert_int_equal(alpi_are_inside(tracer, scene, points, sides, 0), 0);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(points_look_as_far_as_their_own_texels)
{
    look_behind_a_wall(0);   // all triangles are met
    look_behind_a_wall(300); // too many for that
}

static void add_box(test_mesh *mesh, const double low[3], const double high[3])
{
    const double x[3] = {high[0] - low[0], 0, 0}, y[3] = {0, high[1] - low[1], 0};
    const double z[3] = {0, 0, high[2] - low[2]};
    test_mesh_quad(mesh, low, x, z);
    test_mesh_quad(mesh, low, z, y);
    test_mesh_quad(mesh, low, y, x);
    test_mesh_quad(mesh, (double[]){low[0], high[1], low[2]}, z, x);
    test_mesh_quad(mesh, (double[]){high[0], low[1], low[2]}, y, z);
    test_mesh_quad(mesh, (double[]){low[0], low[1], high[2]}, x, y);
}

TEST(what_stands_on_a_solid_is_hidden_below)
{
    // A block on a slab, in which a bar is hidden: whoever looks down from below the block meets
    // the front of the bar, and then the backs of both.
    alp_context *context = test_context(2);
    test_mesh *mesh = test_mesh_start();
    add_box(mesh, (double[]){0.4, 0, 0.4}, (double[]){1.6, 0.5, 1.6});
    add_box(mesh, (double[]){0, -0.5, 0}, (double[]){2, 0, 2});
    add_box(mesh, (double[]){0.1, -0.3, 0.1}, (double[]){1.9, -0.1, 1.9});
    validity_setup s;
    look(&s, test_mesh_scene(context, mesh, 0), context);
    uint32_t hidden = 0, below = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        const bool is = (s.texels.flags[t] & ALPI_TEXEL_HIDDEN) != 0;
        hidden += is;
        if (s.texels.triangles[t] < 2) { // the block's lower side
            assert_true(is);
            below++;
        } else if (s.texels.triangles[t] < 12) { // what else there is of it
            assert_false(is || s.validity.dropped[t] != 0);
        }
    }
    assert_true(below >= 19 * 19 && hidden > below); // 19.2 texels wide; the slab's middle, the bar
    end(&s);
}

/// Under a roof of one side, whose back is seen from below, nothing beside a box is hidden.
/// @param columns how many of 8 texels, the first next to the box
static void check_beside_box(test_mesh *mesh, uint32_t columns)
{
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, test_mesh_scene(context, mesh, 0), context);
    const float end_x = 1.4375f + (float)columns / SIZE;
    uint32_t beside = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        alpi_receiver_point p;
        alpi_texels_point(&s.texels, t, &p);
        const vec3 at = p.position;
        const bool along = at.x > 1.44f && at.x < end_x && at.z > 0.7f && at.z < 1.2f;
        if (s.texels.triangles[t] < 2 && along) { // of the floor, the box beside it
            assert_true(s.texels.valid == NULL || s.texels.valid[t] == 0);
            assert_true((s.texels.flags[t] & ALPI_TEXEL_HIDDEN) == 0 && !s.validity.dropped[t]);
            beside++;
        }
    }
    assert_int_equal(beside, 8 * columns);
    end(&s);
}

TEST(roofs_of_one_side_enclose_nothing)
{
    // One looks up at the back of the roof to two sides, and through the box at it to the others:
    // along every line there is one back more than fronts, and nothing is near all around.
    test_mesh *mesh = box_on_floor();
    test_mesh_quad(mesh, (double[]){-1, 0.8, -1}, (double[]){0, 0, 4}, (double[]){4, 0, 0});
    check_beside_box(mesh, 2);
    // So low that it is near, and a second one above it to two sides: there are two backs more to
    // these, one to the others.
    mesh = box_on_floor();
    test_mesh_quad(mesh, (double[]){-1, 0.12, -1}, (double[]){0, 0, 4}, (double[]){4, 0, 0});
    test_mesh_quad(mesh, (double[]){1.8, 0.9, -1}, (double[]){0, 0, 4}, (double[]){2, 0, 0});
    check_beside_box(mesh, 1);
}

TEST(what_stands_in_glass_is_not_inside)
{
    // A cube on the floor of a case that is less than a texel wider and higher: all of it touches.
    // Rays from its texels come to backs in every direction.
    enum { GLASS, BLENDED, SOLID, CASES };
    for (int i = 0; i < CASES; i++) {
        alp_context *context = test_context(2);
        alp_scene *scene = NULL;
        alpi_builder b;
        alpi_builder_start(&b, context, "case");
        const vec3 white = {1, 1, 1}, dark = {0, 0, 0};
        const uint32_t stone = alpi_builder_material(&b, "stone", white, dark);
        const uint32_t glass = alpi_builder_material(&b, "glass", white, dark);
        alpi_builder_surface(&b, "cube", stone);
        alpi_builder_box(&b, (vec3){0, 0, 0}, (vec3){1, 1, 1}, ALPI_FACE_ALL);
        alpi_builder_surface(&b, "case", glass);
        alpi_builder_box(&b, (vec3){-0.05f, 0, -0.05f}, (vec3){1.05f, 1.05f, 1.05f}, ALPI_FACE_ALL);
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        scene->materials[glass].transmission = i == GLASS ? 0.5f : 0.0f;
        scene->materials[glass].alpha_mode = i == BLENDED ? ALPI_ALPHA_BLEND : ALPI_ALPHA_OPAQUE;
        scene->materials[glass].base_color[3] = 0.75f;
        validity_setup s;
        look(&s, scene, context);
        uint32_t cube = 0;
        for (uint32_t t = 0; t < s.texels.count; t++) {
            const bool hidden = (s.texels.flags[t] & ALPI_TEXEL_HIDDEN) != 0;
            vec3 c[3];
            alpi_triangle_corners(scene, s.texels.triangles[t], c);
            const bool below = fmaxf(c[0].y, fmaxf(c[1].y, c[2].y)) <= 0.0f;
            if (scene->triangle_surface[s.texels.triangles[t]] == 0 && !below) {
                assert_int_equal(hidden || s.validity.dropped[t] != 0, i == SOLID);
                cube++;
            }
        }
        assert_true(cube >= 5 * SIZE * SIZE);
        assert_true(i == SOLID || (s.texels.valid == NULL && s.validity.dropped_count == 0));
        end(&s);
    }
}

TEST(lifts_end_at_what_they_would_pass)
{
    // A coarse ball of smooth normals rests on a floor: between its vertices the smooth surface
    // that they describe is below the floor.
    alp_context *context = test_context(2);
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    validity_setup s;
    look(&s, scene, context);
    uint32_t low = 0, lifted = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        low += (s.texels.flags[t] & ALPI_TEXEL_NO_LIFT) != 0;
        lifted += alpi_texels_are_lifted(&s.texels, t);
    }
    assert_true(lifted > 0 && low < lifted);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        const float square[2][2] = {{0.3f, 0.4f}, {0.8f, 0.7f}};
        alpi_receiver_point p[2];
        s.receivers.place(s.receivers.user, t, 2, square, p);
        assert_true(p[0].position.y > -1e-4f && p[1].position.y > -1e-4f);
    }
    end(&s);
}

// --- lifts ---------------------------------------------------------------------------------------

static const float GAP = 0.05f;

/// A floor of 2 × 2 m, and over its middle the lowest facet of a coarse, smooth ball of radius 2: a
/// square of 1 × 1 m, seen from below. The sphere that its normals describe is up to 13 cm below
/// the facet, and the floor GAP.
static alp_scene *keel_over_floor(alp_context *context)
{
    const float h = 1.8708287f, r = 2.0f; // of the ball's centre over the facet: √(2² − ½)
    const float positions[8][3] = {{-1, 0, -1},       {-1, 0, 1},          {1, 0, 1},
                                   {1, 0, -1},        {-0.5f, GAP, -0.5f}, {0.5f, GAP, -0.5f},
                                   {0.5f, GAP, 0.5f}, {-0.5f, GAP, 0.5f}};
    float normals[8][3];
    for (int i = 0; i < 8; i++) {
        const bool ball = i >= 4;
        normals[i][0] = ball ? positions[i][0] / r : 0.0f;
        normals[i][1] = ball ? -h / r : 1.0f;
        normals[i][2] = ball ? positions[i][2] / r : 0.0f;
    }
    const uint32_t indices[4][3] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    const alp_mesh mesh = {.vertex_count = 8,
                           .positions = positions[0],
                           .normals = normals[0],
                           .triangle_count = 4,
                           .indices = indices[0],
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

/// How many of the middles of 16 strata of a texel lie below the floor, lifted or as it is flagged.
static int count_below(validity_setup *s, uint32_t texel, bool lifted)
{
    const uint8_t flags = s->texels.flags[texel];
    float square[16][2];
    alpi_receiver_point points[16];
    for (int i = 0; i < 16; i++) {
        square[i][0] = ((float)(i % 4) + 0.5f) / 4.0f;
        square[i][1] = ((float)(i / 4) + 0.5f) / 4.0f;
    }
    s->texels.flags[texel] = lifted ? 0 : flags;
    s->receivers.place(s->receivers.user, texel, 16, (const float(*)[2])square, points);
    s->texels.flags[texel] = flags;
    int below = 0;
    for (int i = 0; i < 16; i++) {
        below += points[i].position.y < 0.0f;
    }
    return below;
}

TEST(lifts_through_a_floor_are_not_made)
{
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, keel_over_floor(context), context);
    float *values = calloc(s.texels.count, sizeof *values);
    assert_non_null(values);
    s.setup.distance = INFINITY;
    s.setup.falloff = ALP_FALLOFF_NONE;
    ASSERT_OK(context, alpi_occlusion_gather(&s.setup, &s.receivers, NULL, s.texels.count, values));
    float largest = 0.0f;
    uint32_t low = 0, flagged = 0, high = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        const bool flag = (s.texels.flags[t] & ALPI_TEXEL_NO_LIFT) != 0;
        const int below = s.texels.triangles[t] >= 2 ? count_below(&s, t, true) : 0;
        flagged += flag;
        if (below == 0) { // of the corners too the floor is near: a ledge
            high += s.texels.triangles[t] >= 2 && flag;
        } else if (below > 8) { // of eight that are looked at, one at least
            assert_true(flag);
            assert_int_equal(count_below(&s, t, false), 0);
            largest = fmaxf(largest, values[t]);
            low++;
        }
    }
    print_message("%u texels kept low, %u as they are, largest %.3f\n", low, high, (double)largest);
    assert_true(low >= 100 && high >= 4); // of some 17²; the corners need little lift
    // Nothing but the gap is seen, at the rim δ = GAP / ½ high and by half a turn of directions
    // about a normal tilted by sin τ = √½ / 2: (2δ sin τ + ½ π δ² cos τ) / π = .027, and the
    // samples' error. Below the floor all would be open.
    assert_true(largest < 0.035f);
    assert_int_equal(s.validity.lowered_count, flagged);
    free(values);
    end(&s);
}

// --- what is near --------------------------------------------------------------------------------

enum { SIDE = 32 }; // texels of a floor and of a wall

/// Appends a quad with its own block of SIDE × SIDE texels: the first two lie across the rows of
/// the page, the others along them.
static void add_block(test_mesh *mesh, float (*uvs)[2], const double p[3], const double u[3],
                      const double v[3])
{
    static const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const uint32_t first = mesh->vertex_count, block = first / 4;
    test_mesh_quad(mesh, p, u, v);
    for (int k = 0; k < 4; k++) {
        float *uv = uvs[first + (uint32_t)k];
        const int axis = block < 2 ? 0 : 1;
        uv[0] = (8.0f + 40.0f * (float)(block % 2) + SIDE * corners[k][axis]) / PAGE;
        uv[1] = (8.0f + 40.0f * (float)(block / 2) + SIDE * corners[k][1 - axis]) / PAGE;
    }
}

/// Two floors, each with a wall across it `at` texels from its side: the second 100 m away and its
/// texels 8 times as large.
static alp_scene *walls_of_two_sizes(alp_context *context, double at)
{
    test_mesh *mesh = test_mesh_start();
    float uvs[16][2];
    for (int i = 0; i < 2; i++) {
        const double texel = i == 0 ? 1.0 / SIZE : 8.0 / SIZE, x = 100.0 * i, side = SIDE * texel;
        add_block(mesh, uvs, (double[]){x, 0, 0}, (double[]){0, 0, side}, (double[]){side, 0, 0});
        add_block(mesh, uvs, (double[]){x + at * texel, 0, 0}, (double[]){0, side, 0},
                  (double[]){0, 0, side});
    }
    const alp_mesh m = {.vertex_count = mesh->vertex_count,
                        .positions = mesh->positions[0],
                        .uvs = uvs[0],
                        .triangle_count = mesh->triangle_count,
                        .indices = mesh->triangles[0],
                        .base_color = {0.5f, 0.5f, 0.5f},
                        .double_sided = true};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &m, 1, &scene));
    return scene;
}

/// Texels from the wall to the nearest of the scouts that a texel of a floor asks: those of even
/// rows and columns of the page, which are the floor's.
static double scout_distance(uint32_t column, double wall)
{
    const double first = column & ~1u, last = column % 2 == 0 ? first : first + 2.0;
    return fmin(fabs(first + 0.5 - wall), fabs(last + 0.5 - wall));
}

/// Holds the texels of one floor to their distances. Of a scout's cosine-distributed rays at a
/// distance of d texels those end at the wall within 2.5 texels that lie beyond x = d / 2.5 on the
/// unit disk: (acos x − x √(1 − x²)) / π, .37 at ½, .14 at 1½, .05 at 2, and TOUCHING is .22.
static void check_floor(const validity_setup *s, uint32_t floor, double wall)
{
    uint32_t counts[3] = {0}, at_less[3] = {0}, at_two[3] = {0};
    for (uint32_t t = 0; t < s->texels.count; t++) {
        if (s->texels.triangles[t] / 4 != floor || s->texels.triangles[t] % 4 >= 2) {
            continue;
        }
        alpi_receiver_point middle;
        alpi_texels_point(&s->texels, t, &middle);
        const float texel = floor == 0 ? 1.0f / SIZE : 8.0f / SIZE;
        const uint32_t column = (uint32_t)((middle.position.x - 100.0f * (float)floor) / texel);
        const uint32_t row = (uint32_t)(middle.position.z / texel);
        const uint8_t near = s->validity.proximity[t];
        const double d = scout_distance(column, wall);
        if (row < 3 || row >= SIDE - 3) {
            continue; // the wall ends
        }
        assert_true(d > 0.6 || near == ALPI_TOUCHING);
        at_less[near] += fabs(d - 1.5) < 0.1;
        assert_true(d < 2.6 || near == ALPI_FAR);
        at_two[near] += fabs(d - 2.0) < 0.1;
        counts[near]++;
    }
    print_message("wall at %.1f: %u far, %u near, %u touching\n", wall, counts[0], counts[1],
                  counts[2]);
    // Sixteen rays tell a share to a sixteenth or two: at 1½ texels, .14, all see the wall and a
    // few of the scouts touch it; at 2, .05, most see it and none touch.
    assert_int_equal(at_less[ALPI_FAR], 0);
    assert_true(at_less[ALPI_NEAR] >= 4 * at_less[ALPI_TOUCHING]);
    assert_int_equal(at_two[ALPI_TOUCHING], 0);
    assert_true(at_two[ALPI_NEAR] >= at_two[ALPI_FAR]);
    assert_true(counts[0] > 0 && counts[1] > 0 && counts[2] > 0);
}

TEST(nearness_is_told_in_texels_of_each_chart)
{
    static const double walls[] = {12.0, 12.5, 13.0};
    for (int i = 0; i < 3; i++) {
        alp_context *context = test_context(2);
        validity_setup s;
        look_in(&s, walls_of_two_sizes(context, walls[i]), context, ALP_ATLAS_KEEP);
        check_floor(&s, 0, walls[i]);
        check_floor(&s, 1, walls[i]);
        end(&s);
    }
}
