// SPDX-License-Identifier: MIT
// --only, --occluders, --ao-self: closed forms of boxes on a floor, what is refused, and many
// objects as one stage.
#include "boxes.h"
#include "test_gltf.h"

#include "maps/lightmap.h"
#include "scene/scene.h"

#include <stdatomic.h>
#include <stdlib.h>

// --- closed forms --------------------------------------------------------------------------------

/// A floor and two boxes that stand on it, named in UTF-8.
static alp_scene *boxes_at_height(alp_context *context, float height)
{
    static const float floor[4][3] = {{-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}};
    static const uint32_t floor_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static float boxes[2][8][3];
    alp_mesh meshes[3] = {{.name = "Fußboden",
                           .vertex_count = 4,
                           .positions = floor[0],
                           .triangle_count = 2,
                           .indices = floor_triangles[0]}};
    for (int b = 0; b < 2; b++) {
        for (int v = 0; v < 8; v++) {
            boxes[b][v][0] = CUBE[v][0] + (b == 0 ? -1.25f : 0.25f);
            boxes[b][v][1] = CUBE[v][1] + height;
            boxes[b][v][2] = CUBE[v][2];
        }
        meshes[1 + b] = (alp_mesh){.name = b == 0 ? "Würfel links" : "Würfel rechts",
                                   .vertex_count = 8,
                                   .positions = boxes[b][0],
                                   .triangle_count = 12,
                                   .indices = CUBE_TRIANGLES[0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 3, &scene));
    return scene;
}

static alp_scene *boxes_on_a_floor(alp_context *context)
{
    return boxes_at_height(context, 0.0f);
}

TEST_WITH_CONTEXT(a_floor_without_occluders_is_open, 2)
{
    alp_scene *scene = boxes_on_a_floor(context);
    alp_bake_options options = small_options();
    options.only = "Fu?boden";
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    float low, high;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    find_range(lightmap, &low, &high);
    assert_true(low < 0.5f); // beside and below the boxes, which are there
    assert_int_equal(report.surfaces_baked, 1);
    assert_int_equal(report.scene.surfaces, 3);
    assert_int_equal(report.atlas.charts, 1);
    const alp_atlas *atlas = alp_lightmap_atlas(lightmap);
    assert_int_equal(alp_atlas_triangle_pages(atlas)[0], 0);
    assert_int_equal(alp_atlas_triangle_pages(atlas)[2], ALPI_NONE);
    ASSERT_NEAR(report.atlas.texels_per_metre, 64.0 / 6.0, 0.1); // the whole page is the floor's
    ASSERT_NEAR(report.atlas.utilisation, 1.0, 0.01);
    alp_lightmap_destroy(lightmap);

    options.occluders = "Fu?boden";
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    find_range(lightmap, &low, &high);
    assert_true(low == 1.0f && high == 1.0f);
    alp_lightmap_destroy(lightmap);

    options.occluders = "*links";
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    double one = report.ao_mean;
    alp_lightmap_destroy(lightmap);
    options.occluders = "*links,*rechts";
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean < one && one < 1.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_convex_object_alone_is_open, 2)
{
    alp_scene *scene = boxes_on_a_floor(context);
    alp_bake_options options = small_options();
    float low, high;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    find_range(lightmap, &low, &high);
    assert_true(low < 0.5f);
    alp_lightmap_destroy(lightmap);
    options.ao_self = true;
    options.occlusion.distance = 0.0f;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    find_range(lightmap, &low, &high);
    assert_true(low == 1.0f && high == 1.0f);
    ASSERT_NEAR(report.ao_distance, 0.2 * 6.0 * sqrt(2.0), 1e-5); // the floor's
    assert_int_equal(report.surfaces_baked, 3);
    alp_lightmap_destroy(lightmap);
    options.only = "W*";
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    ASSERT_NEAR(report.ao_distance, 0.2 * sqrt(3.0), 1e-5);
    assert_int_equal(report.surfaces_baked, 2);
    alp_scene_destroy(scene);
}

/// A trench of a floor and two walls; with `lid` under a plate that closes it, and beside a box.
static alp_scene *trench(alp_context *context, bool lid)
{
    static const float corners[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, 4}, {0, 0, 4},
                                        {0, 1, 0}, {2, 1, 0}, {2, 1, 4}, {0, 1, 4}};
    static const uint32_t triangles[6][3] = {{0, 3, 2}, {0, 2, 1}, {0, 4, 7},
                                             {0, 7, 3}, {1, 2, 6}, {1, 6, 5}};
    static const float plate[4][3] = {{-9, 1.2f, 9}, {-9, 1.2f, -9}, {9, 1.2f, -9}, {9, 1.2f, 9}};
    static const uint32_t plate_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh meshes[3] = {{.name = "trench",
                                 .vertex_count = 8,
                                 .positions = corners[0],
                                 .triangle_count = 6,
                                 .indices = triangles[0]},
                                {.name = "",
                                 .vertex_count = 4,
                                 .positions = plate[0],
                                 .triangle_count = 2,
                                 .indices = plate_triangles[0]},
                                {.name = "box",
                                 .vertex_count = 8,
                                 .positions = CUBE[0],
                                 .triangle_count = 12,
                                 .indices = CUBE_TRIANGLES[0]}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, lid ? 3 : 1, &scene));
    return scene;
}

TEST_WITH_CONTEXT(an_object_alone_is_what_it_is_without_neighbours, 2)
{
    alp_scene *closed = trench(context, true), *free_one = trench(context, false);
    alp_bake_options options = small_options();
    alp_lightmap *alone = NULL, *without = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(free_one, &options, &without, &report));
    assert_true(report.ao_mean > 0.3 && report.ao_mean < 0.9);
    const double open_mean = report.ao_mean;
    options.only = "trench";
    options.ao_self = true;
    ASSERT_OK(context, alp_bake(closed, &options, &alone, NULL));
    const size_t size = sizeof(float) * 64 * 64 * 4;
    assert_memory_equal(alp_lightmap_page(alone, 0, NULL, NULL),
                        alp_lightmap_page(without, 0, NULL, NULL), size);
    alp_lightmap_destroy(alone);

    options.ao_self = false; // the same with the others let through, and not with them
    options.occluders = "trench";
    ASSERT_OK(context, alp_bake(closed, &options, &alone, NULL));
    assert_memory_equal(alp_lightmap_page(alone, 0, NULL, NULL),
                        alp_lightmap_page(without, 0, NULL, NULL), size);
    alp_lightmap_destroy(alone);
    options.occluders = "trench,"; // the plate has no name
    ASSERT_OK(context, alp_bake(closed, &options, &alone, &report));
    assert_true(report.ao_mean < open_mean - 0.1);
    alp_lightmap_destroy(alone);

    options = small_options(); // among others in one atlas: only its texels lie elsewhere
    options.ao_self = true;
    options.occlusion.samples = 1024;
    ASSERT_OK(context, alp_bake(closed, &options, &alone, NULL));
    const alpi_texels *texels = &alone->texels;
    double sum = 0.0, area = 0.0, expected;
    for (uint32_t i = 0; i < texels->count; i++) {
        if (texels->triangles[i] < 6) {
            const size_t at = (size_t)texels->pixels[i][1] * 64 + texels->pixels[i][0];
            sum += (double)texels->areas[i] * (double)alone->pages[0][4 * at];
            area += (double)texels->areas[i];
        }
    }
    options.ao_self = false;
    ASSERT_OK(context, alp_bake(free_one, &options, NULL, &report));
    expected = report.ao_mean;
    ASSERT_NEAR(sum / area, expected, 0.01); // of texels three times as wide
    alp_lightmap_destroy(alone);
    alp_lightmap_destroy(without);
    alp_scene_destroy(closed);
    alp_scene_destroy(free_one);
}

// --- ends ----------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(wrong_choices_are_refused, 1)
{
    alp_scene *scene = boxes_on_a_floor(context);
    alp_bake_options options = small_options();
    options.only = "Stuhl*";
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    test_message_has(context, "\"Stuhl*\"");
    test_message_has(context, "\"Fußboden\"");
    options.only = NULL;
    options.occluders = "Stuhl*";
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options.occluders = "*";
    options.ao_self = true;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    test_message_has(context, "ao_self");
    alp_scene_destroy(scene);

    const float point[3][3] = {{0}}; // a chosen surface without area, beside one that has some
    const uint32_t triangle[3] = {0, 1, 2};
    const alp_mesh meshes[2] = {{.name = "flat",
                                 .vertex_count = 3,
                                 .positions = point[0],
                                 .triangle_count = 1,
                                 .indices = triangle},
                                {.name = "box",
                                 .vertex_count = 8,
                                 .positions = CUBE[0],
                                 .triangle_count = 12,
                                 .indices = CUBE_TRIANGLES[0]}};
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    options = small_options();
    options.only = "flat";
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "chosen");
    options.only = NULL;
    options.ao_self = true;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    options.ao_self = false;
    options.occluders = "flat"; // nothing that a ray could hit
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean == 1.0);
    alp_scene_destroy(scene);
}

TEST(every_allocation_may_fail)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_scene *scene = boxes_on_a_floor(context);
    alp_bake_options options = small_options();
    options.atlas.size = 16;
    options.occlusion.samples = 4;
    for (int kind = 0; kind < 2; kind++) {
        options.only = "W*";
        options.ao_self = kind == 0;
        options.occluders = kind == 0 ? NULL : "F*";
        int failures = 0;
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        for (int budget = 0; result != ALP_OK; budget += TEST_STEP) {
            left = budget;
            result = alp_bake(scene, &options, NULL, NULL);
            failures += result != ALP_OK;
            assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        }
        assert_true(failures > 20);
    }
    left = 1 << 30;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

/// What a user of progress may rely on.
typedef struct listener {
    uint64_t done, total;
    int calls, stop_at;
} listener;

static bool listen(void *user, const alp_progress *progress)
{
    listener *l = user;
    if (strcmp(progress->stage, "occlusion") != 0) {
        return true;
    }
    assert_true(l->calls == 0 || progress->total == l->total);
    assert_true(progress->done >= l->done && progress->done <= progress->total);
    l->total = progress->total;
    l->done = progress->done;
    return ++l->calls != l->stop_at;
}

TEST_SLOW_WITH_CONTEXT(many_objects_are_one_stage, 2)
{
    enum { COUNT = 500 };
    alp_mesh *meshes = calloc(COUNT, sizeof *meshes);
    float(*corners)[8][3] = calloc(COUNT, sizeof *corners);
    assert_non_null(meshes);
    assert_non_null(corners);
    for (int i = 0; i < COUNT; i++) {
        for (int v = 0; v < 8; v++) {
            corners[i][v][0] = CUBE[v][0] + (float)(i % 40);
            corners[i][v][1] = CUBE[v][1];
            corners[i][v][2] = CUBE[v][2] + (float)(i / 40);
        }
        meshes[i] = (alp_mesh){.vertex_count = 8,
                               .positions = corners[i][0],
                               .triangle_count = 12,
                               .indices = CUBE_TRIANGLES[0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, COUNT, &scene));
    free(meshes);
    free(corners);
    alp_bake_options options = small_options();
    listener l = {0};
    options.ao_self = true;
    options.atlas.size = 512;
    options.occlusion.samples = 16;
    options.progress = listen;
    options.progress_user = &l;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(l.calls > 0);
    assert_int_equal(l.total, report.atlas.texels * 16);
    assert_true(report.ao_mean == 1.0);
    l = (listener){.stop_at = 1};
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
    assert_int_equal(l.calls, 1); // nobody is asked again
    alp_scene_destroy(scene);
}

static void *count_bytes(void *user, size_t size)
{
    atomic_fetch_add((_Atomic uint64_t *)user, size);
    return calloc(1, size);
}

static void release_counted(void *user, void *block)
{
    (void)user;
    free(block);
}

/// Cubes in a row, each an object.
static alp_scene *many_cubes(alp_context *context, uint32_t count)
{
    alp_mesh *meshes = calloc(count, sizeof *meshes);
    float(*corners)[8][3] = calloc(count, sizeof *corners);
    assert_non_null(meshes);
    assert_non_null(corners);
    for (uint32_t i = 0; i < count; i++) {
        memcpy(corners[i], CUBE, sizeof corners[i]);
        for (int v = 0; v < 8; v++) {
            corners[i][v][0] += 2.0f * (float)i;
        }
        meshes[i] = (alp_mesh){.vertex_count = 8,
                               .positions = corners[i][0],
                               .triangle_count = 12,
                               .indices = CUBE_TRIANGLES[0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, count, &scene));
    free(meshes);
    free(corners);
    return scene;
}

TEST(an_object_takes_no_memory_of_the_page)
{
    // Bytes asked for and cleared in a bake of one page: what four times the objects add is theirs
    // (a tracer, some probes, a histogram of 256 KiB: less than 10 bytes a texel of the page), and
    // no arrays over all texels of the page (some 50 bytes each).
    uint64_t bytes[2];
    uint32_t texels = 0;
    const uint32_t counts[2] = {16, 64};
    for (int i = 0; i < 2; i++) {
        _Atomic uint64_t asked = 0;
        alp_context_options how = alp_context_options_default();
        how.worker_count = 1;
        how.allocate = count_bytes;
        how.release = release_counted;
        how.allocator_user = &asked;
        alp_context *context = NULL;
        assert_int_equal(alp_context_create(&how, &context), ALP_OK);
        alp_scene *scene = many_cubes(context, counts[i]);
        alp_bake_options options = small_options();
        options.ao_self = true;
        options.atlas.size = 256;
        options.occlusion.samples = 16;
        alp_bake_report report;
        const volatile uint64_t before = asked; // the bake adds to it
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
        bytes[i] = asked - before;
        texels = (uint32_t)report.atlas.texels;
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    print_message("objects: %.1f and %.1f MB for %u texels\n", 1e-6 * (double)bytes[0],
                  1e-6 * (double)bytes[1], texels);
    assert_true(bytes[1] < bytes[0] + (uint64_t)(counts[1] - counts[0]) * texels * 10);
}

static bool stop_half_way(void *user, const alp_progress *progress)
{
    (void)user;
    return strcmp(progress->stage, "occlusion") != 0 || progress->done * 4 < progress->total;
}

TEST_WITH_CONTEXT(what_is_cut_off_is_unknown, 2)
{
    alp_scene *scene = boxes_on_a_floor(context);
    alp_bake_options options = small_options();
    options.ao_self = true;
    options.sampling.accuracy = ALP_ADAPTIVE_OFF;
    options.sampling.time_limit = 1e-9;
    alp_bake_report report;
    assert_int_equal(alp_bake(scene, &options, NULL, &report), ALP_ERROR_LIMIT); // no texel at all

    options.sampling.time_limit = 0.0; // the floor first, which alone takes long enough to be asked
    options.sampling.keep_partial = true;
    options.atlas.size = 256;
    options.occlusion.samples = 4096;
    options.progress = stop_half_way;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.cut_off);
    assert_int_equal(report.traced + report.interpolated + report.unknown, report.atlas.texels);
    assert_true(report.unknown > 0 && report.unknown < report.atlas.texels);
    alp_scene_destroy(scene);
}

/// Of the texels that were sampled: their mean value, the mean of the squares of their errors, and
/// the largest error.
static double sum_errors(const alp_lightmap *lightmap, double *squares, double *largest)
{
    const float *page = alp_lightmap_page(lightmap, 0, NULL, NULL);
    double sum = 0.0, count = 0.0;
    *squares = *largest = 0.0;
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        const uint16_t *p = lightmap->texels.pixels[i];
        if (lightmap->states[i] != ALPI_TEXEL_OPEN) {
            sum += (double)page[4 * ((size_t)p[1] * lightmap->width + p[0])];
            *squares += pow((double)lightmap->errors[i], 2);
            *largest = fmax(*largest, (double)lightmap->errors[i]);
            count += 1.0;
        }
    }
    *squares /= count;
    return sum / count;
}

TEST_WITH_CONTEXT(the_stated_error_is_of_what_was_sampled, 2)
{
    // The boxes are sunk into the floor, whose texels at their rim are wholly inside: they are
    // dropped, and are no texels without error.
    alp_scene *scene = boxes_at_height(context, -0.5f);
    alp_bake_options options = small_options();
    options.atlas.size = 256;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    double squares, largest;
    const double mean = sum_errors(lightmap, &squares, &largest);
    assert_true(report.dropped > 0 && squares > 0.0);
    ASSERT_NEAR(report.ao_relative_error * mean, sqrt(squares), 1e-9);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_stated_error_is_of_all_objects, 2)
{
    // The box and the plate are open without error, so the mean square is the trench's share of it.
    alp_scene *scene = trench(context, true);
    alp_bake_options options = small_options();
    options.ao_self = true;
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    double squares, largest;
    const double mean = sum_errors(lightmap, &squares, &largest);
    for (uint32_t i = 0; i < lightmap->texels.count; i++) {
        assert_true(lightmap->errors[i] == 0.0f || lightmap->texels.triangles[i] < 6);
    }
    assert_true(squares > 0.0);
    // The same floats: only sums of doubles are rounded.
    ASSERT_NEAR(report.ao_relative_error * mean, sqrt(squares), 1e-9);
    assert_true(report.ao_p99_error * mean <= largest * 1.000001);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST(workers_change_no_value)
{
    float *first = NULL;
    const uint32_t workers[] = {1, 2, 7};
    for (int i = 0; i < 3; i++) {
        alp_context *context = test_context(workers[i]);
        alp_scene *scene = trench(context, true);
        alp_bake_options options = small_options();
        options.ao_self = true;
        alp_lightmap *lightmap = NULL;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
        const float *page = alp_lightmap_page(lightmap, 0, NULL, NULL);
        const size_t size = sizeof(float) * 64 * 64 * 4;
        if (first == NULL) {
            first = malloc(size);
            assert_non_null(first);
            memcpy(first, page, size);
        }
        assert_memory_equal(page, first, size);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    free(first);
}
