// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression, encoded by libdraco: what comes back, patching, and streams that are
// damaged. A build without libdraco refuses by name.
#include "pack_asset.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define DRACO "'KHR_draco_mesh_compression'"

/// Builds with and without the decoder say this of a file that needs it.
TEST_WITH_CONTEXT(refused_by_name, 1)
{
    if (alpi_draco_is_built()) {
        skip();
    }
    alp_scene *scene = NULL;
    static const char *const files[] = {
        "{'asset':{'version':'2.0'},'extensionsRequired':[" DRACO "]}",
        "{'asset':{'version':'2.0'},'accessors':[{'componentType':5126,'count':3,'type':'VEC3'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'extensions':{" DRACO
        ":{'bufferView':0,'attributes':{'POSITION':0}}}}]}]}"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(test_gltf_scene(context, files[i], NULL, 0, &scene),
                         ALP_ERROR_UNSUPPORTED);
        test_message_has(context, "KHR_draco_mesh_compression");
        test_message_has(context, "build with libdraco");
    }
}

#ifdef HAS_DRACO_ENCODER

#include "draco_encode.h"

static uint8_t encoded[PACK_BIN_LIMIT];

static draco_input wave_input(void)
{
    const wave *w = wave_mesh();
    return (draco_input){.positions = w->positions,
                         .normals = w->normals,
                         .uvs = w->uvs,
                         .vertex_count = WAVE_VERTICES,
                         .indices = w->indices,
                         .index_count = 3 * WAVE_TRIANGLES};
}

/// Writes the wave. @param mode members of the primitive, with a comma behind
static const char *write_wave(const draco_input *input, const char *mode, uint32_t index_count)
{
    uint32_t points = 0;
    char rest[1024];
    const size_t size = draco_encode(input, encoded, sizeof encoded, &points);
    assert_true(size > 0 && points > 0);
    pack_asset *asset = pack_start();
    const int view = pack_view(asset, encoded, size, 0);
    pack_accessor(asset, -1, 5126, points, "VEC3", WAVE_BOUNDS);
    pack_accessor(asset, -1, 5126, points, "VEC3", "");
    pack_accessor(asset, -1, 5126, points, "VEC2", "");
    pack_accessor(asset, -1, 5125, index_count, "SCALAR", "");
    snprintf(
        rest, sizeof rest,
        "'extensionsUsed':[" DRACO "],'extensionsRequired':[" DRACO "],"
        "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{'primitives':[{%s"
        "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},'indices':3,'extensions':{" DRACO
        ":{'bufferView':%d,'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2}}}}]}]",
        mode, view);
    return pack_write(asset, rest);
}

/// A triangle's corners on the wave's grid, from the smallest on, so that order does not count.
typedef struct grid_triangle {
    int corners[3][3];
} grid_triangle;

static int compare_triangles(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(grid_triangle));
}

static grid_triangle *grid_triangles(const alp_scene *scene, double *most_off)
{
    grid_triangle *list = malloc(sizeof *list * scene->triangle_count);
    assert_non_null(list);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        int corners[3][3], first = 0;
        for (int k = 0; k < 3; k++) {
            for (int axis = 0; axis < 3; axis++) {
                double value = (double)scene->positions[scene->triangles[t][k]][axis] * 4096.0;
                corners[k][axis] = (int)lround(value);
                *most_off = fmax(*most_off, fabs(value - corners[k][axis]) / 4096.0);
            }
            first = memcmp(corners[k], corners[first], sizeof *corners) < 0 ? k : first;
        }
        for (int k = 0; k < 3; k++) {
            memcpy(list[t].corners[k], corners[(first + k) % 3], sizeof *corners);
        }
    }
    qsort(list, scene->triangle_count, sizeof *list, compare_triangles);
    return list;
}

/// In its own order and without quantisation nothing changes; there may be metadata before it.
TEST_WITH_CONTEXT(sequential_is_exact, 1)
{
    alp_scene *plain = wave_scene(context);
    for (int metadata = 0; metadata < 2; metadata++) {
        alp_scene *scene = NULL;
        draco_input input = wave_input();
        input.is_sequential = 1;
        input.has_metadata = metadata;
        ASSERT_OK(context,
                  alp_scene_load(context, write_wave(&input, "", input.index_count), &scene));
        assert_true(wave_distance(plain, scene) == 0.0);
        assert_true(wave_occlusion_difference(plain, scene) == 0.0);
        alp_scene_destroy(scene);
    }
    alp_scene_destroy(plain);
}

TEST_WITH_CONTEXT(edgebreaker, 1)
{
    static const int bits[] = {0, 13, 20};
    alp_scene *plain = wave_scene(context);
    double off = 0.0;
    grid_triangle *wanted = grid_triangles(plain, &off);
    assert_true(off == 0.0);
    for (size_t i = 0; i < sizeof bits / sizeof *bits; i++) {
        alp_scene *scene = NULL;
        draco_input input = wave_input();
        input.position_bits = bits[i];
        ASSERT_OK(context,
                  alp_scene_load(context, write_wave(&input, "", input.index_count), &scene));
        assert_int_equal(scene->triangle_count, WAVE_TRIANGLES);
        off = 0.0;
        grid_triangle *found = grid_triangles(scene, &off);
        assert_memory_equal(wanted, found, sizeof *found * WAVE_TRIANGLES);
        // Half a step of the quantisation of the range 1, and the rounding of its floats.
        assert_true(off <= (bits[i] == 0 ? 0.0 : 0.5 / (ldexp(1.0, bits[i]) - 1.0) + 1.2e-7));
        // Receivers stand in the air: hits move only where a silhouette moves past a ray.
        assert_true(bits[i] == 13 || wave_occlusion_difference(plain, scene) <= 1e-4);
        free(found);
        alp_scene_destroy(scene);
    }
    free(wanted);
    alp_scene_destroy(plain);
}

/// Draco makes triangles of strips; the count of the accessor is still the strip's.
TEST_WITH_CONTEXT(strips_come_as_triangles, 1)
{
    alp_scene *scene = NULL;
    draco_input input = wave_input();
    ASSERT_OK(context,
              alp_scene_load(context, write_wave(&input, "'mode':5,", WAVE_TRIANGLES + 2), &scene));
    assert_int_equal(scene->triangle_count, WAVE_TRIANGLES);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(patched_is_plain, 1)
{
    static const char *const endings[] = {".glb", ".gltf"};
    for (int i = 0; i < 2; i++) {
        draco_input input = wave_input();
        input.position_bits = 14;
        test_log_clear();
        alp_scene *scene = pack_patch(context,
                                      write_wave(&input, i == 0 ? "" : "'mode':5,",
                                                 i == 0 ? input.index_count : WAVE_TRIANGLES + 2),
                                      endings[i], 0.0);
        assert_true(test_log_has("compression"));
        const alpi_gltf_document *document = scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
        assert_int_equal(document->decoded_count, 0);
        assert_null(json_object_get(document->root, "extensionsRequired"));
        assert_null(json_object_get(document->root, "extensionsUsed"));
        alp_scene_destroy(scene);
    }
}

// --- harm ----------------------------------------------------------------------------------------

static alp_result read_bytes(alp_context *context, const uint8_t *bytes, size_t size)
{
    uint8_t *copy = alpi_allocate(context, size, 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    alpi_gltf_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result = alpi_gltf_document_parse(context, "bad.glb", copy, size, &document);
    result = result == ALP_OK ? alpi_gltf_scene_from_document(document, &scene) : result;
    alp_scene_destroy(scene);
    return result;
}

static size_t bin_begin(const unsigned char *glb)
{
    return 28 + (size_t)glb[12] + ((size_t)glb[13] << 8) + ((size_t)glb[14] << 16);
}

/// Asset and stream agree on 100 million triangles, for which the decoder would ask for gigabytes.
static void check_short_stream_that_agrees(alp_context *context)
{
    static const unsigned char stream[40] = {'D',  'R',  'A',  'C',  'O',  2,    2,
                                             1,    1,    0,    0,    0,    0x80, 0xc2,
                                             0xd7, 0x2f, 0x80, 0xc2, 0xd7, 0x2f};
    static const char json[] =
        "{'asset':{'version':'2.0'},'buffers':[{'byteLength':40}],'bufferViews':[{'buffer':0,"
        "'byteLength':40}],'accessors':[{'componentType':5126,'count':100000000,'type':'VEC3'},"
        "{'componentType':5125,'count':300000000,'type':'SCALAR'}],'meshes':[{'primitives':[{"
        "'attributes':{'POSITION':0},'indices':1,'extensions':{" DRACO
        ":{'bufferView':0,'attributes':{'POSITION':0}}}}]}]}";
    alp_scene *scene = NULL;
    assert_int_equal(test_gltf_scene(context, json, stream, sizeof stream, &scene),
                     ALP_ERROR_INVALID_DATA);
    test_message_has(context, "they are too few for so many triangles (100000000 vertices and "
                              "100000000 triangles are stated)");
}

/// Every stream cut short, and one that says it holds four thousand million triangles.
TEST_WITH_CONTEXT(streams_that_lie, 1)
{
    size_t size;
    draco_input input = wave_input();
    unsigned char *good = test_read_file(write_wave(&input, "", input.index_count), &size);
    const size_t begin = bin_begin(good);
    unsigned char *bad = malloc(size);
    assert_non_null(bad);
    // magic 5, version 2, kind, method, flags 2, traversal: varints of vertices and faces follow
    static const unsigned char many[] = {0x80, 9, 0xff, 0xff, 0xff, 0xff, 0x0f};
    memcpy(bad, good, size);
    memcpy(bad + begin + 12, many, sizeof many);
    assert_int_equal(read_bytes(context, bad, size), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "bufferView 0 cannot be decoded: they hold another number of tri");
    memcpy(bad, good, size);
    bad[begin] = 'X';
    assert_int_equal(read_bytes(context, bad, size), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "do not begin with DRACO");
    for (size_t cut = 1; cut < 2000 && cut < size - begin; cut += 1 + cut / 20) {
        memcpy(bad, good, size);
        memset(bad + begin + cut, 0, size - begin - cut);
        (void)!read_bytes(context, bad, size);
        memset(bad + begin + cut, 0xff, size - begin - cut);
        (void)!read_bytes(context, bad, size);
    }
    check_short_stream_that_agrees(context);
    free(bad);
    free(good);
}

TEST_WITH_CONTEXT(damaged_streams, 1)
{
    int refused = 0, named = 0;
    uint64_t seed = 1;
    for (int variant = 0; variant < 3; variant++) {
        size_t size;
        draco_input input = wave_input();
        input.is_sequential = variant == 2;
        input.position_bits = variant == 1 ? 11 : 0;
        input.has_metadata = variant == 1;
        unsigned char *good = test_read_file(write_wave(&input, "", input.index_count), &size);
        const size_t begin = bin_begin(good);
        unsigned char *bad = malloc(size);
        assert_non_null(bad);
        for (int round = 0; round < 700; round++) {
            memcpy(bad, good, size);
            for (int i = 0; i < 1 + round % 5; i++) {
                seed = seed * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
                const size_t range = round % 2 == 0 ? 300 : size - begin;
                bad[begin + (seed >> 33) % range] = (unsigned char)(seed >> 20);
            }
            if (read_bytes(context, bad, size) != ALP_OK) {
                refused++;
                named += strstr(alp_context_message(context), "bufferView") != NULL ||
                         strstr(alp_context_message(context), "index") != NULL;
            }
        }
        free(bad);
        free(good);
    }
    print_message("%d of 2100 damaged files refused\n", refused);
    assert_true(refused > 300);
    assert_int_equal(named, refused);
}

/// What the asset says of the stream, changed.
TEST_WITH_CONTEXT(accessors_that_do_not_fit, 1)
{
    static const struct {
        const char *before, *after, *words;
    } cases[] = {
        {"\"count\":6348", "\"count\":6345", "hold another number of triangles"},
        {"\"type\":\"VEC2\"", "\"type\":\"VEC4\"", "bufferView 0 holds no attribute 2 like"},
        {"\"TEXCOORD_0\":2}}", "\"TEXCOORD_0\":7}}", "bufferView 0 holds no attribute 7 like"},
        {"\"bufferView\":0,\"attr", "\"bufferView\":9,\"attr", "bufferView is 9, but there is"},
        {"\"indices\":3", "\"indexes\":3", "is compressed, but has no indices"},
    };
    size_t size;
    draco_input input = wave_input();
    unsigned char *good = test_read_file(write_wave(&input, "", input.index_count), &size);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const size_t length = strlen(cases[i].before);
        unsigned char *bad = malloc(size);
        assert_non_null(bad);
        memcpy(bad, good, size);
        size_t at = 0;
        while (at + length < size && memcmp(bad + at, cases[i].before, length) != 0) {
            at++;
        }
        assert_true(at + length < size);
        memcpy(bad + at, cases[i].after, length);
        assert_int_equal(read_bytes(context, bad, size), ALP_ERROR_INVALID_DATA);
        test_message_has(context, cases[i].words);
        free(bad);
    }
    free(good);
}

/// An attribute that is shorter or longer than the vertices of the stream, and more of them than
/// are decoded: before memory is asked for.
TEST_WITH_CONTEXT(counts_that_differ, 1)
{
    static const char end[] = ",\"type\":\"VEC2\"";
    size_t size, at = 0;
    draco_input input = wave_input();
    unsigned char *bytes = test_read_file(write_wave(&input, "", input.index_count), &size);
    while (memcmp(bytes + at, end, sizeof end - 1) != 0) {
        at++;
    }
    const unsigned char digit = bytes[at - 1]; // the last of its count
    for (int other = '0'; other <= '9'; other++) {
        if (other != digit) {
            bytes[at - 1] = (unsigned char)other;
            assert_int_equal(read_bytes(context, bytes, size), ALP_ERROR_INVALID_DATA);
            test_message_has(context, "TEXCOORD_0 (accessor 2) has");
        }
    }
    free(bytes);
    alp_scene *scene = NULL;
    assert_int_equal(
        test_gltf_scene(context,
                        "{'asset':{'version':'2.0'},'buffers':[{'byteLength':4}],'bufferViews':[{"
                        "'buffer':0,'byteLength':4}],'accessors':[{'componentType':5126,'count':"
                        "134217729,'type':'VEC3'},{'componentType':5125,'count':3,'type':'SCALAR'}"
                        "],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,"
                        "'extensions':{" DRACO
                        ":{'bufferView':0,'attributes':{'POSITION':0}}}}]}]}",
                        (const uint8_t *)"1234", 4, &scene),
        ALP_ERROR_LIMIT);
    test_message_has(context, "134217729 compressed vertices, more than the limit of 134217728");
}

#endif
