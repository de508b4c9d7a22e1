// SPDX-License-Identifier: MIT
#include "drawn_asset.h"

#include "base/memory.h"
#include "formats/images/images.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct square {
    float positions[4][3], normals[4][3], uvs[2][4][2], colors[4][4];
    uint32_t indices[6];
    char broken[8];
} square;

static const square geometry = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
    {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
    {{{0, 1}, {1, 1}, {0, 0}, {1, 0}}, {{1, 1}, {0, 1}, {1, 0}, {0, 0}}},
    {{1, 0.5f, 1, 1}, {0.25f, 1, 0.5f, 0.5f}, {0, 1, 1, 1}, {1, 1, 0.75f, 0.25f}},
    {0, 1, 3, 0, 3, 2},
    "no PNG",
};

static const char *const FORM =
    "{'asset':{'version':'2.0'},'nodes':[{'name':'square','mesh':0}],"
    "'buffers':[{'byteLength':%zu}],'bufferViews':["
    "{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':48},"
    "{'buffer':0,'byteOffset':96,'byteLength':32},{'buffer':0,'byteOffset':128,'byteLength':32},"
    "{'buffer':0,'byteOffset':160,'byteLength':64},{'buffer':0,'byteOffset':224,'byteLength':24},"
    "{'buffer':0,'byteOffset':248,'byteLength':8},{'buffer':0,'byteOffset':256,'byteLength':%zu}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':4},"
    "{'bufferView':1,'componentType':5126,'type':'VEC3','count':4},"
    "{'bufferView':2,'componentType':5126,'type':'VEC2','count':4},"
    "{'bufferView':3,'componentType':5126,'type':'VEC2','count':4},"
    "{'bufferView':4,'componentType':5126,'type':'VEC4','count':4},"
    "{'bufferView':5,'componentType':5125,'type':'SCALAR','count':6}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,"
    "'TEXCOORD_1':3,'COLOR_0':4},'indices':5,'material':0}]}],"
    "'images':[{'bufferView':7,'mimeType':'image/png'},{'bufferView':6,'mimeType':'image/png'},"
    "{'bufferView':7,'mimeType':'image/png'}],"
    "'samplers':[{'wrapS':33071,'wrapT':33648}],'textures':[{'source':0,'sampler':0},{'source':1},"
    "{'source':2},{}],'materials':[%s]}";

/// Every byte differs from its neighbours.
static void encode_image(alp_context *context, uint8_t **bytes, size_t *size)
{
    alp_image *image = NULL;
    const alp_image_info info = {DRAWN_WIDTH, DRAWN_HEIGHT, 4, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (uint32_t i = 0; i < DRAWN_WIDTH * DRAWN_HEIGHT * 4; i++) {
        alp_image_bytes(image)[i] = (uint8_t)(i * 83 + 7);
    }
    ASSERT_OK(context, alpi_png_encode(image, bytes, size));
    alp_image_destroy(image);
}

alp_result drawn_asset_read(alp_context *context, const char *materials, alp_scene **scene)
{
    uint8_t *png = NULL;
    size_t size = 0;
    char json[4096];
    _Static_assert(sizeof geometry == 256, "as the views say");
    alp_context *maker = test_context(1);
    encode_image(maker, &png, &size);
    const int length = snprintf(json, sizeof json, FORM, sizeof geometry + size, size, materials);
    assert_true(length > 0 && (size_t)length < sizeof json);
    uint8_t *bin = malloc(sizeof geometry + size);
    assert_non_null(bin);
    memcpy(bin, &geometry, sizeof geometry);
    memcpy(bin + sizeof geometry, png, size);
    const alp_result result = test_gltf_scene(context, json, bin, sizeof geometry + size, scene);
    free(bin);
    alpi_release(maker, png);
    alp_context_destroy(maker);
    return result;
}

alp_scene *drawn_asset(alp_context *context, const char *materials)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, drawn_asset_read(context, materials, &scene));
    return scene;
}
