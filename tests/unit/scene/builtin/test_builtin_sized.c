// SPDX-License-Identifier: MIT
// The scenes made of closed solids: windows, atrium, terrain. As many triangles as asked for, each
// solid closed and facing outside, things where they should stand, settings read or refused.
#include "test_support.h"

#include "scene/builtin/builtin_atrium.h"
#include "scene/builtin/builtin_terrain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static alp_scene *create(alp_context *context, const char *name)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builtin_create(context, name, &scene));
    return scene;
}

// --- closed --------------------------------------------------------------------------------------

typedef struct place {
    float position[3];
    uint32_t vertex;
} place;

typedef struct edge {
    uint32_t low, high; // welded vertices
    int way;            // +1 from low to high
} edge;

static int compare_places(const void *left, const void *right)
{
    const place *a = left, *b = right;
    for (int k = 0; k < 3; k++) {
        if (a->position[k] != b->position[k]) {
            return a->position[k] < b->position[k] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_edges(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->low != b->low) {
        return a->low < b->low ? -1 : 1;
    }
    return a->high != b->high ? (a->high < b->high ? -1 : 1) : 0;
}

/// Vertices of a surface that lie in one place get one number.
static uint32_t *weld(const alp_scene *scene, const alpi_surface *s)
{
    place *places = malloc(s->vertex_count * sizeof *places);
    uint32_t *welded = malloc(s->vertex_count * sizeof *welded);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        memcpy(places[v].position, scene->positions[s->first_vertex + v], sizeof(float[3]));
        places[v].vertex = v;
    }
    qsort(places, s->vertex_count, sizeof *places, compare_places);
    uint32_t first = 0;
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        first = i > 0 && compare_places(&places[i - 1], &places[i]) == 0 ? first : i;
        welded[places[i].vertex] = places[first].vertex;
    }
    free(places);
    return welded;
}

static void assert_edges_are_shared(const alp_scene *scene, const alpi_surface *s,
                                    const uint32_t *welded)
{
    size_t count = (size_t)3 * s->triangle_count;
    edge *edges = malloc(count * sizeof *edges);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = scene->triangles[s->first_triangle + i / 3];
        uint32_t a = welded[t[i % 3] - s->first_vertex];
        uint32_t b = welded[t[(i + 1) % 3] - s->first_vertex];
        edges[i] = a < b ? (edge){a, b, 1} : (edge){b, a, -1};
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0, next = 0; i < count; i = next) {
        int sum = 0;
        for (next = i; next < count && compare_edges(&edges[i], &edges[next]) == 0; next++) {
            sum += edges[next].way;
        }
        if (next - i != 2 || sum != 0) {
            fail_msg("%s: %s: an edge of %zu triangles", scene->name, s->name, next - i);
        }
    }
    free(edges);
}

static uint32_t find_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/// Each solid of the surface encloses a positive volume, taken about one of its own corners.
static uint32_t assert_volumes(const alp_scene *scene, const alpi_surface *s,
                               const uint32_t *welded)
{
    uint32_t *parent = malloc(s->vertex_count * sizeof *parent), solids = 0;
    double *volume = calloc(s->vertex_count, sizeof *volume);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        parent[v] = v;
    }
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const uint32_t *t = scene->triangles[s->first_triangle + i];
        for (int k = 1; k < 3; k++) {
            uint32_t a = find_root(parent, welded[t[0] - s->first_vertex]);
            parent[find_root(parent, welded[t[k] - s->first_vertex])] = a;
        }
    }
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        uint32_t root =
            find_root(parent, welded[scene->triangles[s->first_triangle + i][0] - s->first_vertex]);
        vec3 c[3], origin = vec3_load(scene->positions[s->first_vertex + root]);
        alpi_triangle_corners(scene, s->first_triangle + i, c);
        vec3 a = vec3_sub(c[0], origin), b = vec3_sub(c[1], origin), d = vec3_sub(c[2], origin);
        volume[root] += (double)vec3_dot(a, vec3_cross(b, d)) / 6.0;
    }
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        if (parent[v] == v && welded[v] == v) {
            solids++;
            if (!(volume[v] > 1e-7)) {
                fail_msg("%s: %s: a solid of %g m³", scene->name, s->name, volume[v]);
            }
        }
    }
    free(parent);
    free(volume);
    return solids;
}

TEST_WITH_CONTEXT(every_solid_is_closed_and_faces_outside, 1)
{
    static const struct {
        const char *name;
        uint32_t solids; // at least
    } CASES[] = {{"windows", 20},
                 {"atrium", 500},
                 {"atrium,triangles=20000", 300},
                 {"atrium,triangles=200000", 2000},
                 {"terrain", 200},
                 {"terrain,triangles=5000", 30},
                 {"terrain,triangles=150000,trees=1000", 2000}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        alp_scene *scene = create(context, CASES[n].name);
        uint32_t solids = 0;
        assert_int_equal(scene->usable_count, scene->triangle_count);
        for (uint32_t i = 0; i < scene->surface_count; i++) {
            const alpi_surface *s = &scene->surfaces[i];
            uint32_t *welded = weld(scene, s);
            assert_edges_are_shared(scene, s, welded);
            solids += assert_volumes(scene, s, welded);
            free(welded);
        }
        if (solids < CASES[n].solids) {
            fail_msg("%s: only %u solids", CASES[n].name, solids);
        }
        alp_scene_destroy(scene);
    }
}

// --- how many, how large -------------------------------------------------------------------------

static void assert_count(alp_context *context, const char *name, uint32_t wanted)
{
    char full[64];
    snprintf(full, sizeof full, "%s,triangles=%u", name, wanted);
    alp_scene *scene = create(context, full);
    double ratio = (double)scene->triangle_count / wanted;
    if (fabs(ratio - 1.0) > 0.15) {
        fail_msg("%s has %u triangles", full, scene->triangle_count);
    }
    assert_int_equal(scene->usable_count, scene->triangle_count);
    alp_scene_destroy(scene);
}

/// The range is promised to 15 %: a shape cannot be cut into two and a half.
TEST_WITH_CONTEXT(as_many_triangles_as_asked_for, 1)
{
    static const uint32_t ATRIUM[] = {20000, 23000, 31000, 50000, 77000, 123456, 300000, 1000000};
    static const uint32_t TERRAIN[] = {5000,  6000,  7000,  8000,   9500,   12000,
                                       20000, 33000, 60000, 200000, 1000000};
    for (size_t i = 0; i < sizeof ATRIUM / sizeof *ATRIUM; i++) {
        assert_count(context, "atrium", ATRIUM[i]);
    }
    for (size_t i = 0; i < sizeof TERRAIN / sizeof *TERRAIN; i++) {
        assert_count(context, "terrain", TERRAIN[i]);
    }
    static const uint32_t TREES[] = {0, 1, 300};
    for (size_t i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "terrain,trees=%u", TREES[i]);
        assert_count(context, name, 100000);
    }
    alp_scene *scene = create(context, "atrium");
    assert_in_range(scene->triangle_count, 42500, 57500);
    alp_scene_destroy(scene);
}

static void assert_near_bounds(const alp_scene *scene, const double low[3], const double high[3],
                               double tolerance)
{
    alp_scene_info info = alp_scene_get_info(scene);
    for (int k = 0; k < 3; k++) {
        ASSERT_NEAR(info.bounds_min[k], low[k], tolerance);
        ASSERT_NEAR(info.bounds_max[k], high[k], tolerance);
    }
}

TEST_WITH_CONTEXT(the_size_stays_where_triangles_grow, 1)
{
    static const char *const NAMES[] = {"atrium,triangles=20000", "atrium",
                                        "atrium,triangles=400000"};
    for (int i = 0; i < 3; i++) { // the parapet's coping is a curve: a few centimetres
        alp_scene *scene = create(context, NAMES[i]);
        assert_near_bounds(scene, (const double[3]){-11.9, -0.6, -8.7},
                           (const double[3]){11.9, 12.86, 8.7}, 0.07);
        alp_scene_destroy(scene);
    }
    alp_scene *scene = create(context, "terrain,triangles=5000");
    alp_scene_info info = alp_scene_get_info(scene);
    for (int k = 0; k < 3; k += 2) {
        ASSERT_NEAR(info.bounds_min[k], -120.0, 1e-6);
        ASSERT_NEAR(info.bounds_max[k], 120.0, 1e-6);
    }
    assert_true(info.bounds_max[1] > 15.0f && info.bounds_max[1] < 60.0f);
    alp_scene_destroy(scene);
}

// --- what stands where ---------------------------------------------------------------------------

static const alpi_surface *find_surface(const alp_scene *scene, const char *name)
{
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        if (strcmp(scene->surfaces[i].name, name) == 0) {
            return &scene->surfaces[i];
        }
    }
    fail_msg("no surface \"%s\"", name);
    return NULL;
}

/// The numbers that builtin_windows.c states: where the sun is, how bright, how wide.
TEST_WITH_CONTEXT(the_sun_is_as_stated, 1)
{
    alp_scene *scene = create(context, "windows");
    const alpi_surface *sun = find_surface(scene, "sun");
    vec3 middle = {0.0f, 0.0f, 0.0f};
    for (uint32_t v = 0; v < sun->vertex_count; v++) {
        middle = vec3_mad(middle, 1.0f / (float)sun->vertex_count,
                          vec3_load(scene->positions[sun->first_vertex + v]));
    }
    ASSERT_NEAR(vec3_length(middle), 15.0, 1e-3);
    ASSERT_NEAR(asin((double)middle.y / 15.0) * 180.0 / ALPI_PI, 33.0, 0.01);
    ASSERT_NEAR(atan2(-(double)middle.x, -(double)middle.z) * 180.0 / ALPI_PI, 25.0, 0.01);
    for (uint32_t v = 0; v < sun->vertex_count; v++) {
        vec3 p = vec3_load(scene->positions[sun->first_vertex + v]);
        ASSERT_NEAR(vec3_length(vec3_sub(p, middle)), 0.2, 1e-4);
    }
    const float *emission = scene->materials[sun->material].emission;
    ASSERT_NEAR((double)emission[0] * ALPI_PI * (0.2 / 15.0) * (0.2 / 15.0), 16.8, 0.05);
    uint32_t emitters = 0;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        emitters += scene->materials[i].emission[0] > 0.0f ? 1 : 0;
    }
    assert_int_equal(emitters, 1); // nothing else shines
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(houses_and_trees_stand_on_the_ground, 1)
{
    static const uint32_t CELLS[] = {22, 40, 90, 400};
    for (size_t n = 0; n < sizeof CELLS / sizeof *CELLS; n++) {
        alpi_ground *ground = NULL;
        ASSERT_OK(context, alpi_terrain_make_ground(context, CELLS[n], &ground));
        const alpi_house *houses = alpi_terrain_houses();
        for (int i = 0; i < ALPI_HOUSE_COUNT; i++) {
            const alpi_house *h = &houses[i];
            float c = cosf(h->turn), s = sinf(h->turn);
            for (int corner = 0; corner < 4; corner++) {
                float x = 0.5f * (corner & 1 ? h->width : -h->width);
                float z = 0.5f * (corner & 2 ? h->length : -h->length);
                float height =
                    alpi_terrain_height(ground, h->x + c * x + s * z, h->z + c * z - s * x);
                float above = height - alpi_terrain_pad(h); // foot at −2 m, door at .25 m
                float most = CELLS[n] >= 90 ? 0.25f : 2.0f; // cells of 6 m cannot be level
                if (!(above > -1.9f && above < most)) {
                    fail_msg("%u cells: house %d: ground at %g m", CELLS[n], i, (double)above);
                }
            }
        }
        for (uint32_t tree = 0; tree < 2000; tree++) {
            vec3 foot = alpi_terrain_tree(ground, tree);
            assert_true(fabsf(foot.x) < 120.0f && fabsf(foot.z) < 120.0f);
            assert_true(CELLS[n] < 40 || foot.y > 0.0f); // not in the lake
        }
        alpi_terrain_destroy_ground(context, ground);
    }
}

TEST_WITH_CONTEXT(the_lake_ends_in_its_shore, 1)
{
    static const uint32_t CELLS[] = {16, 40, 111, 400};
    for (size_t n = 0; n < sizeof CELLS / sizeof *CELLS; n++) {
        alpi_ground *ground = NULL;
        ASSERT_OK(context, alpi_terrain_make_ground(context, CELLS[n], &ground));
        assert_true(alpi_terrain_height(ground, ALPI_LAKE_X, ALPI_LAKE_Z) < -2.0f);
        for (int i = 0; i < 360; i++) {
            double angle = i * ALPI_PI / 180.0;
            float x = ALPI_LAKE_X + ALPI_LAKE_RIM * (float)cos(angle);
            float z = ALPI_LAKE_Z + ALPI_LAKE_RIM * (float)sin(angle);
            if (!(alpi_terrain_height(ground, x, z) > 0.0f)) {
                fail_msg("%u cells: the water stands free at %d°", CELLS[n], i);
            }
        }
        alpi_terrain_destroy_ground(context, ground);
    }
}

/// Heights between vertices are those of the triangles, not of the function.
TEST_WITH_CONTEXT(heights_lie_on_the_triangles, 1)
{
    alpi_builder builder;
    alpi_builder_start(&builder, context, "ground");
    vec3 grey = {0.5f, 0.5f, 0.5f}, dark = {0.0f, 0.0f, 0.0f};
    uint32_t material = alpi_builder_material(&builder, "grey", grey, dark);
    alpi_shaper shaper = alpi_shaper_start(&builder, 1.0);
    alpi_shaper_surface(&shaper, "ground", material);
    alpi_ground *ground = NULL;
    ASSERT_OK(context, alpi_terrain_make_ground(context, 20, &ground));
    alpi_terrain_build_ground(&shaper, ground, 20);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    for (uint32_t t = 0; t < 2 * 20 * 20; t++) { // of the top
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        vec3 middle = vec3_scale(vec3_add(vec3_add(c[0], c[1]), c[2]), 1.0f / 3.0f);
        ASSERT_NEAR(alpi_terrain_height(ground, middle.x, middle.z), middle.y, 1e-4);
    }
    alpi_terrain_destroy_ground(context, ground);
    alp_scene_destroy(scene);
}

// --- settings ------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(settings_are_read_or_refused, 1)
{
    static const struct {
        const char *name, *says;
    } BAD[] = {
        {"cornell,triangles=20000", "takes no settings"},
        {"windows,", "takes no settings"},
        {"atrium,", "no such setting"},
        {"atrium,triangles", "no such setting"},
        {"atrium,triangles=", "not a whole number"},
        {"atrium,triangles=1e5", "not a whole number"},
        {"atrium,triangles=-20000", "not a whole number"},
        {"atrium,triangles= 20000", "not a whole number"},
        {"atrium,triangles=99999999999999999999999", "not a whole number"},
        {"atrium,triangles=4294967295", "not a whole number"},
        {"atrium,triangles=19999", "out of range"},
        {"atrium,triangles=4000001", "out of range"},
        {"atrium,triangles=20000,triangles=20000", "set twice"},
        {"atrium,trees=5", "no such setting"},
        {"atrium,trianglesx=20000", "no such setting"},
        {"atrium,triangles=20000,", "no such setting"},
        {"terrain,triangles=4999", "triangles=N, 5000 to 4000000; trees=N, 0 to 20000"},
        {"terrain,trees=20001", "out of range"},
        {"terrain,triangles=5000,trees=5000", "5000 triangles are too few"},
        {"atriumx", "no such built-in scene"},
        {"atriu,triangles=20000", "no such built-in scene"},
        {"", "builtin: the name of a scene is missing"},
        {",", "no such built-in scene"},
    };
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        alp_scene *scene = NULL;
        alp_result result = alpi_builtin_create(context, BAD[i].name, &scene);
        if (result != ALP_ERROR_INVALID_ARGUMENT || scene != NULL ||
            strstr(alp_context_message(context), BAD[i].says) == NULL) {
            fail_msg("%s: %d: %s", BAD[i].name, (int)result, alp_context_message(context));
        }
    }
    alp_scene *scene = create(context, "terrain,trees=20,triangles=30000");
    assert_string_equal(scene->name, "builtin:terrain,trees=20,triangles=30000");
    alp_scene_destroy(scene);
}

TEST(every_failed_allocation_is_reported)
{
    static const char *const NAMES[] = {"terrain,triangles=5000", "windows",
                                        "atrium,triangles=20000"};
    for (int n = 0; n < 3; n++) {
        int allocations_left = 0;
        alp_context *context = test_context_failing(&allocations_left);
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        int allowed = 0;
        for (; result != ALP_OK; allowed++) {
            allocations_left = allowed;
            alp_scene *scene = NULL;
            result = alpi_builtin_create(context, NAMES[n], &scene);
            assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
            assert_true((scene != NULL) == (result == ALP_OK));
            alp_scene_destroy(scene);
        }
        assert_in_range(allowed, 20, 400);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(names_without_trees_have_no_empty_surfaces, 1)
{
    for (int trees = 0; trees < 4; trees++) {
        char name[40];
        snprintf(name, sizeof name, "terrain,trees=%d", trees);
        alp_scene *scene = create(context, name);
        for (uint32_t i = 0; i < scene->surface_count; i++) {
            assert_true(scene->surfaces[i].triangle_count > 0);
        }
        alp_scene_destroy(scene);
    }
}
