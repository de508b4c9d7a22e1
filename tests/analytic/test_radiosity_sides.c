// SPDX-License-Identifier: MIT
// Where radiosity must find no light at all: in the dark, behind thin walls, behind sheets.
#include "test_radiant.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>

static const vec3 ZERO = {0, 0, 0}, HALF = {0.5f, 0.5f, 0.5f};
TEST_CONTEXT(2);

static void put_lamp(alp_scene *scene, vec3 position)
{
    test_lit_set_lamps(scene,
                       &(alpi_light){.kind = ALP_LIGHT_POINT,
                                     .color = {1, 1, 1},
                                     .intensity = 1.0f,
                                     .position = position,
                                     .range = INFINITY},
                       1);
}

static bool is_black(const float v[3])
{
    return v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f;
}

/// Light of one side of a texel as rays see it.
static const float *cell_of(const test_radiant *r, uint32_t texel, alpi_side side)
{
    const alpi_patches *p = &r->solution.patches;
    return p->cells[alpi_patches_cell(p, texel, side)];
}

// --- darkness ------------------------------------------------------------------------------------

TEST(a_closed_room_without_light_is_black)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    test_radiant r;
    const test_radiant_options o = test_radiant_default();
    alpi_builder_start(&b, context, "dark");
    alpi_builder_surface(&b, "room", alpi_builder_material(&b, "room", HALF, ZERO));
    alpi_builder_box(&b, (vec3){1, 1, 1}, ZERO, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    put_lamp(scene, (vec3){2, 2, 2}); // outside
    test_radiant_open(scene, &o, &r);
    test_radiant_gather(&r, 64);
    for (uint32_t t = 0; t < r.texels.count; t++) {
        assert_true(is_black(r.values[t].mean) && is_black(r.values[t].variance));
        assert_true(is_black(cell_of(&r, t, ALPI_FRONT)));
    }
    assert_true(r.solution.energy.emitted == 0.0 && r.solution.energy.absorbed == 0.0);
    assert_int_equal(r.solution.passes, 1);
    test_radiant_close(&r);
}

/// A box with a wall in its middle, at x = 0: one double-sided quad, or a slab of 1 mm. Floor and
/// ceiling are parted where the wall stands, so that no texel lies on both sides of it.
static alp_scene *make_parted(bool slab)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const unsigned sides = ALPI_FACE_ALL & ~(unsigned)(ALPI_FACE_LEFT | ALPI_FACE_RIGHT);
    const float d = slab ? 0.5e-3f : 0.0f;
    alpi_builder_start(&b, context, "parted");
    alpi_builder_surface(&b, "lit", alpi_builder_material(&b, "lit", HALF, ZERO));
    alpi_builder_box(&b, (vec3){-d, 1, 1}, (vec3){-1, 0, 0}, sides | ALPI_FACE_LEFT);
    if (slab) {
        alpi_builder_box(&b, (vec3){-d, 1, 1}, (vec3){-1, 0, 0}, ALPI_FACE_RIGHT);
    }
    alpi_builder_surface(&b, "dark", alpi_builder_material(&b, "dark", HALF, ZERO));
    alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){d, 0, 0}, sides | ALPI_FACE_RIGHT);
    if (slab) {
        alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){d, 0, 0}, ALPI_FACE_LEFT);
    } else {
        alpi_builder_surface(&b, "wall", alpi_builder_material(&b, "wall", HALF, ZERO));
        alpi_builder_quad(&b, (const vec3[4]){{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    if (!slab) {
        scene->materials[2].double_sided = true;
    }
    put_lamp(scene, (vec3){-0.4f, 0.6f, 0.3f});
    return scene;
}

TEST(thin_walls_let_nothing_through)
{
    for (int slab = 0; slab < 2; slab++) {
        test_radiant r;
        const test_radiant_options o = test_radiant_default();
        uint32_t dark = 0, walls = 0;
        test_radiant_open(make_parted(slab != 0), &o, &r);
        test_radiant_gather(&r, 128);
        for (uint32_t t = 0; t < r.texels.count; t++) {
            const uint32_t surface = test_radiant_surface(&r, t);
            if (surface == 1) {
                assert_true(is_black(r.values[t].mean));
                assert_true(is_black(cell_of(&r, t, ALPI_FRONT)));
                dark++;
            } else if (surface == 0) {
                assert_true(r.values[t].mean[0] > 0.0f);
            } else { // the wall turns its front away from the lamp's half or towards it
                const bool front = !is_black(cell_of(&r, t, ALPI_FRONT));
                assert_true(front != !is_black(cell_of(&r, t, ALPI_BACK)));
                assert_true(!front); // the quad's front looks towards +x, into the dark
                assert_true(is_black(r.values[t].mean));
                walls++;
            }
        }
        assert_true(dark > 900 && (walls > 100) == (slab == 0));
        test_radiant_close(&r);
    }
}

/// The same where floor, ceiling and sides go on under the wall: only texels that it crosses, and
/// patches of them, can mix both halves.
TEST(walls_across_charts)
{
    for (uint32_t side = 1; side <= 4; side += 3) {
        alpi_builder b;
        alp_scene *scene = NULL;
        test_radiant r;
        test_radiant_options o = test_radiant_default();
        double sums[2] = {0.0}, near = 0.0;
        o.side = side;
        alpi_builder_start(&b, context, "crossed");
        alpi_builder_surface(&b, "room", alpi_builder_material(&b, "room", HALF, ZERO));
        alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){-1, 0, 0}, ALPI_FACE_ALL);
        alpi_builder_surface(&b, "wall", alpi_builder_material(&b, "wall", HALF, ZERO));
        alpi_builder_quad(&b, (const vec3[4]){{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        scene->materials[1].double_sided = true;
        put_lamp(scene, (vec3){-0.4f, 0.6f, 0.3f});
        test_radiant_open(scene, &o, &r);
        test_radiant_gather(&r, 128);
        for (uint32_t t = 0; t < r.texels.count; t++) {
            const vec3 p = test_radiant_position(&r, t);
            if (test_radiant_surface(&r, t) == 0) {
                const double e = (double)r.texels.areas[t] * (double)r.values[t].mean[1];
                sums[p.x > 0.1f] += p.x > 0.1f || p.x < 0.0f ? e : 0.0;
                near += p.x >= 0.0f && p.x <= 0.1f ? e : 0.0;
            }
        }
        printf(
            "accuracy: a wall across charts, patches of %u: %.1e of a half's light is behind it, "
            "%.1e in the texels that it crosses\n",
            side, sums[1] / sums[0], near / sums[0]);
        // A texel of 4 cm that the wall crosses is as bright on its dark side as on the other, and
        // shines: so do those along the four edges of the wall.
        assert_true(sums[1] < (side == 1 ? 0.01 : 0.02) * sums[0] && sums[1] > 0.0);
        test_radiant_close(&r);
    }
}

// --- sheets --------------------------------------------------------------------------------------

/// A floor, and a larger sheet above it, a lamp over or under the sheet.
static alp_scene *make_sheet(bool faces_down, bool double_sided, float lamp)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "sheet");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", HALF, ZERO));
    alpi_builder_quad(
        &b,
        (const vec3[4]){{-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, {-0.5f, 0, -0.5f}});
    alpi_builder_surface(&b, "sheet", alpi_builder_material(&b, "sheet", HALF, ZERO));
    const vec3 c[4] = {{-2, 1, -2}, {2, 1, -2}, {2, 1, 2}, {-2, 1, 2}}; // faces down
    alpi_builder_quad(&b, faces_down ? c : (const vec3[4]){c[3], c[2], c[1], c[0]});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[1].double_sided = double_sided;
    put_lamp(scene, (vec3){0.1f, lamp, 0.2f});
    return scene;
}

/// The mean of what is bounced to the floor.
static double bounced_to_floor(alp_scene *scene, uint32_t hemicube)
{
    test_radiant r;
    test_radiant_options o = test_radiant_default();
    double sum = 0.0;
    o.rays = 256;
    o.hemicube = hemicube;
    o.direct_samples = 64;
    test_radiant_open(scene, &o, &r);
    test_radiant_gather(&r, 512);
    for (uint32_t t = 0; t < r.texels.count; t++) {
        sum += test_radiant_surface(&r, t) == 0
                   ? (double)r.texels.areas[t] *
                         ((double)r.values[t].mean[1] - (double)r.solution.direct[t].mean[1])
                   : 0.0;
    }
    test_radiant_close(&r);
    return sum;
}

/// Each side of a double-sided sheet reflects its own light: none of what falls on the other, and
/// as much as a sheet that faces there. A single-sided one is black from behind.
TEST(sides_keep_their_light_apart)
{
    for (uint32_t cube = 0; cube <= 16; cube += 16) {
        for (int down = 0; down < 2; down++) {
            assert_true(bounced_to_floor(make_sheet(down != 0, true, 2.0f), cube) == 0.0);
        }
        const double single = bounced_to_floor(make_sheet(true, false, 0.5f), cube);
        const double front = bounced_to_floor(make_sheet(true, true, 0.5f), cube);
        const double back = bounced_to_floor(make_sheet(false, true, 0.5f), cube);
        assert_true(bounced_to_floor(make_sheet(false, false, 0.5f), cube) == 0.0);
        printf("light under a sheet: single-sided %.5f, double-sided front %.5f, back %.5f\n",
               single, front, back);
        assert_true(single > 0.05 && front == single);
        ASSERT_NEAR(back, front, 0.01 * front); // other random points: 200 patches of 256 rays
    }
}
