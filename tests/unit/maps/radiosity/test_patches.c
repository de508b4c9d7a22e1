// SPDX-License-Identifier: MIT
// Patches: the look-up of texels, the grouping into patches, and reflectance.
#include "patch_setting.h"
#include "test_radiant.h"

#include "base/memory.h"
#include "base/random.h"
#include "maps/radiosity/patch_reach.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const vec3 ONE = {1, 1, 1}, ZERO = {0, 0, 0}, HALF = {0.5f, 0.5f, 0.5f};

static vec3 point_at(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_mad(vec3_mad(c[0], b1, vec3_sub(c[1], c[0])), b2, vec3_sub(c[2], c[0]));
}

/// The cell of a point by a packet. The other lanes hit nothing and must stay unchanged.
static uint32_t find_cell(const alpi_patches *patches, uint32_t triangle, float b1, float b2,
                          bool behind)
{
    enum { LANE = 5, UNTOUCHED = 77 };
    const alpi_surface_light light = alpi_patches_light(patches);
    const uint32_t met[2] = {0, 1u << LANE};
    uint32_t cells[2][ALPI_PACKET];
    alpi_hits hits[2];
    memset(hits, 0xff, sizeof hits); // no triangle
    hits[1].triangle[LANE] = triangle;
    hits[1].b1[LANE] = b1;
    hits[1].b2[LANE] = b2;
    hits[1].behind = behind ? 1u << LANE : 0;
    for (int i = 0; i < 2 * ALPI_PACKET; i++) {
        cells[i / ALPI_PACKET][i % ALPI_PACKET] = UNTOUCHED;
    }
    light.find(light.user, hits, met, 2, cells);
    for (int i = 0; i < 2 * ALPI_PACKET; i++) {
        assert_true(i == ALPI_PACKET + LANE ||
                    cells[i / ALPI_PACKET][i % ALPI_PACKET] == UNTOUCHED);
    }
    return cells[1][LANE];
}

/// Packets of one triangle and of two in turn read the same cells as their points alone.
static void hold_packets(const setting *s)
{
    const alpi_surface_light light = alpi_patches_light(&s->patches);
    const uint32_t count = s->scene->triangle_count;
    for (uint32_t t = 0; t < count; t++) {
        alpi_hits hits[ALPI_LIGHT_BATCH];
        uint32_t met[ALPI_LIGHT_BATCH], cells[ALPI_LIGHT_BATCH][ALPI_PACKET];
        for (uint32_t k = 0; k < ALPI_LIGHT_BATCH; k++) {
            met[k] = 0xffu;
            hits[k].behind = 0;
            for (uint32_t i = 0; i < ALPI_PACKET; i++) {
                hits[k].triangle[i] = k % 2 == 1 && i % 2 == 1 ? (t + k) % count : t;
                pick_point(hits[k].triangle[i], k / 2 * ALPI_PACKET + i, &hits[k].b1[i],
                           &hits[k].b2[i]);
            }
        }
        light.find(light.user, hits, met, ALPI_LIGHT_BATCH, cells);
        for (uint32_t k = 0; k < ALPI_LIGHT_BATCH; k++) {
            for (uint32_t i = 0; i < ALPI_PACKET; i++) {
                const uint32_t texel = alpi_patches_find(&s->patches, hits[k].triangle[i],
                                                         hits[k].b1[i], hits[k].b2[i]);
                assert_int_equal(cells[k][i],
                                 texel == ALPI_NONE ? ALPI_CELL_BLACK : ALPI_CELL_FIRST + texel);
            }
        }
    }
}

/// Points all over every triangle, corners and edges too, find a texel of the triangle's chart with
/// light of its own, at most `reach` texels away.
static double hold_lookups(const setting *s, double reach, uint32_t *black)
{
    const double texel = 1.0 / alp_atlas_get_info(s->atlas).texels_per_metre;
    double worst = 0.0;
    *black = 0;
    hold_packets(s);
    for (uint32_t t = 0; t < s->scene->triangle_count; t++) {
        for (uint32_t i = 0; i < 24; i++) {
            float b1, b2;
            pick_point(t, i, &b1, &b2);
            const uint32_t found = alpi_patches_find(&s->patches, t, b1, b2);
            if (found == ALPI_NONE) {
                ++*black;
                continue;
            }
            assert_int_equal(find_cell(&s->patches, t, b1, b2, false), ALPI_CELL_FIRST + found);
            assert_int_equal(s->texels.charts[found], s->atlas->triangle_charts[t]);
            assert_true(s->patches.patch_of[found] != ALPI_NONE);
            const float *b = s->texels.barycentrics[found];
            const vec3 at = point_at(s->scene, s->texels.triangles[found], b[0], b[1]);
            const double away =
                (double)vec3_length(vec3_sub(at, point_at(s->scene, t, b1, b2))) / texel;
            worst = fmax(worst, away);
            ASSERT_NEAR(away, 0.0, reach);
        }
    }
    return worst;
}

/// A point is at most a texel's diagonal from the point that represents its texel, half of it if
/// that is the middle, and √2 more if the chart slopes by up to π/4.
TEST(lookups_stay_in_their_charts)
{
    static const struct {
        int slices, stacks;
        uint32_t size, charts;
        float angle;
        double reach;
    } cases[] = {{24, 12, 256, 2, 0.78f, 1.5},
                 {24, 12, 128, 250, 0.01f, 1.1},
                 {96, 48, 256, 4096, 0.01f, 1.1},  // texels as large as facets
                 {96, 48, 160, 4096, 0.01f, 1.1}}; // charts of a texel and less
    for (int i = 0; i < 4; i++) {
        setting s;
        uint32_t black;
        open_setting(&s, make_ball(test_context(2), cases[i].slices, cases[i].stacks),
                     cases[i].size, cases[i].angle, 4, i < 3 ? 1 : 0);
        const alp_atlas_info info = alp_atlas_get_info(s.atlas);
        assert_true(info.charts >= cases[i].charts);
        const double worst = hold_lookups(&s, cases[i].reach, &black);
        printf("look-ups in %u charts, %u texels: at most %.2f texels away, %u without\n",
               info.charts, s.texels.count, worst, black);
        assert_int_equal(black, 0);
        close_setting(&s);
    }
}

TEST(lookups_stay_on_their_pages)
{
    setting s;
    uint32_t black;
    alp_atlas_options a = alp_atlas_options_default();
    a.size = 64;
    a.texels_per_metre = 14.0;
    a.max_angle = 0.3f;
    open_on(&s, make_ball(test_context(2), 24, 12), &a, 4, 1);
    assert_true(alp_atlas_get_info(s.atlas).pages >= 2);
    (void)hold_lookups(&s, 1.5, &black);
    assert_int_equal(black, 0);
    close_setting(&s);
}

/// Two squares whose kept charts share a column of texels. The column belongs to one of them; the
/// other finds texels beside it.
TEST(charts_that_share_a_texel)
{
    static const float uvs[2][4][2] = {{{0, 0}, {0, 1}, {0.46f, 1}, {0.46f, 0}},
                                       {{0.465f, 0}, {0.465f, 1}, {1, 1}, {1, 0}}};
    static const float squares[2][4][3] = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}},
                                           {{3, 0, 0}, {3, 0, 1}, {4, 0, 1}, {4, 0, 0}}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    alp_mesh meshes[2];
    for (int i = 0; i < 2; i++) {
        meshes[i] = (alp_mesh){.positions = squares[i][0],
                               .uvs = uvs[i][0],
                               .indices = triangles[0],
                               .vertex_count = 4,
                               .triangle_count = 2,
                               .base_color = {0.5f, 0.5f, 0.5f}};
    }
    setting s;
    uint32_t black, shared = 0;
    alp_scene *scene = NULL;
    alp_context *context = test_context(1);
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    open_setting(&s, scene, 16, 0.5f, 4, 1);
    assert_int_equal(alp_atlas_get_info(s.atlas).mode, ALP_ATLAS_KEEP);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        shared += s.texels.pixels[t][0] == 7;
    }
    assert_int_equal(shared, 16);
    hold_lookups(&s, 2.5, &black);
    assert_int_equal(black, 0);
    close_setting(&s);
}

/// A third of the texels has no light of its own, as inside other geometry. The nearest texel of
/// the chart replaces each; a chart without any is black.
TEST(texels_without_light_have_stand_ins)
{
    setting s;
    uint32_t black;
    open_setting(&s, make_ball(test_context(2), 24, 12), 256, 0.78f, 4, 3);
    const uint16_t *pixel = s.texels.pixels[0];
    const size_t place = alpi_lattice_pixel(&s.lattice, s.texels.pages[0], pixel[0], pixel[1]);
    assert_true(s.patches.patch_of[0] == ALPI_NONE && s.patches.places[place].texel != 0);
    hold_lookups(&s, 5.5, &black);
    assert_int_equal(black, 0);
    close_setting(&s);
    open_setting(&s, make_ball(test_context(2), 4, 2), 32, 0.01f, 4, 1);
    alpi_patches none;
    ASSERT_OK(s.context, alpi_patches_create(&s.lattice, s.atlas, s.lattice.order, 0, NULL, &none));
    for (uint32_t t = 0; t < s.scene->triangle_count; t++) {
        assert_int_equal(alpi_patches_find(&none, t, 0.3f, 0.3f), ALPI_NONE);
        assert_int_equal(find_cell(&none, t, 0.3f, 0.3f, false), ALPI_CELL_BLACK);
        assert_int_equal(find_cell(&s.patches, t, 0.3f, 0.3f, true), ALPI_CELL_BLACK);
    }
    alpi_patches_destroy(&none);
    alpi_patches_destroy(&none);
    close_setting(&s);
}

/// Each texel is in one patch. A patch has one chart, one square of the page, and its area.
TEST(blocks_hold_every_texel_once)
{
    static const uint32_t sides[] = {1, 2, 4};
    for (int i = 0; i < 3; i++) {
        setting s;
        double area = 0.0;
        uint32_t members = 0;
        open_setting(&s, make_ball(test_context(2), 24, 12), 97, 0.3f, sides[i], 5);
        const alpi_patches *p = &s.patches;
        for (uint32_t b = 0; b < p->patch_count; b++) {
            const uint32_t first = p->patch_texels[p->patch_first[b]];
            double sum = 0.0;
            assert_true(p->patch_first[b + 1] > p->patch_first[b]);
            for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1]; k++) {
                const uint32_t t = p->patch_texels[k];
                assert_int_equal(p->patch_of[t], b);
                assert_true(t % 5 != 0);
                assert_int_equal(s.texels.charts[t], s.texels.charts[first]);
                for (int d = 0; d < 2; d++) {
                    assert_int_equal(s.texels.pixels[t][d] / sides[i],
                                     s.texels.pixels[first][d] / sides[i]);
                }
                assert_true(k == p->patch_first[b] || p->patch_ends[k] >= p->patch_ends[k - 1]);
                sum += (double)s.texels.areas[t];
                members++;
            }
            assert_true(p->patch_ends[p->patch_first[b + 1] - 1] == 1.0f);
            ASSERT_NEAR(p->patch_areas[b], sum, 1e-6 * sum);
            area += sum;
        }
        assert_int_equal(members, s.texels.count - (s.texels.count + 4) / 5);
        assert_int_equal(p->patch_first[p->patch_count], members);
        assert_true(sides[i] > 1 || p->patch_count == members);
        assert_true(area > 0.0);
        close_setting(&s);
    }
}

/// Side of the patches of a texel's square: 4, 2 or 1 texels.
static uint32_t side_of(const setting *s, const uint8_t *proximity, uint32_t texel)
{
    const uint16_t *p = s->texels.pixels[texel];
    uint32_t side = 4;
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t t = alpi_lattice_texel(&s->lattice, s->texels.pages[texel],
                                              p[0] / 4 * 4 + i % 4, p[1] / 4 * 4 + i / 4);
        const uint8_t near = t != ALPI_NONE ? proximity[t] : ALPI_FAR;
        if ((t != ALPI_NONE && s->texels.valid[t] != 0) || near == ALPI_TOUCHING) {
            return 1;
        }
        side = near != ALPI_FAR ? 2 : side;
    }
    return side;
}

/// Patches near another surface have half the side. They are single texels if a surface touches one
/// of the texels, or one lies in a solid.
TEST(blocks_are_small_near_surfaces)
{
    setting s;
    alpi_patches patches;
    open_setting(&s, make_ball(test_context(2), 24, 12), 96, 0.3f, 4, 1);
    uint8_t *near = calloc(s.texels.count, 1);
    uint16_t *valid = calloc(s.texels.count, sizeof *valid);
    assert_true(near != NULL && valid != NULL);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        near[t] = t % 97 == 0 ? ALPI_NEAR : t % 89 == 0 ? ALPI_TOUCHING : ALPI_FAR;
        valid[t] = t % 113 == 0 ? 0xff : 0;
    }
    s.texels.valid = valid;
    ASSERT_OK(s.context, alpi_patches_create(&s.lattice, s.atlas, s.lattice.order, s.texels.count,
                                             near, &patches));
    uint32_t seen[5] = {0}, most[5] = {0};
    for (uint32_t b = 0; b < patches.patch_count; b++) {
        const uint32_t first = patches.patch_texels[patches.patch_first[b]];
        const uint32_t side = side_of(&s, near, first);
        const uint32_t members = patches.patch_first[b + 1] - patches.patch_first[b];
        for (uint32_t k = patches.patch_first[b]; k < patches.patch_first[b + 1]; k++) {
            const uint32_t t = patches.patch_texels[k];
            for (int d = 0; d < 2; d++) {
                assert_int_equal(s.texels.pixels[t][d] / side, s.texels.pixels[first][d] / side);
            }
        }
        seen[side]++;
        most[side] = members > most[side] ? members : most[side];
    }
    for (uint32_t side = 1; side <= 4; side *= 2) {
        assert_true(seen[side] > 0 && most[side] == side * side);
    }
    alpi_patches_destroy(&patches);
    s.texels.valid = NULL;
    free(near);
    free(valid);
    close_setting(&s);
}

/// Points of a patch fall on its texels in proportion to their areas.
TEST(blocks_are_placed_by_area)
{
    enum { POINTS = 1024 };
    static float square[POINTS][2];
    static alpi_receiver_point points[POINTS];
    setting s;
    open_setting(&s, make_ball(test_context(2), 8, 4), 64, 0.01f, 4, 1);
    const alpi_patches *p = &s.patches;
    const alpi_receivers receivers = alpi_patches_receivers(p);
    for (uint32_t i = 0; i < POINTS; i++) {
        const vec2 u = alpi_sample_2d(9, i);
        square[i][0] = u.x;
        square[i][1] = u.y;
    }
    assert_true(receivers.extended && receivers.count == p->patch_count && !p->two_sided);
    for (uint32_t b = 0; b < p->patch_count; b += 7) {
        vec3 mean = ZERO, wanted = ZERO;
        double size = 0.0;
        receivers.place(receivers.user, b, POINTS, (const float(*)[2])square, points);
        for (uint32_t i = 0; i < POINTS; i++) {
            mean = vec3_mad(mean, 1.0f / POINTS, points[i].position);
            ASSERT_NEAR(vec3_length(points[i].geometric_normal), 1.0, 1e-5);
        }
        for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1]; k++) {
            const uint32_t t = p->patch_texels[k];
            alpi_receiver_point inside[64];
            const alpi_receivers texels = alpi_texels_receivers(&s.texels);
            texels.place(texels.user, t, 64, (const float(*)[2])square, inside);
            for (int i = 0; i < 64; i++) {
                const double share = (double)s.texels.areas[t] / p->patch_areas[b] / 64.0;
                wanted = vec3_mad(wanted, (float)share, inside[i].position);
            }
        }
        size = sqrt(p->patch_areas[b]);
        ASSERT_NEAR(vec3_length(vec3_sub(mean, wanted)), 0.0, 0.05 * size);
    }
    close_setting(&s);
}

// --- materials -----------------------------------------------------------------------------------

/// A square with a picture of 2 × 2 pixels.
static alp_scene *make_picture(alp_context *context, alpi_alpha_mode mode)
{
    static const uint8_t pixels[4][4] = {
        {255, 255, 255, 255}, {0, 0, 0, 0}, {0, 0, 0, 0}, {255, 255, 255, 255}}; // a checker
    static const float uvs[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "picture");
    alpi_builder_surface(&b, "square", alpi_builder_material(&b, "square", HALF, ONE));
    alpi_builder_quad(&b, (const vec3[4]){{0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, 0, 0}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->uvs[0] = alpi_allocate(context, scene->vertex_count, sizeof *scene->uvs[0]);
    scene->images = alpi_allocate(context, 1, sizeof *scene->images);
    assert_true(scene->uvs[0] != NULL && scene->images != NULL);
    memcpy(scene->uvs[0], uvs, sizeof uvs);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){2, 2, 4, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    memcpy(alp_image_bytes(scene->images[0]), pixels, sizeof pixels);
    scene->materials[0].base_color_texture.image = 0;
    scene->materials[0].alpha_mode = mode;
    return scene;
}

/// One texel over all of the picture reflects half of the material's own ½. Where its alpha is a
/// mask, the half that is left is the brighter one: at a grid of 4 × 4 points the pixels' weights
/// are ¾ and ¼ both ways, ⅝ of white or ⅜, and those below ½ are cut. The texel's 16 points are
/// dealt out to its two triangles and lie a little off that grid.
TEST(pictures_count_by_their_mean)
{
    static const double wanted[2] = {0.25, 0.3125};
    for (int i = 0; i < 2; i++) {
        setting s;
        open_setting(&s, make_picture(test_context(2), i ? ALPI_ALPHA_MASK : ALPI_ALPHA_OPAQUE), 1,
                     0.5f, 4, 1);
        assert_int_equal(s.texels.count, 1);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(s.patches.reflectances[0][k], wanted[i], 0.02);
        }
        ASSERT_NEAR(s.patches.emissions[0], 1.0, 1e-6);
        close_setting(&s);
    }
}

/// In even light the reach of a cell is the side of its texel. Around a cell brighter by c times
/// the mean it is (c / .1)^(1/3) sides, from 1 to 8.
TEST(uneven_light_reaches_farther)
{
    setting s;
    open_setting(&s, make_ball(test_context(2), 8, 4), 64, 0.5f, 4, 1);
    const alpi_patches *p = &s.patches;
    float(*cells)[4] = p->cells + ALPI_CELL_FIRST;
    const uint32_t floor = alpi_patches_find(p, p->scene->triangle_count - 1, 0.3f, 0.3f);
    assert_true(floor != ALPI_NONE);
    static const float brighter[] = {0.0f, 0.05f, 2.7f, 1e6f};
    for (size_t i = 0; i < sizeof brighter / sizeof *brighter; i++) {
        for (uint32_t t = 0; t < s.texels.count; t++) {
            cells[t][0] = cells[t][1] = cells[t][2] = 0.5f;
        }
        cells[floor][1] += 1.5f * brighter[i];
        ASSERT_OK(s.context, alpi_patches_set_reach(p, &(alpi_task_progress){0}));
        const double contrast = (double)brighter[i] / (1.0 + (double)brighter[i] / s.texels.count);
        const double wanted = fmin(fmax(cbrt(contrast / 0.1), 1.0), 8.0);
        uint32_t longer = 0;
        for (uint32_t t = 0; t < s.texels.count; t++) {
            const uint16_t *at = s.texels.pixels[t], *of = s.texels.pixels[floor];
            const bool beside = s.texels.charts[t] == s.texels.charts[floor] &&
                                s.texels.pages[t] == s.texels.pages[floor] &&
                                abs(at[0] - of[0]) <= 1 && abs(at[1] - of[1]) <= 1;
            const double side = (double)alpi_texels_side(&s.texels, t);
            ASSERT_NEAR(cells[t][ALPI_CELL_SIDE], beside ? wanted * side : side, 1e-4 * side);
            longer += beside && wanted > 1.0;
        }
        assert_int_equal(longer, wanted > 1.0 ? 9 : 0);
    }
    for (uint32_t t = 0; t < s.texels.count; t++) { // all dark: unchanged
        cells[t][0] = cells[t][1] = cells[t][2] = 0.0f;
        cells[t][ALPI_CELL_SIDE] = 7.0f;
    }
    ASSERT_OK(s.context, alpi_patches_set_reach(p, &(alpi_task_progress){0}));
    assert_true(cells[floor][ALPI_CELL_SIDE] == 7.0f);
    close_setting(&s);
}

/// Backs have their own cells and receivers, turned over. Only a ray marks them as seen.
TEST(backs_are_other_cells)
{
    setting s;
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    open_setting(&s, test_mesh_scene(test_context(2), mesh, 1), 8, 0.5f, 4, 1);
    const alpi_receivers receivers = alpi_patches_receivers(&s.patches);
    const alpi_receivers texels = alpi_patches_texel_receivers(&s.patches);
    const float middle[1][2] = {{0.5f, 0.5f}};
    assert_true(s.patches.two_sided);
    assert_int_equal(receivers.count, 2 * s.patches.patch_count);
    assert_int_equal(texels.count, 2 * s.texels.count);
    for (int behind = 0; behind < 2; behind++) {
        const uint32_t texel = alpi_patches_find(&s.patches, 1, 0.3f, 0.4f);
        const uint8_t *seen = &s.patches.seen_backs[s.patches.patch_of[texel]];
        assert_int_equal(*seen, ALPI_BACK_UNSEEN);
        assert_int_equal(find_cell(&s.patches, 1, 0.3f, 0.4f, behind != 0),
                         ALPI_CELL_FIRST + texel + (behind ? s.texels.count : 0));
        assert_int_equal(*seen, behind ? ALPI_BACK_SEEN : ALPI_BACK_UNSEEN);
        for (int kind = 0; kind < 2; kind++) {
            const alpi_receivers *r = kind ? &texels : &receivers;
            alpi_receiver_point at;
            r->place(r->user, behind ? r->count / 2 : 0, 1, middle, &at);
            assert_true(at.geometric_normal.y == (behind ? -1.0f : 1.0f));
            assert_true(at.shading_normal.y == (behind ? -1.0f : 1.0f));
        }
    }
    close_setting(&s);
}

/// One worker and several make the same patches, order and places, on pages of odd size.
TEST(workers_change_no_block)
{
    enum { SIZE = 67 };
    static const uint32_t workers[2] = {1, 7};
    setting s[2];
    alp_atlas_options a = alp_atlas_options_default();
    a.size = SIZE;
    a.texels_per_metre = 14.0;
    a.max_angle = 0.3f;
    for (int i = 0; i < 2; i++) {
        open_on(&s[i], make_ball(test_context(workers[i]), 24, 12), &a, 4, 5);
    }
    const alpi_patches *p = &s[0].patches, *q = &s[1].patches;
    const uint32_t count = s[0].texels.count, patches = p->patch_count;
    assert_true(alp_atlas_get_info(s[0].atlas).pages >= 2);
    assert_int_equal(s[1].texels.count, count);
    assert_int_equal(q->patch_count, patches);
    assert_memory_equal(s[0].lattice.order, s[1].lattice.order, count * sizeof(uint32_t));
    assert_memory_equal(p->patch_of, q->patch_of, count * sizeof(uint32_t));
    assert_memory_equal(p->patch_first, q->patch_first, (patches + 1) * sizeof(uint32_t));
    assert_memory_equal(p->patch_areas, q->patch_areas, patches * sizeof(double));
    const uint32_t members = p->patch_first[patches];
    assert_memory_equal(p->patch_texels, q->patch_texels, members * sizeof(uint32_t));
    const size_t pixels = (size_t)SIZE * SIZE * alp_atlas_get_info(s[0].atlas).pages;
    assert_memory_equal(p->places, q->places, pixels * sizeof *p->places);
    assert_int_equal(members, count - (count + 4) / 5);
    uint8_t *ordered = calloc(count, 1);
    assert_non_null(ordered);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(ordered[s[0].lattice.order[i]]++, 0);
    }
    free(ordered);
    close_setting(&s[0]);
    close_setting(&s[1]);
}
