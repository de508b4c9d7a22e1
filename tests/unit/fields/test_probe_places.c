// SPDX-License-Identifier: MIT
// Places of probes: lattices and lists, probes on walls and in solids, points outside, and what is
// refused.
#include "field_scenes.h"

TEST_CONTEXT(2);

static const vec3 UP = {0.0f, 1.0f, 0.0f};

static alp_probe_options quick_options(float spacing)
{
    alp_probe_options o = alp_probe_options_default();
    o.spacing = spacing;
    o.atlas_size = 64;
    return o;
}

static alp_field *open_field(const alp_probes *probes, alp_probe_lookup lookup)
{
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_probes(probes, lookup, NULL, NULL, &field));
    return field;
}

// --- lattices ------------------------------------------------------------------------------------

TEST(a_lattice_is_centred_in_its_bounds)
{
    alp_scene *scene = field_room(context, (vec3){3.0f, 2.0f, 1.2f}, 0.5f, 1.0f);
    alp_probe_options o = quick_options(0.5f);
    alp_probes *probes = NULL;
    double last[3];
    o.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    const alp_probes_info info = alp_probes_get_info(probes);
    assert_int_equal(info.size[0], 6);
    assert_int_equal(info.size[1], 4);
    assert_int_equal(info.size[2], 3);
    assert_int_equal(info.count, 72);
    ASSERT_NEAR(info.origin[0], 0.25, 1e-6);
    ASSERT_NEAR(info.origin[1], 0.25, 1e-6);
    ASSERT_NEAR(info.origin[2], 0.1, 1e-6);
    alp_probes_position(probes, info.count - 1, last);
    ASSERT_NEAR(last[0], 2.75, 1e-6);
    ASSERT_NEAR(last[1], 1.75, 1e-6);
    ASSERT_NEAR(last[2], 1.1, 1e-6);
    assert_int_equal(info.rays, 384);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST(spacing_0_gives_about_4096_probes)
{
    alp_scene *scene = field_room(context, (vec3){3.0f, 2.0f, 1.2f}, 0.5f, 1.0f);
    alp_probe_options o = quick_options(0.0f);
    alp_probes *probes = NULL;
    o.rays = 384;
    o.bounces = 0;
    o.visibility = false;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    assert_in_range(alp_probes_get_info(probes).count, 3000, 5500);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

// --- rooms whose light is known ------------------------------------------------------------------

/// E of a furnace with albedo ½ and radiance 1 is 2π everywhere: near walls, on them, and, read
/// from the nearest probes, outside.
static void check_furnace(const alp_probes *probes, vec3 size, float inset)
{
    const double exact = 2.0 * FIELD_PI;
    alp_field *field = open_field(probes, ALP_LOOKUP_OURS);
    for (int i = 0; i < 64; i++) {
        const float a = (float)(i % 4) / 3.0f, b = (float)(i / 4 % 4) / 3.0f,
                    c = (float)(i / 16) / 3.0f;
        const vec3 inside = {inset + a * (size.x - 2.0f * inset),
                             inset + b * (size.y - 2.0f * inset),
                             inset + c * (size.z - 2.0f * inset)};
        const vec3 outside = {2.0f * inside.x - 0.5f * size.x, 2.0f * inside.y - 0.5f * size.y,
                              2.0f * inside.z - 0.5f * size.z};
        const vec3 n = field_tilted(0.05 * i, 0.7 * i);
        ASSERT_NEAR(field_read(field, inside, n).y, exact, 0.03 * exact);
        if (inset == 0.0f) {
            ASSERT_NEAR(field_read(field, outside, n).y, exact, 0.03 * exact);
        }
    }
    alp_field_destroy(field);
}

static void check_fit(float spacing, float margin, bool visibility, float inset)
{
    const vec3 size = {2.0f, 2.0f, 2.0f};
    alp_scene *scene = field_room(context, size, 0.5f, 1.0f);
    alp_probe_options o = quick_options(spacing);
    alp_probes *probes = NULL;
    for (int k = 0; k < 3; k++) {
        o.bounds_min[k] = -margin;
        o.bounds_max[k] = 2.0f + margin;
    }
    o.visibility = visibility;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    check_furnace(probes, size, inset);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST(a_box_fitted_to_the_air_of_a_room)
{
    check_fit(0.5f, 0.0f, true, 0.0f);
    check_fit(0.5f, 0.0f, false, 0.0f);
}

TEST(probes_exactly_on_walls)
{
    check_fit(1.0f, 0.5f, true, 0.0f); // at 0, 1 and 2
    check_fit(1.0f, 0.5f, false, 0.0f);
}

TEST(one_probe_on_an_axis)
{
    check_fit(2.0f, 0.0f, true, 0.0f); // one in all
    const vec3 size = {4.0f, 0.5f, 2.0f};
    alp_scene *scene = field_room(context, size, 0.5f, 1.0f);
    alp_probe_options o = quick_options(1.0f);
    alp_probes *probes = NULL;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    assert_int_equal(alp_probes_get_info(probes).size[1], 1);
    check_furnace(probes, size, 0.0f);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST(bounds_beyond_a_room)
{
    check_fit(0.75f, 1.3f, true,
              0.25f); // among the inner probes, where the black ones count nothing
}

// --- solids --------------------------------------------------------------------------------------

/// A glowing room of 4 m with a block in it.
static alp_scene *room_with_block(vec3 low, vec3 high)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "block");
    alpi_builder_surface(
        &b, "walls",
        alpi_builder_material(&b, "walls", (vec3){0.5f, 0.5f, 0.5f}, (vec3){1.0f, 1.0f, 1.0f}));
    alpi_builder_box(&b, (vec3){4.0f, 4.0f, 4.0f}, (vec3){0.0f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    alpi_builder_box(&b, low, high, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static bool is_within(const double p[3], vec3 low, vec3 high)
{
    return p[0] > (double)low.x && p[0] < (double)high.x && p[1] > (double)low.y &&
           p[1] < (double)high.y && p[2] > (double)low.z && p[2] < (double)high.z;
}

TEST(probes_in_solids_are_moved_or_filled)
{
    const vec3 low = {1.05f, 1.05f, 1.05f}, high = {2.95f, 2.95f, 2.95f};
    alp_scene *scene = room_with_block(low, high);
    alp_probe_options o = quick_options(0.5f);
    alp_probes *probes = NULL;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    const alp_probes_info info = alp_probes_get_info(probes);
    const uint8_t *states = alp_probes_states(probes);
    uint32_t moved = 0, filled = 0;
    for (uint32_t i = 0; i < info.count; i++) {
        double p[3];
        const uint32_t at[3] = {i % 8, i / 8 % 8, i / 64};
        alp_probes_position(probes, i, p);
        for (int k = 0; k < 3; k++) { // .45 of a cell along each axis
            ASSERT_NEAR(p[k], 0.25 + 0.5 * at[k], 0.45 * 0.5 + 1e-5);
        }
        if (states[i] <= ALP_PROBE_MOVED) {
            assert_false(is_within(p, low, high));
        } else {
            assert_true(is_within(p, low, high));
        }
        if (states[i] <= ALP_PROBE_FILLED) { // light of a furnace
            ASSERT_NEAR(field_coefficient(probes, i, 0)[1], 4.0 * sqrt(FIELD_PI), 0.1);
        } else {
            ASSERT_NEAR(field_coefficient(probes, i, 0)[1], 0.0, 0.0);
        }
        moved += states[i] == ALP_PROBE_MOVED;
        filled += states[i] == ALP_PROBE_FILLED;
    }
    assert_int_equal(moved, info.states[ALP_PROBE_MOVED]);
    assert_int_equal(moved, 64 - 8); // a shell of a block of 4 x 4 x 4, 20 cm deep
    assert_int_equal(filled + info.states[ALP_PROBE_INVALID], 8);
    check_furnace(probes, (vec3){4.0f, 4.0f, 4.0f}, 0.0f);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST(a_lattice_all_in_a_solid_is_black)
{
    alp_scene *scene = room_with_block((vec3){0.5f, 0.5f, 0.5f}, (vec3){3.5f, 3.5f, 3.5f});
    alp_probe_options o = quick_options(0.5f);
    alp_probes *probes = NULL;
    for (int k = 0; k < 3; k++) {
        o.bounds_min[k] = 1.25f;
        o.bounds_max[k] = 2.75f;
    }
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    const alp_probes_info info = alp_probes_get_info(probes);
    assert_int_equal(info.states[ALP_PROBE_INVALID], 27);
    ASSERT_NEAR(info.error, 0.0, 0.0);
    ASSERT_NEAR(info.mean, 0.0, 0.0);
    ASSERT_NEAR(info.interpolation, 0.0, 0.0);
    for (int lookup = 0; lookup < 2; lookup++) {
        alp_field *field = open_field(probes, (alp_probe_lookup)lookup);
        ASSERT_NEAR(field_read(field, (vec3){2.0f, 2.1f, 1.9f}, UP).x, 0.0, 0.0);
        ASSERT_NEAR(field_read(field, (vec3){0.2f, 0.1f, 0.3f}, UP).x, 0.0, 0.0);
        alp_field_destroy(field);
    }
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

/// A glowing room in x < 2 and a dark one beyond a wall, whose back part is filled by a block: a
/// gap of 2 cm parts the block from the wall.
static alp_scene *two_rooms(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 grey = {0.5f, 0.5f, 0.5f};
    alpi_builder_start(&b, context, "rooms");
    const uint32_t dark = alpi_builder_material(&b, "dark", grey, (vec3){0.0f, 0.0f, 0.0f});
    const uint32_t bright = alpi_builder_material(&b, "bright", grey, (vec3){1.0f, 1.0f, 1.0f});
    alpi_builder_surface(&b, "outside", dark);
    alpi_builder_box(&b, (vec3){-0.5f, -0.5f, -0.5f}, (vec3){5.5f, 2.5f, 2.5f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "bright", bright);
    alpi_builder_box(&b, (vec3){2.0f, 2.0f, 2.0f}, (vec3){0.0f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "dark", dark);
    alpi_builder_box(&b, (vec3){5.0f, 2.0f, 2.0f}, (vec3){2.1f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    alpi_builder_box(&b, (vec3){2.12f, 0.0f, 0.0f}, (vec3){3.6f, 2.0f, 2.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Probes in the block lie nearer to the bright room, but take the light of the dark one.
TEST(probes_in_solids_are_filled_from_what_they_see)
{
    alp_scene *scene = two_rooms();
    alp_probe_options o = quick_options(0.8f); // at .1, .9, 1.7, 2.5, 3.3, 4.1, 4.9
    alp_probes *probes = NULL;
    uint32_t filled = 0;
    o.bounds_min[0] = -0.3f;
    o.bounds_max[0] = 5.3f;
    o.bounds_max[1] = o.bounds_max[2] = 2.0f;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    assert_int_equal(alp_probes_get_info(probes).size[0], 7);
    for (uint32_t i = 0; i < alp_probes_get_info(probes).count; i++) {
        double p[3];
        alp_probes_position(probes, i, p);
        const bool bright = p[0] < 2.0;
        ASSERT_NEAR(field_coefficient(probes, i, 0)[1], bright ? 4.0 * sqrt(FIELD_PI) : 0.0, 0.1);
        filled += alp_probes_states(probes)[i] == ALP_PROBE_FILLED;
    }
    assert_int_equal(filled, 9); // those at 2.5; those at 3.3 are moved
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

// --- lists ---------------------------------------------------------------------------------------

TEST(a_list_holds_the_light_of_its_places)
{
    static const float places[][3] = {{0.5f, 0.6f, 0.7f}, {1.5f, 1.4f, 1.3f}, {4.0f, 1.0f, 1.0f}};
    alp_scene *scene = two_rooms();
    alp_probe_options o = quick_options(-1.0f); // not read
    alp_probes *probes = NULL;
    alp_field *three = NULL;
    o.spacing = 0.0f;
    o.positions = places;
    o.position_count = 3;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    const alp_probes_info info = alp_probes_get_info(probes);
    assert_true(info.is_list);
    assert_int_equal(info.count, 3);
    ASSERT_NEAR(info.spacing[0], 0.0, 0.0);
    alp_field *field = open_field(probes, ALP_LOOKUP_OURS);
    for (uint32_t i = 0; i < 3; i++) {
        double p[3];
        alp_probes_position(probes, i, p);
        ASSERT_NEAR(p[0], places[i][0], 1e-6);
        const double exact = i < 2 ? 2.0 * FIELD_PI : 0.0;
        ASSERT_NEAR(field_read(field, vec3_load(places[i]), UP).x, exact, 0.1);
    }
    alp_field_destroy(field);
    assert_int_equal(alp_field_create_probes(probes, ALP_LOOKUP_THREE, NULL, NULL, &three),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_null(three);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

// --- what is refused -----------------------------------------------------------------------------

static void refuse(const alp_scene *scene, const alp_probe_options *o, alp_result code,
                   const char *word)
{
    alp_probes *probes = (alp_probes *)context;
    assert_int_equal(alp_probes_bake(scene, o, &probes), code);
    assert_null(probes);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("no '%s' in: %s", word, alp_context_message(context));
    }
}

TEST(options_out_of_range_are_refused)
{
    static const float bad[][3] = {{0.5f, 0.5f, 0.5f}, {0.5f, NAN, 0.5f}};
    const alp_result invalid = ALP_ERROR_INVALID_ARGUMENT;
    alp_scene *scene = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 1.0f);
    alp_scene *unlit = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 0.0f);
    const float spacings[] = {-1.0f, NAN, INFINITY};
    for (int i = 0; i < 3; i++) {
        const alp_probe_options o = quick_options(spacings[i]);
        refuse(scene, &o, invalid, "spacing");
    }
    alp_probe_options o = quick_options(0.5f);
    o.rays = 383;
    refuse(scene, &o, invalid, "rays");
    o.rays = 1572865;
    refuse(scene, &o, invalid, "rays");
    o = quick_options(0.5f);
    o.basis = (alp_probe_basis)3;
    refuse(scene, &o, invalid, "basis");
    o = quick_options(0.5f);
    o.struct_size = 1;
    refuse(scene, &o, invalid, "_default()");
    o = quick_options(0.5f);
    o.bounds_min[0] = 2.0f;
    o.bounds_max[0] = 1.0f;
    refuse(scene, &o, invalid, "bounds");
    o.bounds_min[0] = NAN;
    refuse(scene, &o, invalid, "bounds");
    o = quick_options(0.5f);
    o.positions = bad;
    o.position_count = 2;
    refuse(scene, &o, invalid, "position 1");
    o.position_count = 0;
    refuse(scene, &o, invalid, "no positions");
    o = quick_options(0.5f);
    refuse(unlit, &o, invalid, "light");
    alp_scene_destroy(scene);
    alp_scene_destroy(unlit);
}

TEST(a_billion_probes_are_refused_with_their_memory)
{
    alp_scene *scene = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 1.0f);
    alp_probe_options o = quick_options(0.001f);
    refuse(scene, &o, ALP_ERROR_LIMIT, "620 GB");
    refuse(scene, &o, ALP_ERROR_LIMIT, "1e+09 probes");
    o.spacing = 1e-30f;
    refuse(scene, &o, ALP_ERROR_LIMIT, "GB");
    alp_scene_destroy(scene);
}
