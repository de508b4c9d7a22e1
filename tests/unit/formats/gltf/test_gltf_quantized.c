// SPDX-License-Identifier: MIT
// KHR_mesh_quantization: integers in the place of floats, which a node's transform undoes.
#include "pack_asset.h"
#include "test_gltf.h"

#include "formats/formats.h"

#include <math.h>
#include <stdio.h>

enum { I8 = 5120, U8 = 5121, I16 = 5122, U16 = 5123 };

/// How the wave is stored. Its coordinates are whole numbers of 1/4096 in [0, 1].
typedef struct form {
    int position, normal, uv; // component types
    bool normalized;          // positions and coordinates; normals always are
} form;

static size_t size_of(int type)
{
    return type <= U8 ? 1 : 2;
}

/// What the largest stored value stands for, or 1 for integers as they are.
static double largest(int type, bool normalized)
{
    static const double of[] = {127.0, 255.0, 32767.0, 65535.0};
    return normalized ? of[type - I8] : 1.0;
}

/// Elements of `components` at multiples of 4 bytes. @param scale value · scale is stored, rounded
static int pack(pack_asset *asset, const float *values, int components, int type, double scale,
                const char *more)
{
    static uint8_t bytes[WAVE_VERTICES * 8];
    const size_t size = size_of(type), stride = (size * (size_t)components + 3) / 4 * 4;
    memset(bytes, 0, sizeof bytes);
    for (size_t v = 0; v < WAVE_VERTICES; v++) {
        for (size_t k = 0; k < (size_t)components; k++) {
            const int stored = (int)lround((double)values[v * (size_t)components + k] * scale);
            memcpy(bytes + v * stride + k * size, &stored, size); // little-endian
        }
    }
    return pack_accessor(asset, pack_view(asset, bytes, stride * WAVE_VERTICES, stride), type,
                         WAVE_VERTICES, components == 3 ? "VEC3" : "VEC2", more);
}

/// Positions are stored as p · units, after adding nothing; the node's scale takes that back.
static const char *write_wave(const form *f, double units, double uv_units)
{
    const wave *w = wave_mesh();
    char rest[2048], bounds[200];
    pack_asset *asset = pack_start();
    snprintf(bounds, sizeof bounds, ",'min':[0,0,0],'max':[%.0f,%.0f,%.0f]%s", units, units, units,
             f->normalized ? ",'normalized':true" : "");
    pack(asset, &w->positions[0][0], 3, f->position, units, bounds);
    pack(asset, &w->normals[0][0], 3, f->normal, largest(f->normal, true), ",'normalized':true");
    pack(asset, &w->uvs[0][0], 2, f->uv, uv_units, f->normalized ? ",'normalized':true" : "");
    pack_accessor(asset, pack_view(asset, w->indices, sizeof w->indices, 0), 5125,
                  3 * WAVE_TRIANGLES, "SCALAR", "");
    const double scale = largest(f->position, f->normalized) / units;
    snprintf(rest, sizeof rest,
             "'extensionsUsed':['KHR_mesh_quantization'],'extensionsRequired':["
             "'KHR_mesh_quantization'],'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
             "'scale':[%.17g,%.17g,%.17g]}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,"
             "'NORMAL':1,'TEXCOORD_0':2},'indices':3}]}]",
             scale, scale, scale);
    return pack_write(asset, rest);
}

TEST_WITH_CONTEXT(every_type, 1)
{
    static const struct {
        form f;
        double units, uv_units; // stored at 1
    } cases[] = {
        {{I16, I8, U16, true}, 32767, 65535}, {{U16, I16, U16, true}, 65535, 65535},
        {{I8, I8, U8, true}, 127, 255},       {{U8, I8, I8, true}, 255, 127},
        {{I16, I8, U16, false}, 4096, 4096},  {{U16, I16, I16, false}, 65535, 4096},
        {{U8, I8, U8, false}, 255, 255},      {{I8, I16, I8, false}, 127, 100},
    };
    alp_scene *plain = wave_scene(context);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        const char *path = write_wave(&cases[i].f, cases[i].units, cases[i].uv_units);
        ASSERT_OK(context, alp_scene_load(context, path, &scene));
        // Half a step in each axis, and the rounding of floats up to 1.
        const double step = sqrt(3.0) * (0.5 / cases[i].units + 1.2e-7);
        ASSERT_NEAR(wave_distance(plain, scene), 0.0, step);
        for (uint32_t v = 0; v < WAVE_VERTICES; v++) {
            const double limit = 0.5 / cases[i].uv_units;
            // Integers that are not normalised mean themselves: a texture transform undoes them.
            const double unit = cases[i].f.normalized ? 1.0 : cases[i].uv_units;
            for (int k = 0; k < 2; k++) {
                ASSERT_NEAR((double)scene->uvs[0][v][k] / unit, plain->uvs[0][v][k],
                            limit + 1.2e-7);
            }
            // Half a step in each axis of a unit vector, made unit again.
            ASSERT_NEAR(vec3_dot(vec3_load(scene->normals[v]), vec3_load(plain->normals[v])), 1.0,
                        1.5 * 0.25 / 127.0 / 127.0 + 2.4e-7);
        }
        // 4096 steps hold the wave exactly, and so its occlusion is the same.
        if (cases[i].units == 4096) {
            assert_true(wave_distance(plain, scene) == 0.0);
            assert_true(wave_occlusion_difference(plain, scene) <= 1e-4);
        }
        alp_scene_destroy(scene);
        alp_scene_destroy(pack_patch(context, path, i % 2 == 0 ? ".glb" : ".gltf", 0.0));
    }
    alp_scene_destroy(plain);
}
