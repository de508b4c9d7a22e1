// SPDX-License-Identifier: MIT
// Very many triangles in one plane and place: the doctor looks at some of their pairs, asks of some
// whether they are seen, and says that it is not all.
#include "test_scenes.h"

#include "doctor/doctor_pairs.h"

#include <string.h>

/// Sheets of 1 m upon each other, each a little larger than the one before: all of them overlap all
/// others. With a box round them nobody sees them.
static void add_stack(test_mesh *mesh, uint32_t sheets, bool boxed)
{
    for (uint32_t i = 0; i < sheets; i++) {
        const double side = 1.0 + 1e-5 * i;
        const uint32_t a = test_mesh_vertex(mesh, 0.0, 0.0, 0.0);
        const uint32_t b = test_mesh_vertex(mesh, side, 0.0, 0.0);
        test_mesh_triangle(mesh, a, b, test_mesh_vertex(mesh, 0.0, 0.0, -side));
    }
    if (boxed) {
        const double x[3] = {3, 0, 0}, y[3] = {0, 3, 0}, z[3] = {0, 0, 3};
        test_mesh_quad(mesh, (double[]){-1, -1, -2}, x, z);
        test_mesh_quad(mesh, (double[]){-1, -1, -2}, z, y);
        test_mesh_quad(mesh, (double[]){-1, -1, -2}, y, x);
        test_mesh_quad(mesh, (double[]){-1, 2, -2}, z, x);
        test_mesh_quad(mesh, (double[]){2, -1, -2}, y, z);
        test_mesh_quad(mesh, (double[]){-1, -1, 1}, x, y);
    }
}

static alp_scene *make_stack(alp_context *context, uint32_t sheets, bool boxed)
{
    test_mesh *mesh = test_mesh_start();
    add_stack(mesh, sheets, boxed);
    return test_mesh_scene(context, mesh, 0);
}

/// @return what the one COPLANAR finding says, "" where there is none
static const char *coplanar_in(const alp_diagnosis *d)
{
    const char *what = "";
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        what = f.kind == ALP_FINDING_COPLANAR ? f.what : what;
    }
    return what;
}

static alp_result count_pair(void *user, uint32_t a, uint32_t b)
{
    assert_true(a < b);
    ++*(uint64_t *)user;
    return ALP_OK;
}

TEST(stacks_take_no_square_of_time)
{
    // Of 50,000 sheets there are 1.2·10⁹ pairs; 16 are of the two leaves that the search ends with.
    static const uint32_t sheets[] = {1000, 50000};
    for (int i = 0; i < 2; i++) {
        const uint64_t n = sheets[i], pairs = n * (n - 1) / 2;
        const uint64_t limit = ALPI_DOCTOR_PAIRS_LEAST + ALPI_DOCTOR_PAIRS_EACH * n;
        alp_context *context = test_context(1);
        alp_scene *scene = make_stack(context, sheets[i], false);
        uint64_t count = 0;
        bool all = i == 1;
        ASSERT_OK(context, alpi_doctor_visit_pairs(scene, count_pair, &count, &all));
        assert_int_equal(all, i == 0);
        assert_true(i == 0 ? count == pairs : count >= limit && count < limit + 16);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Overlaps beyond those whose sight is asked are not told: 181 sheets have 16290, 182 have 16471.
/// Where something is told, it says that it is not all.
TEST_SLOW(many_overlaps_are_told_in_part)
{
    static const struct {
        uint32_t sheets;
        bool boxed;
        const char *begins;
    } cases[] = {{181, false, "180 of 181 tri"},
                 {182, false, "at least "},
                 {181, true, ""},
                 {400, true, ""},
                 {50000, false, "at least "}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = make_stack(context, cases[i].sheets, cases[i].boxed);
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        const char *what = coplanar_in(d), *begins = cases[i].begins;
        if (strncmp(what, begins, strlen(begins)) != 0 ||
            (begins[0] == '\0') != (what[0] == '\0')) {
            fail_msg("%u sheets: %s", cases[i].sheets, what);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

/// Pairs of sheets that lie upon each other in the open, at x and beyond.
static void add_pairs(test_mesh *mesh, uint32_t pairs, double x)
{
    for (uint32_t i = 0; i < pairs; i++) {
        for (int k = 0; k < 2; k++) {
            const double side = 1.0 + 0.125 * k, left = x + 2.0 * i;
            const uint32_t a = test_mesh_vertex(mesh, left, 0.0, 0.0);
            const uint32_t b = test_mesh_vertex(mesh, left + side, 0.0, 0.0);
            test_mesh_triangle(mesh, a, b, test_mesh_vertex(mesh, left, 0.0, -side));
        }
    }
}

/// What is seen is told, however many overlaps nobody sees, wherever it is found among them. A pair
/// that is half of its surface has more weight than any of 79,800 in a box; of 64 like those in
/// theirs, each is asked with a chance of .2, and none once in 10⁶.
TEST(the_hidden_do_not_use_up_the_looks)
{
    for (int i = 0; i < 4; i++) {
        test_mesh *mesh = test_mesh_start();
        add_stack(mesh, 400, true);
        const uint32_t hidden = mesh->triangle_count;
        add_pairs(mesh, i < 2 ? 1 : 64, i % 2 == 0 ? -200.0 : 10.0);
        const uint32_t first = i < 2 ? hidden : mesh->triangle_count; // or all in one surface
        alp_mesh meshes[2] = {{.name = "box",
                               .positions = mesh->positions[0],
                               .indices = mesh->triangles[0],
                               .vertex_count = mesh->vertex_count,
                               .triangle_count = first}};
        meshes[1] = meshes[0];
        meshes[1].indices = mesh->triangles[hidden];
        meshes[1].triangle_count = mesh->triangle_count - first;
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, i < 2 ? 2 : 1, &scene));
        alp_diagnosis *d = NULL;
        ASSERT_OK(context, alp_scene_diagnose(scene, NULL, &d));
        assert_true(strncmp(coplanar_in(d), "at least ", 9) == 0);
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
