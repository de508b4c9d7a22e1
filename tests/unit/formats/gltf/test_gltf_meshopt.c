// SPDX-License-Identifier: MIT
// EXT_meshopt_compression, encoded by libmeshoptimizer: every mode and filter, patching, and
// streams that are damaged.
#include "pack_asset.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_read.h"

#include <meshoptimizer.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define ONE_MESH                                                                                   \
    "'extensionsUsed':['EXT_meshopt_compression'],'extensionsRequired':['EXT_meshopt_"             \
    "compression'],'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{"            \
    "'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},'indices':3}]}]"

static uint8_t encoded[PACK_BIN_LIMIT];

static int pack_vertices(pack_asset *asset, const void *vertices, size_t stride, const char *filter)
{
    size_t size =
        meshopt_encodeVertexBuffer(encoded, sizeof encoded, vertices, WAVE_VERTICES, stride);
    assert_true(size > 0);
    return pack_meshopt(asset, encoded, size, "ATTRIBUTES", filter, WAVE_VERTICES, stride);
}

/// Triangles may come back turned in their three corners, so the plain scene is made of the same.
static int pack_triangles(pack_asset *asset, bool as_sequence, size_t stride)
{
    const wave *w = wave_mesh();
    const size_t count = 3 * WAVE_TRIANGLES;
    size_t size = as_sequence
                      ? meshopt_encodeIndexSequence(encoded, sizeof encoded, w->indices, count)
                      : meshopt_encodeIndexBuffer(encoded, sizeof encoded, w->indices, count);
    assert_true(size > 0);
    return pack_meshopt(asset, encoded, size, as_sequence ? "INDICES" : "TRIANGLES", NULL, count,
                        stride);
}

/// The wave with all of it compressed. @param stride of indices: 2 or 4
static const char *write_wave_as(bool as_gltf, bool as_sequence, size_t stride)
{
    const wave *w = wave_mesh();
    pack_asset *asset = pack_start();
    asset->as_gltf = as_gltf;
    pack_accessor(asset, pack_vertices(asset, w->positions, 12, NULL), 5126, WAVE_VERTICES, "VEC3",
                  WAVE_BOUNDS);
    pack_accessor(asset, pack_vertices(asset, w->normals, 12, "NONE"), 5126, WAVE_VERTICES, "VEC3",
                  "");
    pack_accessor(asset, pack_vertices(asset, w->uvs, 8, NULL), 5126, WAVE_VERTICES, "VEC2", "");
    pack_accessor(asset, pack_triangles(asset, as_sequence, stride), stride == 2 ? 5123 : 5125,
                  3 * WAVE_TRIANGLES, "SCALAR", "");
    return pack_write(asset, ONE_MESH);
}

static const char *write_wave(bool as_sequence, size_t stride)
{
    return write_wave_as(false, as_sequence, stride);
}

/// Whether both hold the same corners, each triangle from the corner it likes.
static bool same_triangle(const alp_scene *a, const alp_scene *b, uint32_t t)
{
    vec3 one[3], two[3];
    alpi_triangle_corners(a, t, one);
    alpi_triangle_corners(b, t, two);
    for (int turn = 0; turn < 3; turn++) {
        bool same = true;
        for (int k = 0; k < 3; k++) {
            const vec3 a_corner = one[k], b_corner = two[(k + turn) % 3];
            same = same && a_corner.x == b_corner.x && a_corner.y == b_corner.y &&
                   a_corner.z == b_corner.z;
        }
        if (same) {
            return true;
        }
    }
    return false;
}

TEST_WITH_CONTEXT(modes_are_exact, 1)
{
    alp_scene *plain = wave_scene(context);
    const wave *w = wave_mesh();
    for (int variant = 0; variant < 4; variant++) {
        alp_scene *scene = NULL;
        const char *path = write_wave(variant % 2 == 1, variant < 2 ? 4 : 2);
        ASSERT_OK(context, alp_scene_load(context, path, &scene));
        assert_int_equal(scene->triangle_count, WAVE_TRIANGLES);
        assert_int_equal(scene->vertex_count, WAVE_VERTICES);
        assert_memory_equal(scene->positions, w->positions, sizeof w->positions);
        assert_memory_equal(scene->normals, plain->normals, sizeof w->normals);
        assert_memory_equal(scene->uvs[0], w->uvs, sizeof w->uvs);
        for (uint32_t t = 0; t < WAVE_TRIANGLES; t++) {
            assert_true(same_triangle(plain, scene, t));
        }
        assert_true(wave_occlusion_difference(plain, scene) <= 1e-4);
        alp_scene_destroy(scene);
    }
    alp_scene_destroy(plain);
}

static double largest_angle(const alp_scene *a, const alp_scene *b)
{
    double least = 1.0;
    for (uint32_t v = 0; v < WAVE_VERTICES; v++) {
        least = fmin(least, (double)vec3_dot(vec3_load(a->normals[v]), vec3_load(b->normals[v])));
    }
    return acos(fmin(least, 1.0));
}

/// Normals of 8 and 16 bits by the octahedral filter, positions by the exponential one.
TEST_WITH_CONTEXT(filters_of_vertices, 1)
{
    const wave *w = wave_mesh();
    static float four[WAVE_VERTICES][4];
    static int16_t normals[WAVE_VERTICES][4];
    static uint32_t exponents[WAVE_VERTICES][3];
    alp_scene *plain = wave_scene(context);
    for (int v = 0; v < WAVE_VERTICES; v++) {
        memcpy(four[v], w->normals[v], sizeof w->normals[v]);
        four[v][3] = 0.0f;
    }
    for (int bytes = 1; bytes <= 2; bytes++) {
        pack_asset *asset = pack_start();
        const int bits = bytes == 1 ? 8 : 12;
        meshopt_encodeFilterExp(exponents, WAVE_VERTICES, 12, 20, &w->positions[0][0]);
        meshopt_encodeFilterOct(normals, WAVE_VERTICES, 4 * (size_t)bytes, bits, &four[0][0]);
        pack_accessor(asset, pack_vertices(asset, exponents, 12, "EXPONENTIAL"), 5126,
                      WAVE_VERTICES, "VEC3", WAVE_BOUNDS);
        pack_accessor(asset, pack_vertices(asset, normals, 4 * (size_t)bytes, "OCTAHEDRAL"),
                      bytes == 1 ? 5120 : 5122, WAVE_VERTICES, "VEC3", ",'normalized':true");
        pack_accessor(asset, pack_vertices(asset, w->uvs, 8, NULL), 5126, WAVE_VERTICES, "VEC2",
                      "");
        pack_accessor(asset, pack_triangles(asset, true, 4), 5125, 3 * WAVE_TRIANGLES, "SCALAR",
                      "");
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, pack_write(asset, ONE_MESH), &scene));
        // 20 bits of mantissa, its sign among them, shared by a vertex of size up to 1 (or 2^1)
        ASSERT_NEAR(wave_distance(plain, scene), 0.0, sqrt(3.0) * ldexp(1.0, -18));
        // Half a step of the octahedron in each axis, and of the result; a step is at most twice
        // as wide on the sphere.
        ASSERT_NEAR(largest_angle(plain, scene), 0.0, 4.0 / (bytes == 1 ? 127.0 : 2047.0));
        assert_true(largest_angle(plain, scene) > 0.0);
        alp_scene_destroy(scene);
    }
    alp_scene_destroy(plain);
}

/// Quaternions have no place in a mesh but in the instances of one.
TEST_WITH_CONTEXT(filter_of_rotations, 1)
{
    enum { COUNT = 9 };
    float rotations[COUNT][4];
    int16_t packed[COUNT][4];
    const wave *w = wave_mesh();
    pack_asset *asset = pack_start();
    for (int i = 0; i < COUNT; i++) {
        const double angle = 0.3 * i; // about y
        const float q[4] = {0.0f, (float)sin(angle / 2), 0.0f, (float)cos(angle / 2)};
        memcpy(rotations[i], q, sizeof q);
    }
    meshopt_encodeFilterQuat(packed, COUNT, 8, 16, &rotations[0][0]);
    size_t size = meshopt_encodeVertexBuffer(encoded, sizeof encoded, packed, COUNT, 8);
    pack_accessor(asset, pack_view(asset, w->positions, 3 * 12, 0), 5126, 3, "VEC3",
                  ",'min':[0,0,0],'max':[1,1,1]");
    pack_accessor(asset, pack_meshopt(asset, encoded, size, "ATTRIBUTES", "QUATERNION", COUNT, 8),
                  5122, COUNT, "VEC4", ",'normalized':true");
    const char *path = pack_write(
        asset, "'extensionsUsed':['EXT_mesh_gpu_instancing','EXT_meshopt_compression'],'nodes':[{"
               "'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{'ROTATION':1}}}}],"
               "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]");
    alp_scene *scene = test_load(context, path);
    assert_int_equal(scene->surface_count, COUNT);
    for (int i = 0; i < COUNT; i++) { // vertex 1 of the wave: x turned about y
        const float *p = scene->positions[scene->surfaces[i].first_vertex + 1];
        const double x = (double)w->positions[1][0], z = (double)w->positions[1][2];
        ASSERT_NEAR(p[0], x * cos(0.3 * i) + z * sin(0.3 * i), 1e-4); // 15 bits of a half angle
        ASSERT_NEAR(p[2], z * cos(0.3 * i) - x * sin(0.3 * i), 1e-4);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(patched_is_plain, 1)
{
    static const char *const endings[] = {".glb", ".gltf"};
    for (int i = 0; i < 2; i++) {
        test_log_clear();
        alp_scene *scene = pack_patch(context, write_wave(false, 2), endings[i], 0.0);
        assert_true(test_log_has("compression"));
        const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
        json_t *mesh = alpi_gltf_item(document, "meshes", 0);
        json_t *primitive = json_array_get(json_object_get(mesh, "primitives"), 0);
        const char *name;
        json_t *accessor;
        json_object_foreach(json_object_get(primitive, "attributes"), name, accessor)
        {
            size_t view;
            ASSERT_OK(context, alpi_gltf_index(document,
                                               alpi_gltf_item(document, "accessors",
                                                              (size_t)json_integer_value(accessor)),
                                               "bufferView", "bufferViews", name, &view));
            assert_true(view >= document->decoded_view_count ||
                        document->decoded_views[view] == NULL);
        }
        alp_scene_destroy(scene);
    }
}

/// A .gltf with the compressed bytes in one file and the fallback in another, which is not there.
TEST_WITH_CONTEXT(fallback_is_not_needed, 1)
{
    alp_scene *plain = wave_scene(context), *scene = NULL, *again = NULL;
    const char *path = write_wave_as(true, true, 4);
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    assert_true(wave_distance(plain, scene) == 0.0);
    // Into one GLB, uncompressed: nothing reads the fallback any more.
    again = pack_patch(context, path, ".glb", 0.0);
    assert_true(wave_distance(plain, again) == 0.0);
    const alpi_gltf_document *document = again->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
    assert_int_equal(document->buffer_count, 1);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
    alp_scene_destroy(plain);
}

// --- harm ----------------------------------------------------------------------------------------

static alp_result read_bytes(alp_context *context, const uint8_t *bytes, size_t size)
{
    uint8_t *copy = alpi_allocate(context, size, 1); // as long as the data: a sanitizer looks on
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    alpi_gltf_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result = alpi_gltf_document_parse(context, "bad.glb", copy, size, &document);
    result = result == ALP_OK ? alpi_gltf_scene_from_document(document, &scene) : result;
    alp_scene_destroy(scene);
    return result;
}

static unsigned char *find(unsigned char *bytes, size_t size, const char *text)
{
    for (size_t i = 0; i + strlen(text) <= size; i++) {
        if (memcmp(bytes + i, text, strlen(text)) == 0) {
            return bytes + i;
        }
    }
    return NULL;
}

/// Numbers of the first view that lie about the stream.
TEST_WITH_CONTEXT(wrong_numbers, 1)
{
    static const struct {
        const char *before, *after, *words;
        alp_result code;
    } cases[] = {
        {"\"count\":1152", "\"count\":1151", "bufferView 0: byteLength is 13824",
         ALP_ERROR_INVALID_DATA},
        {"\"byteStride\":12", "\"byteStride\":16", "bufferView 0: byteStride 16",
         ALP_ERROR_INVALID_DATA},
        {"\"mode\":\"ATTRIBUTES\"", "\"mode\":\"ATTRIBUTEX\"", "bufferView 0: mode \"ATTRIBUTEX\"",
         ALP_ERROR_INVALID_DATA},
        {"\"mode\":\"TRIANGLES\"", "\"mode\":\"INDICES\"  ",
         "bufferView 3: ", ALP_ERROR_INVALID_DATA},
        {"\"filter\":\"NONE\"", "\"filter\":\"N\"   ",
         "bufferView 1: mode \"ATTRIBUTES\" with "
         "filter \"N\"",
         ALP_ERROR_INVALID_DATA},
        {"\"EXT_meshopt_compression\":{\"buffer\":0", "\"EXT_meshopt_compression\":{\"buffer\":1",
         "bufferView 0: its compressed bytes lie in buffer 1, which is a fallback",
         ALP_ERROR_INVALID_DATA},
    };
    size_t size;
    unsigned char *good = test_read_file(write_wave(false, 4), &size);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const size_t length = strlen(cases[i].before);
        assert_int_equal(length, strlen(cases[i].after));
        unsigned char *bad = malloc(size);
        assert_non_null(bad);
        memcpy(bad, good, size);
        unsigned char *place = find(bad, size, cases[i].before);
        assert_non_null(place);
        memcpy(place, cases[i].after, length);
        assert_int_equal(read_bytes(context, bad, size), cases[i].code);
        test_message_has(context, cases[i].words);
        free(bad);
    }
    free(good);
}

/// Four thousand million elements out of forty bytes: refused before memory is asked for.
TEST_WITH_CONTEXT(short_streams_ask_for_little, 1)
{
    static const struct {
        const char *view, *words;
        alp_result code;
    } cases[] = {
        {"'byteLength':68719476720,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
         "'byteLength':40,'byteStride':16,'mode':'ATTRIBUTES','count':4294967295}}",
         "bufferView 0: 40 compressed bytes cannot hold 4294967295 elements",
         ALP_ERROR_INVALID_DATA},
        {"'byteLength':12000,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
         "'byteLength':40,'byteStride':4,'mode':'TRIANGLES','count':3000}}",
         "bufferView 0: 40 compressed bytes cannot hold", ALP_ERROR_INVALID_DATA},
        {"'byteLength':16,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
         "'byteLength':40,'byteStride':4,'mode':'TRIANGLES','count':4}}",
         "bufferView 0: 4 compressed indices make no triangles", ALP_ERROR_INVALID_DATA},
        {"'byteLength':12,'extensions':{'EXT_meshopt_compression':{'buffer':0,"
         "'byteOffset':8,'byteLength':40,'byteStride':4,'mode':'TRIANGLES','count':3}}",
         "pass the end of buffer 0 (40 bytes)", ALP_ERROR_INVALID_DATA},
    };
    static const uint8_t zeros[40];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[1024];
        alp_scene *scene = NULL;
        snprintf(
            json, sizeof json,
            "{'asset':{'version':'2.0'},'buffers':[{'byteLength':40},{'byteLength':68719476720,"
            "'extensions':{'EXT_meshopt_compression':{'fallback':true}}}],"
            "'bufferViews':[{'buffer':1,%s}]}",
            cases[i].view);
        assert_int_equal(test_gltf_scene(context, json, zeros, sizeof zeros, &scene),
                         cases[i].code);
        test_message_has(context, cases[i].words);
    }
}

/// Streams cut off and changed at every place in turn: an error that names the view, or a scene.
TEST_WITH_CONTEXT(damaged_streams, 1)
{
    size_t size;
    unsigned char *good = test_read_file(write_wave(false, 4), &size);
    const size_t text = 20 + (size_t)good[12] + ((size_t)good[13] << 8);
    unsigned char *bad = malloc(size);
    assert_non_null(bad);
    int refused = 0, named = 0;
    uint64_t seed = 1;
    for (int round = 0; round < 3000; round++) {
        memcpy(bad, good, size);
        for (int i = 0; i < 1 + round % 5; i++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
            bad[text + 8 + (seed >> 33) % (size - text - 8)] = (unsigned char)(seed >> 20);
        }
        if (read_bytes(context, bad, size) != ALP_OK) {
            refused++;
            named += strstr(alp_context_message(context), "bufferView") != NULL ||
                     strstr(alp_context_message(context), "index") != NULL; // out of range
        }
    }
    print_message("%d of 3000 damaged files refused\n", refused);
    assert_true(refused > 300);
    assert_int_equal(named, refused);
    free(bad);
    free(good);
}
