// SPDX-License-Identifier: MIT
// A mesh is a mesh, whatever file it came in: the same triangles through glTF, COLLADA and OBJ bake
// to the same occlusion. Nine digits of a decimal number give back the same float, so the receivers
// are the same to the bit; what may differ is the order of vertices, and that must not matter.
#include "test_collada.h"
#include "test_gltf.h"
#include "test_obj.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 64, SAMPLES = 64 };

/// Text that grows.
typedef struct text {
    char *characters;
    size_t length, capacity;
} text;

static void append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void append(text *t, const char *format, ...)
{
    enum { LONGEST = 1024 };
    if (t->capacity - t->length < LONGEST) {
        t->capacity = 2 * t->capacity + LONGEST;
        t->characters = realloc(t->characters, t->capacity);
        assert_non_null(t->characters);
    }
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(t->characters + t->length, LONGEST, format, arguments);
    va_end(arguments);
    assert_in_range(length, 0, LONGEST - 1);
    t->length += (size_t)length;
}

static void append_vectors(text *t, const char *before, const float (*v)[3], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        append(t, "%s%.9g %.9g %.9g\n", before, (double)v[i][0], (double)v[i][1], (double)v[i][2]);
    }
}

static alp_scene *through_obj(alp_context *context, const alp_scene *s)
{
    text t = {NULL, 0, 0};
    append_vectors(&t, "v ", (const float(*)[3])s->positions, s->vertex_count);
    append_vectors(&t, "vn ", (const float(*)[3])s->normals, s->vertex_count);
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const uint32_t *c = s->triangles[i];
        append(&t, "f %u//%u %u//%u %u//%u\n", c[0] + 1, c[0] + 1, c[1] + 1, c[1] + 1, c[2] + 1,
               c[2] + 1);
    }
    alp_scene *scene = test_obj_scene(context, t.characters);
    free(t.characters);
    return scene;
}

static void append_source(text *t, const char *id, const float (*v)[3], uint32_t count)
{
    append(t, "<source id='%s'><float_array id='%s-a' count='%u'>", id, id, 3 * count);
    append_vectors(t, "", v, count);
    append(t,
           "</float_array><technique_common><accessor source='#%s-a' count='%u' stride='3'>"
           "<param name='X' type='float'/><param name='Y' type='float'/>"
           "<param name='Z' type='float'/></accessor></technique_common></source>",
           id, count);
}

static alp_scene *through_collada(alp_context *context, const alp_scene *s)
{
    text t = {NULL, 0, 0};
    append(&t, "<asset><unit meter='1'/><up_axis>Y_UP</up_axis></asset>"
               "<library_geometries><geometry id='g'><mesh>");
    append_source(&t, "p", (const float(*)[3])s->positions, s->vertex_count);
    append_source(&t, "n", (const float(*)[3])s->normals, s->vertex_count);
    append(&t,
           "<vertices id='v'><input semantic='POSITION' source='#p'/>"
           "<input semantic='NORMAL' source='#n'/></vertices><triangles count='%u'>"
           "<input semantic='VERTEX' source='#v' offset='0'/><p>",
           s->triangle_count);
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        append(&t, "%u %u %u\n", s->triangles[i][0], s->triangles[i][1], s->triangles[i][2]);
    }
    append(&t, "</p></triangles></mesh></geometry></library_geometries>%s", TEST_COLLADA_SHOWN);
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_collada_scene(context, t.characters, &scene));
    free(t.characters);
    return scene;
}

static alp_scene *through_gltf(alp_context *context, const alp_scene *s)
{
    const size_t vectors = sizeof(float[3]) * s->vertex_count,
                 indices = sizeof(uint32_t[3]) * s->triangle_count;
    uint8_t *bin = malloc(2 * vectors + indices);
    assert_non_null(bin);
    memcpy(bin, s->positions, vectors);
    memcpy(bin + vectors, s->normals, vectors);
    memcpy(bin + 2 * vectors, s->triangles, indices);
    text t = {NULL, 0, 0};
    append(&t, "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],"
               "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':"
               "{'POSITION':0,'NORMAL':1},'indices':2}]}],");
    append(&t,
           "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':%u},"
           "{'bufferView':1,'componentType':5126,'type':'VEC3','count':%u},"
           "{'bufferView':2,'componentType':5125,'type':'SCALAR','count':%u}],",
           s->vertex_count, s->vertex_count, 3 * s->triangle_count);
    append(&t,
           "'bufferViews':[{'buffer':0,'byteLength':%zu},{'buffer':0,'byteOffset':%zu,"
           "'byteLength':%zu},{'buffer':0,'byteOffset':%zu,'byteLength':%zu}],"
           "'buffers':[{'byteLength':%zu}]}",
           vectors, vectors, vectors, 2 * vectors, indices, 2 * vectors + indices);
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_gltf_scene(context, t.characters, bin, 2 * vectors + indices, &scene));
    free(t.characters);
    free(bin);
    return scene;
}

static alp_lightmap *bake(alp_context *context, const alp_scene *scene)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = SIZE;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = SAMPLES;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    return lightmap;
}

/// Root mean square difference of two maps over the texels of the first, and the receivers' too:
/// where each corner of each triangle lies in the atlas.
static void compare(const alp_lightmap *a, const alp_lightmap *b, const alp_scene *scene,
                    const char *name)
{
    const float *x = alp_lightmap_page(a, 0, NULL, NULL), *y = alp_lightmap_page(b, 0, NULL, NULL);
    assert_memory_equal(alp_atlas_corner_uvs(alp_lightmap_atlas(a)),
                        alp_atlas_corner_uvs(alp_lightmap_atlas(b)),
                        sizeof(float[6]) * scene->triangle_count);
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        assert_true((x[4 * i + 3] > 0.0f) == (y[4 * i + 3] > 0.0f)); // the same texels
        if (x[4 * i + 3] > 0.0f) {
            const double difference = (double)x[4 * i] - (double)y[4 * i];
            sum += difference * difference;
            count++;
        }
    }
    print_message("%s: %d texels, RMSE %.2g\n", name, count, sqrt(sum / count));
    assert_true(count > SIZE * SIZE / 4);
    ASSERT_NEAR(sqrt(sum / count), 0.0, 1e-4); // asked; the same bits are expected
}

TEST_WITH_CONTEXT(three_formats_bake_the_same_occlusion, 2)
{
    alp_scene *original = test_load(context, "builtin:torus-plane");
    alp_scene *scenes[] = {through_gltf(context, original), through_collada(context, original),
                           through_obj(context, original)};
    static const char *const names[] = {"glTF", "COLLADA", "OBJ"};
    alp_lightmap *expected = bake(context, original);
    double mean = 0.0, squares = 0.0; // a map of one value would prove nothing
    const float *map = alp_lightmap_page(expected, 0, NULL, NULL);
    for (int i = 0; i < SIZE * SIZE; i++) {
        mean += (double)map[4 * i] / (SIZE * SIZE);
        squares += (double)map[4 * i] * (double)map[4 * i] / (SIZE * SIZE);
    }
    assert_true(squares - mean * mean > 0.01);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(scenes[i]->triangle_count, original->triangle_count);
        alp_lightmap *found = bake(context, scenes[i]);
        compare(expected, found, original, names[i]);
        alp_lightmap_destroy(found);
        alp_scene_destroy(scenes[i]);
    }
    alp_lightmap_destroy(expected);
    alp_scene_destroy(original);
}
