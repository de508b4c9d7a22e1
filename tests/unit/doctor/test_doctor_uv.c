// SPDX-License-Identifier: MIT
// The doctor's look at UV sets: shares of closed form, and the same verdict as --atlas keep.
#include "test_support.h"

#include "base/random.h"
#include "scene/scene.h"

#include <math.h>

/// Two squares of 4 m² side by side, each a rectangle of the set: low u, low v, high u, high v.
typedef struct rectangles {
    float of[2][4];
} rectangles;

static const uint32_t TRIANGLES[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const float UP[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};

static alp_scene *make(alp_context *context, const rectangles *r)
{
    float positions[2][4][3], uvs[2][4][2];
    alp_mesh meshes[2];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 4; k++) {
            const bool right = k == 1 || k == 2, far = k >= 2;
            positions[i][k][0] = 5.0f * (float)i + (right ? 2.0f : 0.0f);
            positions[i][k][1] = 0.0f;
            positions[i][k][2] = far ? -2.0f : 0.0f;
            uvs[i][k][0] = r->of[i][right ? 2 : 0];
            uvs[i][k][1] = r->of[i][far ? 3 : 1];
        }
        meshes[i] = (alp_mesh){.vertex_count = 4,
                               .positions = positions[i][0],
                               .normals = UP[0],
                               .uvs = isfinite(r->of[i][0]) ? uvs[i][0] : NULL,
                               .triangle_count = 2,
                               .indices = TRIANGLES[0],
                               .base_color = {0.5f, 0.5f, 0.5f}};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    return scene;
}

static bool has(const alp_diagnosis *d, alp_finding_kind kind)
{
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        if (alp_diagnosis_get_finding(d, i).kind == kind) {
            return true;
        }
    }
    return false;
}

/// What --atlas keep makes of the scene.
static bool keep_takes(const alp_scene *scene)
{
    alp_atlas_options o = alp_atlas_options_default();
    o.mode = ALP_ATLAS_KEEP;
    alp_atlas *atlas = NULL;
    const alp_result result = alp_atlas_create(scene, &o, &atlas);
    assert_true(result == ALP_OK || result == ALP_ERROR_INVALID_DATA);
    alp_atlas_destroy(atlas);
    return result == ALP_OK;
}

/// Shares hold to a unit of 1/65536 in each of the texels at the border of a rectangle.
static const double SHARE = 1e-4;

/// @param kind -1 = none
static void has_of_sets_only(const alp_diagnosis *d, int kind)
{
    static const alp_finding_kind kinds[] = {
        ALP_FINDING_NO_UVS,     ALP_FINDING_UV_MISSING, ALP_FINDING_UV_OUTSIDE,
        ALP_FINDING_UV_FLAT,    ALP_FINDING_UV_OVERLAP, ALP_FINDING_UV_SHARED,
        ALP_FINDING_UV_PADDING, ALP_FINDING_UV_DENSITY, ALP_FINDING_UV_MIPS,
        ALP_FINDING_UV_TINY,    ALP_FINDING_UV_STRETCH};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        assert_int_equal(has(d, kinds[k]), (int)kinds[k] == kind);
    }
}

TEST(sets_are_judged)
{
    const float gap = 4.0f / 1024.0f;
    static const int NONE = -1;
    const struct {
        rectangles set;
        int kind; // the finding, NONE = none
        bool holds;
        double coverage, overlap;
        uint32_t islands, touching;
    } cases[] = {
        {{{{0, 0, 0.5f - gap, 1}, {0.5f, 0, 1, 1}}}, NONE, true, 1.0 - 4.0 / 1024.0, 0, 2, 0},
        {{{{0, 0, 0.5f, 1}, {0.5f, 0, 1, 1}}}, ALP_FINDING_UV_PADDING, true, 1.0, 0, 2, 2},
        {{{{0, 0, 0.5f, 0.5f}, {0.25f, 0.25f, 0.75f, 0.75f}}},
         ALP_FINDING_UV_OVERLAP,
         false,
         0.4375,
         1.0 / 7.0,
         2,
         2},
        {{{{0, 0, 0.5f, 1}, {0.75f, 0, 1.5f, 1}}}, ALP_FINDING_UV_OUTSIDE, false, 0.5, 0, 2, 0},
        {{{{0, 0, 0.5f, 1}, {0.75f, 0.5f, 0.75f, 0.5f}}}, ALP_FINDING_UV_FLAT, false, 0.5, 0, 2, 0},
        {{{{0, 0, 0.5f, 1}, {NAN, 0, 1, 1}}}, ALP_FINDING_UV_MISSING, false, 0.5, 0, 1, 0},
        {{{{0, 0, 0.9f, 0.9f}, {0.95f, 0.95f, 1.0f, 1.0f}}},
         ALP_FINDING_UV_DENSITY,
         true,
         0.8125,
         0,
         2,
         0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, &cases[i].set);
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        assert_int_equal(alp_diagnosis_uv_set_count(d), 2);
        const alp_uv_set_info u = alp_diagnosis_get_uv_set(d, 1);
        assert_int_equal(u.set, 1);
        assert_int_equal(u.holds_bake, cases[i].holds);
        assert_int_equal(u.holds_bake, u.reason[0] == '\0');
        assert_int_equal(u.holds_bake, keep_takes(scene));
        ASSERT_NEAR(u.coverage, cases[i].coverage, SHARE);
        ASSERT_NEAR(u.overlap, cases[i].overlap, SHARE);
        assert_int_equal(u.islands, cases[i].islands);
        assert_int_equal(u.touching_islands, cases[i].touching);
        has_of_sets_only(d, cases[i].kind);
        if (cases[i].kind == (int)ALP_FINDING_UV_DENSITY) { // 0.9 over 0.05, in single precision
            ASSERT_NEAR(u.density_ratio, 18.0, 18.0 * 1e-5);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// The finding of a kind.
static alp_finding find(const alp_diagnosis *d, alp_finding_kind kind)
{
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        if (alp_diagnosis_get_finding(d, i).kind == kind) {
            return alp_diagnosis_get_finding(d, i);
        }
    }
    return alp_diagnosis_get_finding(NULL, 0);
}

static alp_diagnosis *diagnose(const alp_scene *scene, uint32_t page_size)
{
    alp_diagnosis_options o = alp_diagnosis_options_default();
    alp_diagnosis *d = NULL;
    o.page_size = page_size;
    ASSERT_OK(scene->context, alp_scene_diagnose(scene, &o, &d));
    return d;
}

/// Columns of texels between two islands, side by side and one above the other, and the levels that
/// they hold.
TEST_SLOW(space_between_islands)
{
    static const struct {
        float texels; // on a page of 1024
        uint32_t page, free;
        int kind;
    } cases[] = {{0, 1024, 0, ALP_FINDING_UV_PADDING},
                 {1, 1024, 1, ALP_FINDING_UV_MIPS},
                 {2, 1024, 2, -1},
                 {1, 2048, 2, -1},
                 {2, 512, 1, ALP_FINDING_UV_MIPS},
                 {64, 1024, 64, -1}};
    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        const size_t k = i / 2;
        const float gap = cases[k].texels / 1024.0f;
        const rectangles beside = {{{0, 0, 0.5f - gap, 0.5f}, {0.5f, 0, 1, 0.5f}}};
        const rectangles above = {{{0, 0, 0.5f, 0.5f - gap}, {0, 0.5f, 0.5f, 1}}};
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, i % 2 == 0 ? &beside : &above);
        alp_diagnosis *d = diagnose(scene, cases[k].page);
        assert_int_equal(alp_diagnosis_get_uv_set(d, 1).free_texels, cases[k].free);
        has_of_sets_only(d, cases[k].kind);
        if (cases[k].kind >= 0) { // the spot lies at the gap
            const alp_finding f = find(d, (alp_finding_kind)cases[k].kind);
            assert_true(f.spot.known);
            ASSERT_NEAR(f.spot.uv[i % 2], 0.5, 2.0 / 512.0);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Rectangles of whole texels anywhere on a page: the larger of what is free along u and along v.
TEST(space_between_any_islands)
{
    enum { PAGE = 64, PAIRS = 60 };
    for (uint32_t i = 0, key = 1; i < PAIRS; i++) {
        rectangles r;
        int free = 0;
        do {
            for (int k = 0; k < 4; k++) { // of each axis and rectangle: low < high
                const int one = (int)(alpi_hash32(key++) % (PAGE + 1));
                const int other = (int)(alpi_hash32(key++) % PAGE);
                const int high = other >= one ? other + 1 : other;
                r.of[k / 2][k % 2] = (float)(one < high ? one : high) / PAGE;
                r.of[k / 2][k % 2 + 2] = (float)(one < high ? high : one) / PAGE;
            }
            const float *a = r.of[0], *b = r.of[1];
            const float u = fmaxf(a[0] - b[2], b[0] - a[2]), v = fmaxf(a[1] - b[3], b[1] - a[3]);
            free = (int)(fmaxf(u, v) * PAGE);
        } while (free <= 0);
        alp_context *context = test_context(1);
        alp_scene *scene = make(context, &r);
        alp_diagnosis *d = diagnose(scene, PAGE);
        assert_int_equal(alp_diagnosis_get_uv_set(d, 1).free_texels, free);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Squares of 2 m as rectangles of the set with sides of 1 : r have √((r + 1/r) / 2).
TEST(islands_that_are_stretched)
{
    static const struct {
        float ratio;
        bool found;
    } cases[] = {{1.0f, false}, {7.0f, false}, {9.0f, true}, {20.0f, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const float r = cases[i].ratio;
        alp_context *context = test_context(1);
        alp_scene *scene =
            make(context, &(rectangles){{{0, 0, 0.3f, 0.3f}, {0.32f, 0.0f, 0.95f, 0.63f / r}}});
        alp_diagnosis *d = diagnose(scene, 1024);
        const double stretch = sqrt(0.5 * ((double)r + 1.0 / (double)r));
        ASSERT_NEAR(alp_diagnosis_get_uv_set(d, 1).stretch, stretch, 1e-5 * stretch); // floats
        has_of_sets_only(d, cases[i].found ? (int)ALP_FINDING_UV_STRETCH : -1);
        if (cases[i].found) {
            const alp_finding f = find(d, ALP_FINDING_UV_STRETCH);
            assert_int_equal(f.spot.surface, 1);
            assert_non_null(strstr(f.what, "mesh 1"));
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// A patch of .04 m² beside a floor of 4 m² in an island of a quarter of a texel, which a page of
/// twice the side gives a whole one.
TEST_WITH_CONTEXT(islands_below_a_texel, 1)
{
    const float side = 0.5f / 1024.0f;
    alp_scene *scene = make(
        context, &(rectangles){{{0, 0, 0.5f, 0.5f}, {0.75f, 0.75f, 0.75f + side, 0.75f + side}}});
    for (uint32_t v = 0; v < 4; v++) {
        float *p = scene->positions[scene->surfaces[1].first_vertex + v];
        p[0] = 5.0f + 0.1f * (p[0] - 5.0f);
        p[2] *= 0.1f;
    }
    scene->area = 4.04;
    alp_diagnosis *d = diagnose(scene, 1024);
    has_of_sets_only(d, ALP_FINDING_UV_TINY);
    const alp_finding f = find(d, ALP_FINDING_UV_TINY);
    assert_int_equal(f.count, 1);
    ASSERT_NEAR(f.value, 0.04 / 4.04, 1e-6);
    assert_int_equal(f.spot.surface, 1);
    assert_non_null(strstr(f.what, "a page of 2048"));
    alp_diagnosis_destroy(d);
    d = diagnose(scene, 2048);
    has_of_sets_only(d, -1);
    assert_int_equal(alp_diagnosis_get_uv_set(d, 1).tiny_islands, 0);
    alp_diagnosis_destroy(d);
    alp_diagnosis_options o = alp_diagnosis_options_default();
    o.page_size = 0;
    d = NULL;
    assert_int_equal(alp_scene_diagnose(scene, &o, &d), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(nodes_of_one_mesh_share, 1)
{
    alp_scene *scene = make(context, &(rectangles){{{0, 0, 1, 1}, {0, 0, 1, 1}}});
    alp_diagnosis *d = NULL;
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
    assert_true(has(d, ALP_FINDING_UV_OVERLAP));
    assert_false(has(d, ALP_FINDING_UV_SHARED));
    alp_diagnosis_destroy(d);
    scene->surfaces[1].mesh = scene->surfaces[0].mesh;
    ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
    assert_false(has(d, ALP_FINDING_UV_OVERLAP));
    assert_true(has(d, ALP_FINDING_UV_SHARED));
    ASSERT_NEAR(alp_diagnosis_get_uv_set(d, 1).shared, 1.0, 0.0);
    alp_diagnosis_destroy(d);
    alp_scene_destroy(scene);
}

TEST(any_number_of_workers_finds_the_same)
{
    static const uint32_t workers[] = {1, 2, 7};
    alp_uv_set_info first = {0};
    for (int i = 0; i < 3; i++) {
        alp_context *context = test_context(workers[i]);
        alp_scene *scene =
            make(context, &(rectangles){{{0, 0, 0.51f, 0.97f}, {0.3f, 0.1f, 0.77f, 0.93f}}});
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        const alp_uv_set_info u = alp_diagnosis_get_uv_set(d, 1);
        first = i == 0 ? u : first;
        assert_true(u.coverage == first.coverage && u.overlap == first.overlap);
        assert_int_equal(u.overlapping_triangles, first.overlapping_triangles);
        assert_int_equal(u.touching_islands, first.touching_islands);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
