// SPDX-License-Identifier: MIT
// Every good glTF scene, patched with made-up coordinates, written, and read again: the same
// triangles with the given coordinates, the old bytes where they were.
#include "test_support.h"
#include "text_check.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_document.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const scenes[] = {
    "architecture/salle_de_bain.glb", // a million triangles: in the first way only
    "architecture/zdm2.glb",
    "architecture/room.glb",
    "architecture/living_room.glb",
    "objects/coffee_maker.glb",
    "objects/dutch_ship/dutch_ship_medium_1k.gltf",
    "objects/scallop.glb",
    "objects/AlphaBlendModeTest.glb",
    "features/CornellBox.glb",
    "features/IrradianceVolumeExample.glb",
    "features/NegativeScaleTest/NegativeScaleTest.gltf",
    "features/MultiUVTest/MultiUVTest.gltf",
    "features/EmissiveStrengthTest/EmissiveStrengthTest.gltf",
    "features/MeshPrimitiveModes/MeshPrimitiveModes.gltf",
    "features/TextureTransformTest/TextureTransformTest.gltf",
    "features/emission_strength/14_emission_strength.gltf",
    "features/single_vs_double_sided/01_single_vs_double_sided.gltf",
    "features/cornell_measured/cornell_box_measured.glb",
    "features/cornell_measured/cornell_box_lights.glb",
};

/// One way of patching a scene.
typedef struct variant {
    uint32_t pages;
    uint32_t chart; // triangles of one surface that share coordinates
    bool to_other;  // the other container

} variant;

/// A 1×1 grey PNG.
static void make_png(alp_context *context, uint8_t **bytes, size_t *size)
{
    alp_image *image = NULL;
    alp_image_info info = {1, 1, 1, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    alp_image_bytes(image)[0] = 128;
    ASSERT_OK(context, alpi_png_encode(image, bytes, size));
    alp_image_destroy(image);
}

/// Coordinates that depend on the vertex and the chart, so that vertices inside a chart need no
/// split.
static void invent(const alp_scene *scene, const variant *v, float (*uvs)[3][2], uint32_t *pages)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[t]];
        uint32_t chart = (t - surface->first_triangle) / v->chart;
        pages[t] = chart % v->pages;
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = scene->vertex_source[scene->triangles[t][k]];
            uvs[t][k][0] = (float)(chart % 1009) / 1009.0f;
            uvs[t][k][1] = (float)(vertex % 4093) / 4093.0f;
        }
    }
}

static char *output_path(size_t index, size_t which, bool glb)
{
    static char path[1024];
    const char *kept = getenv("ALPENGLOW_WRITTEN");
    snprintf(path, sizeof path, "%s/%zu-%zu.%s", kept != NULL ? kept : test_folder(), index, which,
             glb ? "glb" : "gltf");
    return path;
}

static void list_pair(const char *before, const char *after)
{
    const char *kept = getenv("ALPENGLOW_WRITTEN");
    if (kept == NULL) {
        return;
    }
    FILE *list = fopen(test_path(kept, "list"), "a");
    assert_non_null(list);
    fprintf(list, "%s\t%s\n", before, after);
    fclose(list);
}

// --- comparison of scenes ------------------------------------------------------------------------

/// The usable triangles of a node in the order in which the written file has them: first pieces of
/// all primitives, then the other pieces, primitive by primitive.
static size_t order_triangles(const alp_scene *scene, const uint32_t *pages, uint32_t page_count,
                              uint32_t node, uint32_t *order)
{
    size_t count = 0;
    for (int rest = 0; rest < 2; rest++) {
        for (uint32_t s = 0; s < scene->surface_count; s++) {
            const alpi_surface *surface = &scene->surfaces[s];
            if (surface->node != node) {
                continue;
            }
            bool is_first = true;
            for (uint32_t page = 0; page < page_count; page++) {
                bool any = false;
                for (uint32_t i = 0; i < surface->triangle_count; i++) {
                    uint32_t t = surface->first_triangle + i;
                    if (scene->triangle_usable[t] && pages[t] == page) {
                        any = true;
                        if (is_first == (rest == 0)) {
                            order[count++] = t;
                        }
                    }
                }
                is_first &= !any;
            }
        }
    }
    return count;
}

static size_t list_triangles(const alp_scene *scene, uint32_t node, uint32_t *order)
{
    size_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t] && scene->surfaces[scene->triangle_surface[t]].node == node) {
            order[count++] = t;
        }
    }
    return count;
}

/// The coordinates of the map: those of the last set (ours is the first free one).
static void require_same_corner(const alp_scene *a, const alp_scene *b, uint32_t ta, uint32_t tb,
                                int k, const float uv[2])
{
    uint32_t va = a->triangles[ta][k], vb = b->triangles[tb][k];
    const alpi_surface *old = &a->surfaces[a->triangle_surface[ta]];
    const alpi_surface *new = &b->surfaces[b->triangle_surface[tb]];
    assert_memory_equal(a->positions[va], b->positions[vb], sizeof a->positions[va]);
    if (!new->normals_generated) {
        for (int axis = 0; axis < 3; axis++) { // made unit once for each triangle at the vertex
            ASSERT_NEAR(a->normals[va][axis], b->normals[vb][axis], 1e-6);
        }
    }
    if (a->colors != NULL) {
        assert_memory_equal(a->colors[va], b->colors[vb], sizeof a->colors[va]);
    }
    for (uint32_t set = 0; set < old->uv_sets; set++) {
        assert_memory_equal(a->uvs[set][va], b->uvs[set][vb], sizeof a->uvs[set][va]);
    }
    if (old->uv_sets < ALPI_UV_SET_LIMIT) {
        assert_int_equal(new->uv_sets, old->uv_sets + 1);
        assert_memory_equal(b->uvs[old->uv_sets][vb], uv, 2 * sizeof(float));
    }
}

static void require_same_scene(const alp_scene *a, const alp_scene *b, float (*uvs)[3][2],
                               const uint32_t *pages, uint32_t page_count)
{
    assert_int_equal(a->triangle_count, b->triangle_count);
    uint32_t *first = malloc(sizeof(uint32_t) * (a->triangle_count + 1));
    uint32_t *second = malloc(sizeof(uint32_t) * (a->triangle_count + 1));
    assert_non_null(first);
    assert_non_null(second);
    for (uint32_t s = 0; s < a->surface_count; s++) {
        uint32_t node = a->surfaces[s].node;
        if (s > 0 && a->surfaces[s - 1].node == node) {
            continue;
        }
        size_t count = order_triangles(a, pages, page_count, node, first);
        assert_int_equal(count, list_triangles(b, node, second));
        for (size_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++) {
                require_same_corner(a, b, first[i], second[i], k, uvs[first[i]][k]);
            }
        }
    }
    free(first);
    free(second);
}

/// Every written material that a triangle uses has our map: its page is the texture's order.
static void require_maps(const alp_scene *scene)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        assert_int_not_equal(scene->surfaces[s].material, ALPI_NONE);
        const alpi_material *m = &scene->materials[scene->surfaces[s].material];
        assert_int_not_equal(m->occlusion_texture.image, ALPI_NONE);
        assert_int_equal(m->occlusion_texture.wrap_u, ALPI_WRAP_CLAMP);
        if (scene->surfaces[s].uv_sets < ALPI_UV_SET_LIMIT) {
            assert_int_equal(m->occlusion_texture.uv_set, scene->surfaces[s].uv_sets - 1);
        }
    }
}

static void require_old_bytes(const alp_scene *a, const alp_scene *b, const variant *v)
{
    const alpi_gltf_document *old = a->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    const alpi_gltf_document *new = b->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    if (v->to_other) {
        return;
    }
    const size_t gone =
        assert_text_kept(old->text, old->text_size, new->text, new->text_size, patch_may_change);
    for (size_t i = 0; gone == 0 && i < old->buffer_count; i++) { // else bytes may go too
        assert_true(i < new->buffer_count);
        assert_true(new->buffers[i].size >= old->buffers[i].size);
        assert_memory_equal(old->buffers[i].bytes, new->buffers[i].bytes, old->buffers[i].size);
    }
    if (old->is_glb) {
        assert_int_equal(old->more_chunks_size, new->more_chunks_size);
    }
}

static void run_variant(size_t index, size_t which, const variant *v)
{
    alp_context *context = test_context(1);
    alp_scene *scene = NULL, *again = NULL;
    const char *path = test_path(test_shared("scenes"), scenes[index]);
    ASSERT_OK(context, alpi_gltf_read_scene(context, path, &scene));
    bool is_glb = strstr(path, ".glb") != NULL;
    float(*uvs)[3][2] = calloc(scene->triangle_count, sizeof *uvs);
    uint32_t *pages = calloc(scene->triangle_count, sizeof *pages);
    assert_non_null(uvs);
    assert_non_null(pages);
    invent(scene, v, uvs, pages);
    uint8_t *png = NULL;
    size_t png_size = 0;
    make_png(context, &png, &png_size);
    const uint8_t *pngs[2] = {png, png};
    size_t sizes[2] = {png_size, png_size};
    alpi_mesh_patch patch = {.page_count = v->pages,
                             .corner_uvs = (void *)uvs,
                             .triangle_pages = pages,
                             .page_pngs = pngs,
                             .page_png_sizes = sizes,
                             .occlusion_strength = 1.0f,
                             .extras_json = "{\"version\":\"test\"}"};
    char *out = output_path(index, which, is_glb != v->to_other);
    ASSERT_OK(context, alpi_gltf_check_output(scene, v->pages, out, false));
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, out, false));
    list_pair(path, out);
    ASSERT_OK(context, alpi_gltf_read_scene(context, out, &again));
    require_same_scene(scene, again, uvs, pages, v->pages);
    require_maps(again);
    require_old_bytes(scene, again, v);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
    alpi_release(context, png);
    free(uvs);
    free(pages);
    alp_context_destroy(context);
}

static void run_all(const variant *v, size_t which)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = which > 0; i < sizeof scenes / sizeof *scenes; i++) {
        print_message("%s\n", scenes[i]);
        run_variant(i, which, v);
    }
}

TEST_SLOW(one_page)
{
    run_all(&(variant){.pages = 1, .chart = 50}, 0);
}

TEST_SLOW(two_pages_each_triangle_alone)
{
    run_all(&(variant){.pages = 2, .chart = 1}, 1);
}

TEST(the_other_container)
{
    run_all(&(variant){.pages = 2, .chart = 400, .to_other = true}, 2);
}
