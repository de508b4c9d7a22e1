// SPDX-License-Identifier: MIT
// Points of a texel are lifted to the smooth surface: by the formula, not too far, and where there
// is one.
#include "atlas_scenes.h"

#include "base/random.h"

/// A cube of side 2 whose corners' normals are given by `normal`, and the texels it has.
static alp_scene *normal_cube(alp_context *context, void (*normal)(const float at[3], float out[3]))
{
    alp_scene *flat = scene_cube(context);
    float positions[36][3], normals[36][3];
    uint32_t indices[12][3];
    for (uint32_t i = 0; i < 36; i++) {
        memcpy(positions[i], flat->positions[flat->triangles[i / 3][i % 3]], sizeof *positions);
        normal(positions[i], normals[i]);
        indices[i / 3][i % 3] = i;
    }
    alp_scene_destroy(flat);
    const alp_mesh mesh = {.vertex_count = 36,
                           .positions = positions[0],
                           .normals = normals[0],
                           .triangle_count = 12,
                           .indices = indices[0]};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

static void out_of_the_middle(const float at[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = at[k] / sqrtf(3.0f);
    }
}

static void into_the_middle(const float at[3], float out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = -at[k] / sqrtf(3.0f);
    }
}

/// A square of 2 m whose normals are those of a ball, at its corners so many degrees from upright.
static alp_scene *tilted_plate(alp_context *context, double degrees)
{
    const float up = (float)cos(degrees * acos(-1.0) / 180.0);
    const float out = (float)(sin(degrees * acos(-1.0) / 180.0) * sqrt(0.5));
    float positions[4][3], normals[4][3];
    for (int k = 0; k < 4; k++) {
        const float x = k == 1 || k == 2 ? 1.0f : -1.0f, z = k < 2 ? 1.0f : -1.0f;
        memcpy(positions[k], (float[3]){x, 0.0f, z}, sizeof positions[k]);
        memcpy(normals[k], (float[3]){out * x, up, out * z}, sizeof normals[k]);
    }
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = positions[0],
                           .normals = normals[0],
                           .triangle_count = 2,
                           .indices = indices[0]};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    return scene;
}

/// Largest distance by which points of a scene's texels are lifted, m.
static double largest_lift(alp_context *context, alp_scene *scene, bool below_is_fault)
{
    alp_atlas *atlas = charts_of_size(context, scene, 64);
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    const alpi_receivers r = alpi_texels_receivers(&texels);
    static float square[GRID_POINTS][2];
    alpi_receiver_point lifted[64], plain[64];
    fill_point_grid(square);
    double largest = 0.0;
    for (uint32_t i = 0; i < texels.count; i++) {
        const float(*part)[2] = (const float(*)[2])(square + i % 8 * 64);
        texels.flags[i] = 0;
        r.place(r.user, i, 64, part, lifted);
        texels.flags[i] = ALPI_TEXEL_NO_LIFT;
        r.place(r.user, i, 64, part, plain);
        for (int k = 0; k < 64; k++) {
            const vec3 lift = vec3_sub(lifted[k].position, plain[k].position);
            largest = fmax(largest, (double)vec3_length(lift));
            assert_true(!below_is_fault || vec3_dot(lift, plain[k].geometric_normal) >= 0.0f);
            assert_memory_equal(&lifted[k].shading_normal, &plain[k].shading_normal, sizeof(vec3));
            assert_true(vec3_dot(plain[k].shading_normal, plain[k].geometric_normal) > 0.0f);
        }
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    return largest;
}

TEST_WITH_CONTEXT(lifts_have_a_limit, 1)
{
    // Flat triangles stay where they are, to the bit.
    assert_true(largest_lift(context, scene_sphere(context, 12, 24), true) == 0.0);
    // Normals of a ball 40° across ask for .49 m: they get an eighth of the diagonal.
    const double most = largest_lift(context, tilted_plate(context, 40.0), true);
    ASSERT_NEAR(most, 0.125 * sqrt(8.0), 1e-5);
    // Beyond 41° they describe creases: at 43° about half, from 45° on nothing is left.
    const double less = largest_lift(context, tilted_plate(context, 43.0), true);
    assert_true(less > 0.1 && less < 0.8 * most);
    assert_true(largest_lift(context, tilted_plate(context, 46.0), true) == 0.0);
    assert_true(largest_lift(context, normal_cube(context, out_of_the_middle), true) == 0.0);
    // Normals that point inside describe no surface.
    assert_true(largest_lift(context, normal_cube(context, into_the_middle), true) == 0.0);
}

TEST_WITH_CONTEXT(a_lift_follows_its_formula, 1)
{
    // Middle of an edge between corners on a circle, normals outwards, span 2a: both corners lift
    // it by sin² a along their normals: by sin² a · cos a along their mean.
    const double a = 0.3;
    const float s = (float)sin(a), c = (float)cos(a);
    const float p[4][3] = {{-s, c, 0}, {-s, c, 4}, {s, c, 4}, {s, c, 0}};
    const float n[4][3] = {{-s, c, 0}, {-s, c, 0}, {s, c, 0}, {s, c, 0}};
    const float uvs[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = p[0],
                           .normals = n[0],
                           .uvs = uvs[0],
                           .triangle_count = 2,
                           .indices = indices[0]};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 8;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    const alpi_receivers r = alpi_texels_receivers(&texels);
    const float origin[1][2] = {{0.0f, 0.0f}};
    alpi_receiver_point point;
    for (uint32_t i = 0; i < texels.count; i++) {
        if (texels.piece_first[i] == texels.piece_first[i + 1]) { // at its corner of low u and v
            r.place(r.user, i, 1, origin, &point);
            const double u = texels.pixels[i][0] / 8.0; // the weight of the right side
            // Heights over the tangent planes: −2 u sin² a and −2 (1 − u) sin² a. Both times the
            // other weight: 2 u (1 − u) sin² a along each normal, and two thirds of that is done.
            const double lift = 2.0 * u * (1.0 - u) * sin(a) * sin(a);
            ASSERT_NEAR(point.position.x, (2.0 * u - 1.0) * sin(a), 1e-6);
            ASSERT_NEAR(point.position.y, cos(a) + 0.7 * 2.0 * lift * cos(a), 2e-6);
        }
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

// --- kept shapes ---------------------------------------------------------------------------------

enum { SAME_POINTS = 8 };

static void place_all(const alpi_texels *texels, uint32_t texel,
                      alpi_receiver_point points[SAME_POINTS + 1], alpi_texel_spot *spot,
                      vec3 lows[SAME_POINTS])
{
    float square[SAME_POINTS][2];
    for (uint32_t i = 0; i < SAME_POINTS; i++) {
        square[i][0] = alpi_unit_float(alpi_random_key(texel, i, 0));
        square[i][1] = alpi_unit_float(alpi_random_key(texel, i, 1));
    }
    const alpi_receivers r = alpi_texels_receivers(texels);
    r.place(r.user, texel, SAME_POINTS, (const float(*)[2])square, points);
    alpi_texels_point(texels, texel, &points[SAME_POINTS]);
    alpi_texels_spot(texels, texel, square[0], spot);
    alpi_receiver_point again[SAME_POINTS];
    alpi_texels_lifts(texels, texel, SAME_POINTS, (const float(*)[2])square, again, lows);
}

/// @return how many texels lie elsewhere without their lift
static uint32_t count_lifted(alp_context *context, alp_scene *scene, alp_atlas *atlas, bool kept)
{
    alpi_texels texels;
    uint32_t lifted = 0;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    assert_int_equal(texels.shapes != NULL, kept);
    alpi_texels without = texels;
    without.shapes = NULL;
    for (uint32_t i = 0; i < texels.count; i++) {
        alpi_receiver_point a[SAME_POINTS + 1], b[SAME_POINTS + 1], low[SAME_POINTS + 1];
        alpi_texel_spot at[2];
        vec3 lows[2][SAME_POINTS];
        place_all(&texels, i, a, &at[0], lows[0]);
        place_all(&without, i, b, &at[1], lows[1]);
        assert_memory_equal(a, b, sizeof a);
        assert_memory_equal(&at[0], &at[1], sizeof *at);
        assert_memory_equal(lows[0], lows[1], sizeof *lows);
        texels.flags[i] = ALPI_TEXEL_NO_LIFT; // of both
        place_all(&texels, i, low, &at[0], lows[0]);
        place_all(&without, i, b, &at[1], lows[1]);
        assert_memory_equal(low, b, sizeof low);
        lifted += vec3_length(vec3_sub(a[0].position, low[0].position)) > 0.0f ? 1 : 0;
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    return lifted;
}

static alp_atlas *blend_of_size(alp_context *context, const alp_scene *scene, uint32_t size)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_BLEND;
    options.size = size;
    alp_atlas *atlas = NULL;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    assert_true(alpi_atlas_face_count(atlas) > scene->triangle_count);
    return atlas;
}

TEST_WITH_CONTEXT(kept_shapes_place_the_same, 2)
{
    alp_scene *flat = scene_cube(context), *round = tilted_plate(context, 40.0);
    alp_scene *blended = scene_sphere(context, 12, 24);
    alp_scene *fine = scene_sphere(context, 30, 60);
    assert_int_equal(count_lifted(context, flat, charts_of_size(context, flat, 64), true), 0);
    assert_true(count_lifted(context, round, charts_of_size(context, round, 64), true) > 1000);
    (void)count_lifted(context, blended, blend_of_size(context, blended, 256), true);
    (void)count_lifted(context, fine, charts_of_size(context, fine, 100), false);
}
