// SPDX-License-Identifier: MIT
// The COLLADA files of other exporters: as many triangles as independent tools count; patched with
// made-up coordinates and read again, the same triangles with those coordinates.
#include "test_support.h"

#include "base/memory.h"
#include "formats/collada/collada_read.h"
#include "formats/formats.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Triangles with node instancing, from SOURCES.md beside the scenes (pycollada, or assimp).
static const struct {
    const char *file;
    uint32_t triangles, surfaces;
} scenes[] = {
    {"duck.dae", 4212, 1},
    {"COLLADA.dae", 6722, 2},
    {"Cinema4D.dae", 1296, 3},
    {"ConcavePolygon.dae", 64, 1},
    {"earthCylindrical.DAE", 1920, 2},
    {"teapot_instancenodes.DAE", 2048, 2},
    {"lights.dae", 0, 0},
    {"cube_with_2UVs.DAE", 12, 1},
    {"regr01.dae", 172, 6},
    {"cube_tristrips.dae", 12, 1},
    {"cube_UTF16LE.dae", 12, 1},
    {"kwxport_test_vcolors.dae", 12, 3},
    {"sphere.dae", 760, 1},
    {"weapon_pistol.dae", 1438, 2},
    {"collada_trifans.dae", 6722, 2},
    {"seymour_plane_polylist.dae", 11229, 3},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

static const char *scene_path(const char *file)
{
    char relative[128];
    snprintf(relative, sizeof relative, "scenes/collada/%s", file);
    return test_shared(relative);
}

TEST(triangle_counts)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = 0; i < SCENE_COUNT; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = test_load(context, scene_path(scenes[i].file));
        print_message("%s: %u triangles, %u surfaces\n", scenes[i].file, scene->triangle_count,
                      scene->surface_count);
        assert_int_equal(scene->triangle_count, scenes[i].triangles);
        assert_int_equal(scene->surface_count, scenes[i].surfaces);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

// --- there and back ------------------------------------------------------------------------------

/// One way of patching.
typedef struct variant {
    uint32_t pages, chart; // triangles that share coordinates at their vertices
} variant;

/// Coordinates by vertex and chart; pages in runs of triangles.
static void invent(const alp_scene *scene, const variant *v, float (*uvs)[3][2], uint32_t *pages)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t chart = t / v->chart;
        pages[t] = t / (v->chart * 3) % v->pages;
        for (int k = 0; k < 3; k++) {
            const uint32_t vertex = scene->triangles[t][k];
            uvs[t][k][0] = (float)((vertex * 7 + chart) % 1000) / 1000.0f;
            uvs[t][k][1] = (float)((vertex * 13 + chart) % 1000) / 1000.0f;
        }
    }
}

/// The order that triangles are written in: within a surface by page, unusable ones as neighbours.
static void find_order(const alp_scene *scene, uint32_t page_count, uint32_t *pages,
                       uint32_t *order)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        const uint32_t first = surface->first_triangle, end = first + surface->triangle_count;
        uint32_t last = 0;
        for (uint32_t t = end; t-- > first;) {
            last = scene->triangle_usable[t] ? pages[t] : last;
        }
        for (uint32_t t = first; t < end; t++) {
            last = pages[t] = scene->triangle_usable[t] ? pages[t] : last;
        }
        for (uint32_t page = 0; page < page_count; page++) {
            for (uint32_t t = first; t < end; t++) {
                if (pages[t] == page) {
                    order[count++] = t;
                }
            }
        }
    }
}

static void compare(const alp_scene *old, const alp_scene *new, const uint32_t *order,
                    const float (*uvs)[3][2])
{
    assert_int_equal(new->triangle_count, old->triangle_count);
    for (uint32_t i = 0; i < old->triangle_count; i++) {
        const uint32_t t = order[i];
        const alpi_surface *surface = &new->surfaces[new->triangle_surface[i]];
        const uint32_t set = surface->uv_sets - 1; // the last one is ours
        for (int k = 0; k < 3; k++) {
            const uint32_t a = old->triangles[t][k], b = new->triangles[i][k];
            assert_memory_equal(old->positions[a], new->positions[b], sizeof old->positions[a]);
            ASSERT_NEAR(vec3_dot(vec3_load(old->normals[a]), vec3_load(new->normals[b])), 1.0,
                        1e-5); // unit vectors of floats
            for (int c = 0; c < 2 && old->triangle_usable[t]; c++) {
                // 1 − (1 − v) rounds at 2⁻²⁴, twice
                ASSERT_NEAR(new->uvs[set][b][c], uvs[t][k][c], 1.2e-7);
            }
        }
        const alpi_material *material = &new->materials[surface->material];
        assert_int_not_equal(surface->material, ALPI_NONE);
        assert_int_not_equal(material->occlusion_texture.image, ALPI_NONE);
        assert_int_equal(material->occlusion_texture.uv_set, set);
        // the page's grey comes back
        const alp_image *image = new->images[material->occlusion_texture.image];
        assert_non_null(image);
    }
}

static void make_png(alp_context *context, uint8_t **bytes, size_t *size)
{
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){1, 1, 1, ALP_COMPONENT_U8}, &image));
    alp_image_bytes(image)[0] = 128;
    ASSERT_OK(context, alpi_png_encode(image, bytes, size));
    alp_image_destroy(image);
}

static void check_one(const char *file, const variant *v)
{
    alp_context *context = test_context(1);
    alp_scene *old = NULL, *new = NULL;
    ASSERT_OK(context, alp_scene_load(context, scene_path(file), &old));
    float(*uvs)[3][2] = alpi_allocate(context, old->triangle_count, sizeof *uvs);
    uint32_t *pages = alpi_allocate(context, old->triangle_count, sizeof *pages);
    uint32_t *order = alpi_allocate(context, old->triangle_count, sizeof *order);
    invent(old, v, uvs, pages);
    uint8_t *png = NULL;
    size_t png_size = 0;
    make_png(context, &png, &png_size);
    const uint8_t *const pngs[] = {png, png, png};
    const size_t sizes[] = {png_size, png_size, png_size};
    const alpi_mesh_patch patch = {.page_count = v->pages,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .triangle_pages = pages,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes,
                                   .occlusion_strength = 1.0f,
                                   .extras_json = "{\"text\":\"<&>\"}"};
    const char *path = test_path(test_folder(), "out.dae");
    ASSERT_OK(context, alpi_scene_write_patched(old, &patch, path, true));
    ASSERT_OK(context, alp_scene_load(context, path, &new));
    find_order(old, v->pages, pages, order);
    compare(old, new, order, (const float(*)[3][2])uvs);
    alpi_release(context, uvs);
    alpi_release(context, pages);
    alpi_release(context, order);
    alpi_release(context, png);
    alp_scene_destroy(old);
    alp_scene_destroy(new);
    alp_context_destroy(context);
}

TEST(roundtrip)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    static const variant variants[] = {{1, UINT32_MAX / 3}, {1, 5}, {3, 4}};
    for (size_t i = 0; i < SCENE_COUNT; i++) {
        for (size_t k = 0; k < sizeof variants / sizeof *variants; k++) {
            print_message("%s, variant %zu\n", scenes[i].file, k);
            check_one(scenes[i].file, &variants[k]);
        }
    }
}
