// SPDX-License-Identifier: MIT
// Faults that are planted in geometry: each is found at its object and nothing else is, and the
// same meshes mended are well.
#include "test_support.h"

#include "scene/scene.h"

#include <math.h>
#include <stdio.h>

enum { MESH_LIMIT = 8 };

/// Meshes that are built triangle by triangle, without shared vertices and without normals of their
/// own, so that a scene of them has one finding of itself: `no-normals` and `no-uvs`.
typedef struct model {
    float positions[MESH_LIMIT][600][3], normals[MESH_LIMIT][600][3];
    uint32_t indices[MESH_LIMIT][600];
    uint32_t vertices[MESH_LIMIT];
    bool double_sided[MESH_LIMIT];
    uint32_t count;
    bool one_object; // its meshes are primitives of one
} model;

static void put(model *m, uint32_t mesh, vec3 a, vec3 b, vec3 c)
{
    const vec3 corners[3] = {a, b, c};
    const vec3 normal = vec3_triangle_normal(a, b, c, (vec3){0.0f, 1.0f, 0.0f});
    for (int k = 0; k < 3; k++) {
        const uint32_t v = m->vertices[mesh]++;
        assert_true(v < 600);
        m->indices[mesh][v] = v;
        vec3_store(m->positions[mesh][v], corners[k]);
        vec3_store(m->normals[mesh][v], normal);
    }
    m->count = mesh + 1 > m->count ? mesh + 1 : m->count;
}

static void put_quad(model *m, uint32_t mesh, vec3 from, vec3 along, vec3 across)
{
    const vec3 far = vec3_add(vec3_add(from, along), across);
    put(m, mesh, from, vec3_add(from, along), far);
    put(m, mesh, from, far, vec3_add(from, across));
}

/// A box that looks outwards, or inwards.
static void put_box(model *m, uint32_t mesh, vec3 low, float side, bool inwards)
{
    const vec3 axes[3] = {{side, 0, 0}, {0, side, 0}, {0, 0, side}};
    for (int k = 0; k < 3; k++) {
        const vec3 a = axes[inwards ? (k + 2) % 3 : (k + 1) % 3];
        const vec3 b = axes[inwards ? (k + 1) % 3 : (k + 2) % 3];
        put_quad(m, mesh, low, b, a);
        put_quad(m, mesh, vec3_add(low, axes[k]), a, b);
    }
}

static alp_scene *make(alp_context *context, const model *m)
{
    alp_mesh meshes[MESH_LIMIT];
    for (uint32_t i = 0; i < m->count; i++) {
        meshes[i] = (alp_mesh){.vertex_count = m->vertices[i],
                               .positions = m->positions[i][0],
                               .normals = m->normals[i][0],
                               .triangle_count = m->vertices[i] / 3,
                               .indices = m->indices[i],
                               .double_sided = m->double_sided[i],
                               .base_color = {0.5f, 0.5f, 0.5f}};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, m->count, &scene));
    for (uint32_t i = 0; i < m->count && m->one_object; i++) {
        scene->surfaces[i].node = scene->surfaces[i].mesh = 0;
        scene->surfaces[i].primitive = i;
    }
    return scene;
}

/// Fails unless the model has one finding besides its lack of coordinates: of the kind, at the
/// surface and its triangle; with MESSAGE none. @return its value
static double has_only(const model *m, alp_finding_kind kind, uint32_t surface, uint32_t triangle)
{
    double value = (double)NAN;
    alp_context *context = test_context(1);
    alp_scene *scene = make(context, m);
    alp_diagnosis *d = NULL;
    uint32_t others = 0;
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        if (f.kind == ALP_FINDING_NO_UVS) {
            continue;
        }
        if (f.kind != kind) {
            fail_msg("%s: %s: %s", f.code, f.name, f.what);
        }
        others++;
        value = f.value;
        assert_int_equal(f.place, ALP_PLACE_SURFACE);
        assert_int_equal(f.index, surface);
        assert_true(f.spot.known && f.seen[0] != '\0' && f.todo[0] != '\0');
        assert_int_equal(f.spot.surface, surface);
        assert_true(triangle == ALPI_NONE || f.spot.triangle == triangle);
        assert_true(isnan(f.spot.uv[0]));
        char name[64];
        snprintf(name, sizeof name, "spot-%s", f.code);
        assert_string_equal(alp_diagnosis_picture_name(d, 1), name);
    }
    assert_int_equal(others, kind != ALP_FINDING_MESSAGE);
    assert_int_equal(alp_diagnosis_picture_count(d), 1 + others);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return value;
}

/// The same for COPLANAR alone, of two triangles: far from the origin and where boxes reach into
/// each other there are other findings.
/// @param surface −1 = none has it
static double has_coplanar(const model *m, int surface)
{
    alp_context *context = test_context(1);
    alp_scene *scene = make(context, m);
    alp_diagnosis *d = NULL;
    double value = (double)NAN;
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        if (f.kind != ALP_FINDING_COPLANAR) {
            continue;
        }
        assert_int_equal(f.index, surface);
        assert_int_equal(f.count, 2);
        assert_true(f.spot.known && (int)f.spot.surface == surface);
        value = f.value;
    }
    assert_int_equal(isnan(value), surface < 0);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return value;
}

static model *new_model(void)
{
    return test_calloc(1, sizeof(model));
}

// --- T-junctions ---------------------------------------------------------------------------------

/// A long quad of two triangles at z ≤ 0, before it two short ones that meet at x = `cut`, turned
/// about the edge by an angle; the second one of them is moved off the edge.
static model *make_strips(float cut, float angle, float off)
{
    model *m = new_model();
    const vec3 before = {0.0f, sinf(angle), cosf(angle)}, moved = vec3_scale(before, off);
    put_quad(m, 0, (vec3){0, 0, 0}, (vec3){4, 0, 0}, (vec3){0, 0, -1});
    put_quad(m, 0, before, (vec3){cut, 0, 0}, vec3_scale(before, -1.0f));
    put_quad(m, 0, vec3_add(vec3_add(before, (vec3){cut, 0, 0}), moved), (vec3){4.0f - cut, 0, 0},
             vec3_scale(before, -1.0f));
    return m;
}

TEST(vertices_within_edges)
{
    static const struct {
        float cut, angle, off;
        bool found;
    } cases[] = {
        {1.7f, 0.0f, 0.0f, true},   // flat
        {1.7f, 1.57f, 0.0f, true},  // a corner
        {1.7f, 3.1f, 0.0f, false},  // folded back upon it
        {0.02f, 0.0f, 0.0f, false}, // half a hundredth from the end
        {1.7f, 0.0f, 0.003f, true}, // the first of the two is there still
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model *m = make_strips(cases[i].cut, cases[i].angle, cases[i].off);
        // Triangle 0 holds the long edge (0, 0, 0) to (4, 0, 0).
        has_only(m, cases[i].found ? ALP_FINDING_T_JUNCTIONS : ALP_FINDING_MESSAGE, 0, 0);
        test_free(m);
    }
}

TEST(a_mended_edge_is_well)
{
    model *m = new_model();
    const vec3 cut = {1.7f, 0, 0}, end = {4, 0, 0}, back = {0, 0, -1}, far = {4, 0, -1};
    put(m, 0, (vec3){0, 0, 0}, cut, back); // the long quad, fanned
    put(m, 0, cut, far, back);
    put(m, 0, cut, end, far);
    put_quad(m, 0, (vec3){0, 0, 1}, cut, (vec3){0, 0, -1});
    put_quad(m, 0, (vec3){1.7f, 0, 1}, vec3_sub(end, cut), (vec3){0, 0, -1});
    has_only(m, ALP_FINDING_MESSAGE, 0, 0);
    test_free(m);
}

/// Faces of two materials: of one object they have a T-junction, in whichever the long edge is; two
/// objects are two things that touch.
TEST(materials_and_objects_that_touch)
{
    for (int i = 0; i < 4; i++) {
        const uint32_t whole = (uint32_t)i / 2, parts = 1 - whole;
        model *m = new_model();
        m->one_object = i % 2 == 0;
        put_quad(m, whole, (vec3){0, 0, 0}, (vec3){4, 0, 0}, (vec3){0, 0, -1});
        put_quad(m, parts, (vec3){0, 0, 1}, (vec3){1.7f, 0, 0}, (vec3){0, 0, -1});
        put_quad(m, parts, (vec3){1.7f, 0, 1}, (vec3){2.3f, 0, 0}, (vec3){0, 0, -1});
        has_only(m, m->one_object ? ALP_FINDING_T_JUNCTIONS : ALP_FINDING_MESSAGE, whole, 0);
        test_free(m);
    }
}

/// Where materials meet in whole edges, nothing is open.
TEST(materials_that_meet_are_well)
{
    model *m = new_model();
    m->one_object = true;
    put_quad(m, 0, (vec3){0, 0, 0}, (vec3){4, 0, 0}, (vec3){0, 0, -1});
    put_quad(m, 1, (vec3){0, 0, 1}, (vec3){4, 0, 0}, (vec3){0, 0, -1});
    has_only(m, ALP_FINDING_MESSAGE, 0, 0);
    test_free(m);
}

// --- one plane -----------------------------------------------------------------------------------

/// A quad of 4 m by 1 m, and one like it that is moved, of another object or of the same; far from
/// the origin ones of 256 m, as floats are 2^-4 m apart there. Each may be off by four such steps.
TEST(faces_in_one_plane)
{
    static const struct {
        float from, size;
        vec3 by;
        bool turned, found;
        double share; // of the second one
    } cases[] = {
        {0.0f, 1.0f, {2.0f, 0, 0}, false, true, 0.5},
        {0.0f, 1.0f, {2.0f, 0, 0.25f}, false, true, 0.375},
        {0.0f, 1.0f, {2.0f, 4e-6f, 0}, false, true, 0.5}, // twice 6 m · 2^-21 = 5.7e-6 m
        {0.0f, 1.0f, {2.0f, 8e-6f, 0}, false, false, 0.0},
        {0.0f, 1.0f, {2.0f, 0, 0}, true, false, 0.0},    // looks down
        {0.0f, 1.0f, {4.0f, 0, 0}, false, false, 0.0},   // beside it
        {0.0f, 1.0f, {3.999f, 0, 0}, false, false, 0.0}, // by less than a thousandth of 4.1 m
        {1e6f, 64.0f, {2.0f, 0, 0}, false, true, 0.5},
        {1e6f, 64.0f, {2.0f, 0x1p-9f, 0}, false, true, 0.5}, // 2^-3 m
        {1e6f, 64.0f, {2.0f, 0x1p-5f, 0}, false, false, 0.0},
    };
    for (size_t i = 0; i < 2 * (sizeof cases / sizeof *cases); i++) {
        const float x = cases[i / 2].from, size = cases[i / 2].size;
        const vec3 from = {x, x, x}, along = {4 * size, 0, 0}, across = {0, 0, -size};
        const vec3 moved = vec3_mad(from, size, cases[i / 2].by);
        const uint32_t mesh = i % 2;
        model *m = new_model();
        put_quad(m, 0, from, along, across);
        put_quad(m, mesh, moved, cases[i / 2].turned ? across : along,
                 cases[i / 2].turned ? along : across);
        const double value = has_coplanar(m, cases[i / 2].found ? (int)mesh : -1);
        if (cases[i / 2].found) { // of one object it is a share of both
            ASSERT_NEAR(value, cases[i / 2].share / (mesh == 0 ? 2.0 : 1.0), 1e-6);
        }
        test_free(m);
    }
}

/// Two boxes reach into each other, with their tops in one plane; or below the top of a third.
TEST(overlaps_that_nobody_sees)
{
    for (int i = 0; i < 2; i++) {
        model *m = new_model();
        put_box(m, 0, (vec3){0, 0, 0}, 2.0f, false);
        put_box(m, 1, (vec3){1.8f, 0.5f, 0.2f}, 1.5f, false);
        if (i == 1) {
            put_box(m, 2, (vec3){-1, 1.7f, -1}, 5.0f, false);
        }
        const double value = has_coplanar(m, i == 0 ? 1 : -1);
        if (i == 0) { // of six sides of 1.5 m
            ASSERT_NEAR(value, 0.2 * 1.5 / (6.0 * 1.5 * 1.5), 1e-6);
        }
        test_free(m);
    }
}

// --- inside --------------------------------------------------------------------------------------

/// A box of 0.6 m, of which some is in one of 2 m: there its sixth side is, and as much of four.
TEST(boxes_in_boxes)
{
    static const struct {
        float inside; // metres
        bool found;
    } cases[] = {{1.0f, true},  {0.5f, true},  {0.4f, true},
                 {0.3f, false}, {0.2f, false}, {-0.5f, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model *m = new_model();
        put_box(m, 0, (vec3){0, 0, 0}, 2.0f, false);
        put_box(m, 1, (vec3){2.0f - cases[i].inside, 0.7f, 0.7f}, 0.6f, false);
        const double value =
            has_only(m, cases[i].found ? ALP_FINDING_BURIED : ALP_FINDING_MESSAGE, 1, ALPI_NONE);
        const double depth = fmin((double)cases[i].inside / 0.6, 1.0);
        const double share = depth < 1.0 ? (1.0 + 4.0 * depth) / 6.0 : 1.0;
        // 2.16 m² of 26.16 have 676 points of 8192: four standard errors, at most.
        if (cases[i].found) {
            ASSERT_NEAR(value, share, 4.0 * sqrt(share * (1.0 - share) / 676.0) + 1e-9);
        }
        test_free(m);
    }
}

/// A room that looks inwards holds what is in it; nothing is buried.
TEST(rooms_are_well)
{
    model *m = new_model();
    put_box(m, 0, (vec3){0, 0, 0}, 2.0f, true);
    put_box(m, 1, (vec3){0.7f, 0.1f, 0.7f}, 0.6f, false);
    has_only(m, ALP_FINDING_MESSAGE, 0, 0);
    test_free(m);
}

// --- sheets --------------------------------------------------------------------------------------

/// A wall before a niche: out there it is light, in here it is dark. The niche's floor, back and
/// roof are of another, single-sided object.
static model *make_niche(bool sheet, bool thick)
{
    model *m = new_model();
    put_quad(m, 0, (vec3){-1, 0, -1}, (vec3){0, 0, 1}, (vec3){3, 0, 0});       // floor
    put_quad(m, 0, (vec3){-1, 0, -1}, (vec3){3, 0, 0}, (vec3){0, 1.2f, 0});    // back
    put_quad(m, 0, (vec3){-1, 1.2f, 0.0f}, (vec3){0, 0, -1}, (vec3){3, 0, 0}); // roof, from below
    put_quad(m, 1, (vec3){0, 0.1f, 0}, (vec3){1, 0, 0}, (vec3){0, 1, 0});      // looks out
    if (thick) {
        put_quad(m, 1, (vec3){1, 0.1f, -0.1f}, (vec3){-1, 0, 0}, (vec3){0, 1, 0}); // looks in
    }
    m->double_sided[0] = m->double_sided[1] = sheet;
    m->double_sided[0] = false;
    return m;
}

TEST(sheets_between_light_and_dark)
{
    model *m = make_niche(true, false);
    has_only(m, ALP_FINDING_THIN_WALL, 1, ALPI_NONE);
    test_free(m);
    m = make_niche(false, true);
    has_only(m, ALP_FINDING_MESSAGE, 1, ALPI_NONE);
    test_free(m);
    m = new_model(); // a sheet in the open has the same sky on both sides
    put_quad(m, 0, (vec3){0, 0, 0}, (vec3){1, 0, 0}, (vec3){0, 1, 0});
    m->double_sided[0] = true;
    has_only(m, ALP_FINDING_MESSAGE, 0, ALPI_NONE);
    test_free(m);
    m = new_model(); // into a closed shell looks nobody
    put_box(m, 0, (vec3){0, 0, 0}, 1.0f, false);
    m->double_sided[0] = true;
    has_only(m, ALP_FINDING_MESSAGE, 0, ALPI_NONE);
    test_free(m);
}

// --- scale ---------------------------------------------------------------------------------------

TEST(objects_of_another_unit)
{
    static const struct {
        float side;
        bool found;
    } cases[] = {{0.5f, false}, {150.0f, false}, {240.0f, true}, {1.5e-4f, true}, {3e-4f, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model *m = new_model();
        for (uint32_t k = 0; k < 5; k++) {
            put_box(m, k, (vec3){2.0f * (float)k, 0, 0}, 0.2f + 0.01f * (float)k, false);
        }
        put_box(m, 5, (vec3){0, 0, 3.0f}, cases[i].side, false);
        has_only(m, cases[i].found ? ALP_FINDING_SCALE : ALP_FINDING_MESSAGE, 5, 0);
        test_free(m);
    }
}

// --- all -----------------------------------------------------------------------------------------

/// What has hardly anything to look at.
TEST(scenes_of_one_triangle)
{
    static const float ends[] = {1.0f, 1e-6f, 1e-18f, 1e14f, NAN, INFINITY};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        alp_context *context = test_context(1);
        model *m = new_model();
        put(m, 0, (vec3){0, 0, 0}, (vec3){ends[i], 0, 0}, (vec3){0, 0, -ends[i]});
        put(m, 1, (vec3){0, 1, 0}, (vec3){0, 1, 1}, (vec3){0, 2, 0});
        alp_scene *scene = make(context, m);
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        for (uint32_t k = 0; k < alp_diagnosis_finding_count(d); k++) {
            const alp_finding f = alp_diagnosis_get_finding(d, k);
            assert_true(f.kind == ALP_FINDING_NO_UVS || f.kind == ALP_FINDING_SIZE);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        test_free(m);
    }
}

/// Many pieces of a soup in one place: not each of them is held against all others.
TEST_SLOW(soups_take_no_square_of_time)
{
    enum { PIECES = 100000 };
    alp_context *context = test_context(1);
    float(*positions)[3] = test_calloc(3 * (size_t)PIECES, sizeof *positions);
    uint32_t *indices = test_calloc(3 * (size_t)PIECES, sizeof *indices);
    for (uint32_t i = 0; i < 3 * PIECES; i++) {
        const uint32_t hash = (i / 3 * 2654435761u) >> 8; // Knuth's multiplicative hash
        indices[i] = i;
        positions[i][0] = (float)(hash % 256) / 256.0f + (i % 3 == 1 ? 1e-4f : 0.0f);
        positions[i][1] = (float)(hash / 256 % 256) / 256.0f + (i % 3 == 2 ? 1e-4f : 0.0f);
        positions[i][2] = (float)(hash / 65536) / 256.0f;
    }
    positions[0][0] = 1e7f; // a long edge makes the mean long, and all others lie in one cell
    const alp_mesh mesh = {.vertex_count = 3 * PIECES,
                           .positions = positions[0],
                           .triangle_count = PIECES,
                           .indices = indices,
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    alp_diagnosis *d = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d)); // 10¹⁰ looks would be minutes
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    test_free(positions);
    test_free(indices);
}

/// Double-sided boxes that are wound inwards are shown from outside, unless they are rooms.
TEST(boxes_inside_out)
{
    model *m = new_model();
    m->double_sided[0] = m->double_sided[1] = true;
    put_box(m, 0, (vec3){0, 0, 0}, 1.0f, false);
    put_box(m, 1, (vec3){3, 0, 0}, 1.0f, false);
    has_only(m, ALP_FINDING_MESSAGE, 0, 0);
    memset(m->vertices, 0, sizeof m->vertices);
    put_box(m, 0, (vec3){0, 0, 0}, 1.0f, false);
    put_box(m, 1, (vec3){3, 0, 0}, 1.0f, true);
    put_quad(m, 1, (vec3){3, 2, 0}, (vec3){1, 0, 0}, (vec3){0, 0, 2});
    ASSERT_NEAR(has_only(m, ALP_FINDING_INSIDE_OUT, 1, 0), 0.75, 1e-6); // 6 m² of 8
    put_box(m, 2, (vec3){3.2f, 0.2f, 0.2f}, 0.5f, false);
    has_only(m, ALP_FINDING_MESSAGE, 0, 0);
    test_free(m);
}

TEST(any_number_of_workers_finds_the_same)
{
    char texts[2][400];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(i == 0 ? 1 : 5);
        model *m = make_niche(true, false);
        alp_scene *scene = make(context, m);
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        const alp_finding f = alp_diagnosis_get_finding(d, 0);
        snprintf(texts[i], sizeof texts[i], "%s %a %a %u", f.what, f.value, (double)f.spot.at[0],
                 f.spot.triangle);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        test_free(m);
    }
    assert_string_equal(texts[0], texts[1]);
}

TEST(every_allocation_may_fail)
{
    int left = 0, failures = 0;
    alp_context *context = test_context_failing(&left);
    model *m = make_strips(1.7f, 0.0f, 0.0f);
    left = 10000;
    alp_scene *scene = make(context, m);
    alp_diagnosis *d = NULL;
    for (left = 0; alp_scene_diagnose(scene, NULL, &d) != ALP_OK; left = failures) {
        assert_null(d);
        assert_true(++failures < 1000);
    }
    assert_true(failures > 20);
    alp_diagnosis_destroy(d);
    left = 10000;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    test_free(m);
}
