// SPDX-License-Identifier: MIT
// Texels as receivers: their points cover the surface inside the texel, no more, no less, evenly.
#include "atlas_scenes.h"

#include "base/memory.h"
#include "base/random.h"

#include <stdlib.h>

/// Barycentrics of a place of the page in a triangle, by the cross products of its edges; whether
/// it lies inside.
static bool find_in_page(const alp_atlas *atlas, uint32_t triangle, const double at[2], double b[3])
{
    double p[3][2], area = 0.0;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            p[k][i] = (double)atlas->corner_uvs[triangle][k][i] * atlas->info.width;
        }
    }
    for (int k = 0; k < 3; k++) {
        const double *u = p[(k + 1) % 3], *v = p[(k + 2) % 3];
        b[k] = (u[0] - at[0]) * (v[1] - at[1]) - (u[1] - at[1]) * (v[0] - at[0]);
        area += b[k];
    }
    bool inside = area != 0.0;
    for (int k = 0; k < 3; k++) {
        b[k] /= area;
        inside = inside && b[k] >= 0.0;
    }
    return inside;
}

static void place_on_triangle(const alp_scene *scene, uint32_t triangle, const double b[3],
                              double place[3])
{
    for (int axis = 0; axis < 3; axis++) {
        place[axis] = 0.0;
        for (int k = 0; k < 3; k++) {
            place[axis] += b[k] * (double)scene->positions[scene->triangles[triangle][k]][axis];
        }
    }
}

static double world_per_texel(const alp_atlas *atlas, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(atlas->scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]) / fabs(texel_area(atlas, triangle));
}

/// Centroid of all that a texel holds, by clipping every triangle of the scene against it; and the
/// area, m².
static double exact_centroid(const alp_atlas *atlas, const alpi_texels *texels, uint32_t texel,
                             double centroid[3])
{
    const alp_scene *scene = atlas->scene;
    double area = 0.0;
    memset(centroid, 0, 3 * sizeof *centroid);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        alpi_page_triangle shape;
        alpi_polygon polygon;
        double middle[2], b[3], place[3];
        if (!scene->triangle_usable[t] || atlas->triangle_pages[t] != texels->pages[texel] ||
            !alpi_page_triangle_load(atlas, t, &shape)) {
            continue;
        }
        const uint16_t *pixel = texels->pixels[texel];
        alpi_page_triangle_cut(&shape, pixel[0], pixel[1], &polygon);
        double part = polygon.count > 2 ? alpi_polygon_measure(&polygon, middle) : 0.0;
        if (part <= 0.0) {
            continue;
        }
        part *= world_per_texel(atlas, t);
        find_in_page(atlas, t, middle, b);
        place_on_triangle(scene, t, b, place);
        area += part;
        for (int axis = 0; axis < 3; axis++) {
            centroid[axis] += part * place[axis];
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        centroid[axis] /= area;
    }
    return area;
}

static void mean_of_points(const alpi_texels *texels, uint32_t texel, double mean[3])
{
    static float square[GRID_POINTS][2];
    static alpi_receiver_point points[GRID_POINTS];
    fill_point_grid(square);
    alpi_receivers r = alpi_texels_receivers(texels);
    r.place(r.user, texel, GRID_POINTS, (const float(*)[2])square, points);
    memset(mean, 0, 3 * sizeof *mean);
    for (int i = 0; i < GRID_POINTS; i++) {
        mean[0] += (double)points[i].position.x / GRID_POINTS;
        mean[1] += (double)points[i].position.y / GRID_POINTS;
        mean[2] += (double)points[i].position.z / GRID_POINTS;
    }
}

static void check_means(alp_context *context, alp_scene *scene, uint32_t size)
{
    alp_atlas *atlas = charts_of_size(context, scene, size);
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    uint32_t step = texels.count / 200 + 1;
    for (uint32_t i = 0; i < texels.count; i += step) {
        double expected[3], mean[3];
        double area = exact_centroid(atlas, &texels, i, expected);
        ASSERT_NEAR(texels.areas[i], area, 1e-4 * area);
        mean_of_points(&texels, i, mean);
        // The midpoint rule over POINT_GRID strata: an edge between pieces may cross each of them.
        double reach = 2.0 / (double)POINT_GRID / atlas->info.texels_per_metre;
        for (int axis = 0; axis < 3; axis++) {
            ASSERT_NEAR(mean[axis], expected[axis], reach);
        }
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_mean_is_the_centroid, 1)
{
    check_means(context, scene_cube(context), 33);
    check_means(context, scene_sphere(context, 12, 24), 100);
    check_means(context, scene_sphere(context, 40, 80), 24); // dozens of triangles to a texel
    check_means(context, scene_plane(context, 60), 8);       // hundreds
    check_means(context, scene_confetti(context, 30), 64);
}

TEST_WITH_CONTEXT(a_known_piece_has_its_known_mean, 1)
{
    // One triangle with its right angle at (.25, .25) of the only texel it reaches and legs of .5:
    // its mean is a third of the way along both. World: 4 m a texel.
    static const float p[3][3] = {{1, 0, 1}, {1, 0, 3}, {3, 0, 1}};
    static const float uvs[3][2] = {{0.25f, 0.25f}, {0.25f, 0.75f}, {0.75f, 0.25f}};
    static const uint32_t index[1][3] = {{0, 1, 2}};
    alp_scene *scene = scene_of(context, p, uvs, 3, index, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 1;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    assert_int_equal(texels.count, 1);
    double mean[3];
    mean_of_points(&texels, 0, mean);
    ASSERT_NEAR(mean[0], 1.0 + 2.0 / 3.0,
                2e-3); // midpoint rule over √v: 1/(24 POINT_GRID^1.5) of 2 m
    ASSERT_NEAR(mean[1], 0.0, 0.0);
    ASSERT_NEAR(mean[2], 1.0 + 2.0 / 3.0, 2e-3);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(pieces_count_by_their_area_in_the_world, 1)
{
    // Two halves of the only texel; one has three times the legs of the other.
    static const float p[6][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0},
                                  {9, 0, 0}, {9, 0, 3}, {12, 0, 0}};
    static const float uvs[6][2] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {1, 0}, {0, 1}};
    static const uint32_t indices[2][3] = {{0, 1, 2}, {3, 4, 5}};
    alp_scene *scene = scene_of(context, p, uvs, 6, indices, 2);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 1;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    assert_int_equal(texels.piece_first[1], 2);
    ASSERT_NEAR(texels.areas[0], 5.0, 1e-5);
    ASSERT_NEAR(texels.piece_ends[0], texels.piece_triangles[0] == 0 ? 0.1 : 0.9, 1e-6);
    double mean[3];
    mean_of_points(&texels, 0, mean); // the midpoint rule puts 3 or 4 of 32 columns into a tenth
    ASSERT_NEAR(mean[0], 0.1 * (1.0 / 3.0) + 0.9 * 10.0, 0.03 * 10.0);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

/// The triangle of a texel's that a point lies on, and where in the page that is.
static uint32_t triangle_of_point(const alp_atlas *atlas, const alpi_texels *texels, uint32_t texel,
                                  vec3 point, double at[2])
{
    uint32_t first = texels->piece_first[texel], end = texels->piece_first[texel + 1], best = 0;
    double nearest = HUGE_VAL;
    at[0] = at[1] = -1.0;
    for (uint32_t k = first; k < (first == end ? first + 1 : end); k++) {
        uint32_t t = first == end ? texels->triangles[texel] : texels->piece_triangles[k];
        vec3 c[3];
        alpi_triangle_corners(atlas->scene, t, c);
        double area = vec3_triangle_area(c[0], c[1], c[2]), b[3], sum = 0.0, longest = 0.0;
        for (int i = 0; i < 3; i++) {
            b[i] = vec3_triangle_area(point, c[(i + 1) % 3], c[(i + 2) % 3]);
            sum += b[i]; // the area inside, more outside
            longest = fmax(longest, (double)vec3_length(vec3_sub(c[i], c[(i + 1) % 3])));
        }
        if ((sum - area) / longest < nearest) { // metres outside
            nearest = (sum - area) / longest;
            best = k;
            for (int i = 0; i < 2; i++) {
                const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[t];
                at[i] =
                    (b[0] * (double)uv[0][i] + b[1] * (double)uv[1][i] + b[2] * (double)uv[2][i]) /
                    sum * atlas->info.width;
            }
        }
    }
    assert_true(nearest < 3e-6); // float steps at 10 m, the scenes' size
    return best;
}

/// Every point lies in a triangle of its texel and, in the page, in the texel; and pieces get
/// points by their areas.
static void check_points(alp_context *context, alp_scene *scene, uint32_t size)
{
    alp_atlas *atlas = charts_of_size(context, scene, size);
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    alpi_receivers r = alpi_texels_receivers(&texels);
    assert_true(r.extended && r.count == texels.count);
    static float square[GRID_POINTS][2];
    static alpi_receiver_point points[GRID_POINTS];
    fill_point_grid(square);
    uint32_t *hits = calloc((size_t)texels.piece_first[texels.count] + 1, sizeof *hits);
    assert_non_null(hits);
    for (uint32_t i = 0; i < texels.count; i += texels.count / 100 + 1) {
        texels.flags[i] = ALPI_TEXEL_NO_LIFT;
        r.place(r.user, i, GRID_POINTS, (const float(*)[2])square, points);
        uint32_t first = texels.piece_first[i], end = texels.piece_first[i + 1];
        for (int k = 0; k < GRID_POINTS; k++) {
            double at[2];
            uint32_t piece = triangle_of_point(atlas, &texels, i, points[k].position, at);
            hits[piece] += first != end;
            ASSERT_NEAR(at[0], texels.pixels[i][0] + 0.5, 0.502);
            ASSERT_NEAR(at[1], texels.pixels[i][1] + 0.5, 0.502);
        }
        float begin = 0.0f;
        for (uint32_t p = first; p < end; p++) { // columns of the grid that fall into the piece
            double expected = (double)(texels.piece_ends[p] - begin) * GRID_POINTS;
            ASSERT_NEAR(hits[p], expected, POINT_GRID + 0.02 * expected);
            begin = texels.piece_ends[p];
        }
        assert_true(first == end || texels.piece_ends[end - 1] == 1.0f);
    }
    free(hits);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(points_lie_in_their_texel, 1)
{
    check_points(context, scene_cube(context), 64);
    check_points(context, scene_sphere(context, 12, 24), 100);
    check_points(context, scene_sphere(context, 20, 40), 24);
    check_points(context, scene_spiral(context, 3), 100);
    check_points(context, scene_confetti(context, 30), 64);
}

// --- brute force ---------------------------------------------------------------------------------

/// Mean and its standard error from random places in the texel's square, kept where a triangle is,
/// weighted by the triangle's area in the world; 1,000 of them kept.
static void brute_mean(const alp_atlas *atlas, const alpi_texels *texels, uint32_t texel,
                       double mean[3], double error[3])
{
    const alp_scene *scene = atlas->scene;
    double weights = 0.0, sum[3] = {0}, squares[3] = {0};
    uint32_t near[512], near_count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        alpi_page_triangle shape;
        const uint16_t *p = texels->pixels[texel];
        if (scene->triangle_usable[t] && atlas->triangle_pages[t] == texels->pages[texel] &&
            alpi_page_triangle_load(atlas, t, &shape) && shape.low[0] < p[0] + 1 &&
            shape.high[0] > p[0] && shape.low[1] < p[1] + 1 && shape.high[1] > p[1]) {
            assert_true(near_count < 512);
            near[near_count++] = t;
        }
    }
    uint32_t kept = 0;
    for (uint32_t s = 0; kept < 1000 && s < 200000; s++) {
        const vec2 u = alpi_sample_2d(alpi_random_key(3, texel, 0), s);
        const double at[2] = {texels->pixels[texel][0] + (double)u.x,
                              texels->pixels[texel][1] + (double)u.y};
        for (uint32_t k = 0; k < near_count; k++) {
            double b[3], place[3];
            if (find_in_page(atlas, near[k], at, b)) {
                double weight = world_per_texel(atlas, near[k]);
                place_on_triangle(scene, near[k], b, place);
                weights += weight;
                for (int axis = 0; axis < 3; axis++) {
                    sum[axis] += weight * place[axis];
                    squares[axis] += weight * place[axis] * place[axis];
                }
                kept++;
                break;
            }
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        mean[axis] = kept > 0 ? sum[axis] / weights : 0.0; // none: the piece is too small to be met
        double variance = kept > 0 ? squares[axis] / weights - mean[axis] * mean[axis] : 0.0;
        error[axis] = kept > 0 ? sqrt(fmax(variance, 0.0) / kept) : HUGE_VAL;
    }
}

static void check_brute_force(alp_context *context, alp_scene *scene, uint32_t size)
{
    alp_atlas *atlas = charts_of_size(context, scene, size);
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    uint32_t cut = 0;
    for (uint32_t i = 0; i < texels.count; i += texels.count / 150 + 1) {
        double expected[3], error[3], mean[3];
        texels.flags[i] = ALPI_TEXEL_NO_LIFT;
        brute_mean(atlas, &texels, i, expected, error);
        mean_of_points(&texels, i, mean);
        for (int axis = 0; axis < 3; axis++) { // four standard errors, and the grid's own error
            ASSERT_NEAR(mean[axis], expected[axis],
                        4.0 * error[axis] + 0.02 / atlas->info.texels_per_metre);
        }
        cut += texels.piece_first[i] != texels.piece_first[i + 1];
    }
    assert_true(cut > 10);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(points_agree_with_brute_force, 1)
{
    alp_scene *scene = NULL;
    const char *names[] = {"builtin:teapot-room", "builtin:torus-plane"};
    for (int i = 0; i < 2; i++) {
        if (alp_scene_load(context, names[i], &scene) == ALP_OK) {
            check_brute_force(context, scene, 128);
        } else {
            assert_int_equal(i, 1); // teapot-room there is
        }
    }
    check_brute_force(context, scene_sphere(context, 30, 60), 48);
}

/// Mean square of the distance (texels) by which the mean of 16 points misses the texel's, over
/// many sets of points.
static double scatter(const alpi_texels *texels, const alpi_receivers *r, bool stratified)
{
    double sum = 0.0;
    uint32_t sets = 0;
    for (uint32_t i = 0; i < texels->count; i++) {
        double center[3];
        mean_of_points(texels, i, center);
        for (uint32_t set = 0; set < 8; set++, sets++) {
            const uint32_t key = alpi_random_key(5, i, set);
            float square[16][2];
            alpi_receiver_point points[16];
            double mean[3] = {0.0, 0.0, 0.0};
            for (uint32_t k = 0; k < 16; k++) {
                const uint32_t other = alpi_random_key(k, i, set);
                const vec2 u = alpi_sample_2d(stratified ? key : other, stratified ? k : 0);
                square[k][0] = u.x;
                square[k][1] = u.y;
            }
            r->place(r->user, i, 16, (const float(*)[2])square, points);
            for (int k = 0; k < 16; k++) {
                mean[0] += (double)points[k].position.x / 16.0;
                mean[2] += (double)points[k].position.z / 16.0;
            }
            sum += (mean[0] - center[0]) * (mean[0] - center[0]) +
                   (mean[2] - center[2]) * (mean[2] - center[2]);
        }
    }
    return sum / sets * texels->atlas->info.texels_per_metre * texels->atlas->info.texels_per_metre;
}

TEST_WITH_CONTEXT(stratified_squares_stay_stratified, 1)
{
    // 16 random points miss the mean by 1/√96 of a texel; a 4 × 4 net of a square by a 16th of its
    // variance. Whole texels keep the net; pieces keep the order of its first coordinate, along a
    // curve that fills the texel.
    const uint32_t squares[] = {1, 8, 60}; // of 8 texels a side: whole, two triangles, dozens
    const double shares[] = {0.05, 0.05, 0.2};
    for (int i = 0; i < 3; i++) {
        alp_scene *scene = scene_plane(context, squares[i]);
        alp_atlas *atlas = charts_of_size(context, scene, 8);
        alpi_texels texels;
        ASSERT_OK(context, alpi_texels_create(atlas, &texels));
        const alpi_receivers r = alpi_texels_receivers(&texels);
        const double random = scatter(&texels, &r, false), net = scatter(&texels, &r, true);
        ASSERT_NEAR(random, 1.0 / 96.0, 0.2 / 96.0); // 512 sets: four standard errors
        assert_true(net < shares[i] * random);
        alpi_texels_destroy(context, &texels);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
    }
}

// --- strata --------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(invalid_strata_get_no_points, 1)
{
    // A point of the masked texel is the point of the whole one at a place inside a valid stratum,
    // and the valid strata get equally many.
    alp_scene *scene = scene_sphere(context, 12, 24);
    alp_atlas *atlas = charts_of_size(context, scene, 64);
    alpi_texels texels;
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    alpi_receivers r = alpi_texels_receivers(&texels);
    texels.valid = ALPI_NEW(context, uint16_t, texels.count);
    assert_non_null(texels.valid);
    static float square[GRID_POINTS][2];
    alpi_receiver_point masked[64], whole[64];
    fill_point_grid(square);
    const uint16_t masks[] = {0x0001, 0x8000, 0x0f0f, 0x7fff, 0x1240};
    for (uint32_t i = 0; i < texels.count; i += 37) {
        for (int m = 0; m < 5; m++) {
            uint32_t counts[16] = {0}, bits = (uint32_t)__builtin_popcount(masks[m]),
                     order[16] = {0};
            for (uint32_t s = 0, k = 0; s < 16; s++) {
                if ((masks[m] >> s & 1) != 0) {
                    order[k++] = s;
                }
            }
            for (int first = 0; first < GRID_POINTS; first += 64) {
                float moved[64][2];
                for (int k = 0; k < 64; k++) {
                    double u = (double)square[first + k][0] * bits;
                    uint32_t stratum = order[(uint32_t)u];
                    counts[stratum]++;
                    moved[k][0] = (float)((stratum % 4 + u - floor(u)) / 4.0);
                    moved[k][1] = (float)((stratum / 4 + (double)square[first + k][1]) / 4.0);
                }
                texels.valid[i] = masks[m];
                r.place(r.user, i, 64, (const float(*)[2])(square + first), masked);
                texels.valid[i] = 0xffff;
                r.place(r.user, i, 64, (const float(*)[2])moved, whole);
                for (int k = 0; k < 64; k++) {
                    vec3 apart = vec3_sub(masked[k].position, whole[k].position);
                    ASSERT_NEAR(vec3_length(apart), 0.0, 1e-5);
                }
            }
            for (uint32_t k = 0; k < bits; k++) {
                ASSERT_NEAR(counts[order[k]], (double)GRID_POINTS / bits, POINT_GRID);
            }
        }
    }
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

// --- workers, memory -----------------------------------------------------------------------------

static void check_same(const alpi_texels *a, const alpi_texels *b, uint32_t pages)
{
    assert_int_equal(a->count, b->count);
    const size_t n = a->count, pieces = a->piece_first[n];
    assert_memory_equal(a->page_first, b->page_first, (pages + 1) * sizeof *a->page_first);
    assert_memory_equal(a->pages, b->pages, n * sizeof *a->pages);
    assert_memory_equal(a->pixels, b->pixels, n * sizeof *a->pixels);
    assert_memory_equal(a->triangles, b->triangles, n * sizeof *a->triangles);
    assert_memory_equal(a->barycentrics, b->barycentrics, n * sizeof *a->barycentrics);
    assert_memory_equal(a->normals, b->normals, n * sizeof *a->normals);
    assert_memory_equal(a->areas, b->areas, n * sizeof *a->areas);
    assert_memory_equal(a->coverages, b->coverages, n * sizeof *a->coverages);
    assert_memory_equal(a->charts, b->charts, n * sizeof *a->charts);
    assert_memory_equal(a->piece_first, b->piece_first, (n + 1) * sizeof *a->piece_first);
    assert_memory_equal(a->piece_triangles, b->piece_triangles, pieces * sizeof *a->piece_ends);
    assert_memory_equal(a->piece_ends, b->piece_ends, pieces * sizeof *a->piece_ends);
}

TEST_SLOW(any_number_of_workers_gives_the_same)
{
    const uint32_t workers[] = {1, 2, 7, 32};
    alp_context *contexts[4];
    alp_scene *scenes[4];
    alp_atlas *atlases[4];
    alpi_texels texels[4];
    for (int i = 0; i < 4; i++) {
        contexts[i] = test_context(workers[i]);
        scenes[i] = scene_sphere(contexts[i], 30, 60);
        atlases[i] = charts_of_size(contexts[i], scenes[i], 400);
        ASSERT_OK(contexts[i], alpi_texels_create(atlases[i], &texels[i]));
        check_same(&texels[0], &texels[i], atlases[0]->info.pages);
        assert_memory_equal(&atlases[0]->info, &atlases[i]->info, sizeof atlases[0]->info);
    }
    alpi_texels again; // the first were made when the atlas was
    ASSERT_OK(contexts[3], alpi_texels_create(atlases[3], &again));
    check_same(&texels[0], &again, atlases[0]->info.pages);
    alpi_texels_destroy(contexts[3], &again);
    for (int i = 0; i < 4; i++) {
        alpi_texels_destroy(contexts[i], &texels[i]);
        alp_atlas_destroy(atlases[i]);
        alp_scene_destroy(scenes[i]);
        alp_context_destroy(contexts[i]);
    }
}

TEST(every_allocation_may_fail)
{
    // A kept set, and texels that are made a second time.
    static const float p[4][3] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
    static const float uvs[4][2] = {{0.1f, 0}, {1, 0.1f}, {1, 1}, {0, 1}};
    static const uint32_t indices[2][3] = {{0, 1, 2}, {2, 3, 0}};
    int left = 0, failures = 0;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = scene_of(context, p, uvs, 4, indices, 2);
    alp_atlas_options options = alp_atlas_options_default();
    options.mode = ALP_ATLAS_KEEP;
    options.size = 8;
    for (bool done = false; !done; failures++) {
        alp_atlas *atlas = NULL;
        alpi_texels texels = {0}, again = {0};
        left = failures;
        alp_result result = alp_atlas_create(scene, &options, &atlas);
        result = result == ALP_OK ? alpi_texels_create(atlas, &texels) : result;
        result = result == ALP_OK ? alpi_texels_create(atlas, &again) : result;
        // the allocator reads it
        left = 1 << 30;
        done = result == ALP_OK;
        assert_true(done || result == ALP_ERROR_OUT_OF_MEMORY);
        alpi_texels_destroy(context, &texels);
        alpi_texels_destroy(context, &again);
        alp_atlas_destroy(atlas);
    }
    assert_true(failures > 50);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
