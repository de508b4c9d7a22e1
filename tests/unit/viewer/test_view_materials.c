// SPDX-License-Identifier: MIT
// Materials of the viewer against those of render: textures, holes, panes, sides, vertex colours.
#include "test_gl.h"
#include "test_gltf.h"

#include "base/memory.h"

#include <stdio.h>

enum { TEXTURE_SIDE = 16 };

/// A quad of 2 × 2 m about the origin, which faces +Z: position, normal, uv from -.5 to 1.5,
/// colour.
typedef struct corner {
    float position[3], normal[3], uv[2], color[4];
} corner;
typedef struct quad {
    corner corners[4];
    uint16_t indices[6];
} quad;

static quad make_quad(void)
{
    quad q = {.indices = {0, 1, 2, 0, 2, 3}};
    static const float places[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; i++) {
        q.corners[i] = (corner){.position = {places[i][0], places[i][1], 0.0f},
                                .normal = {0.0f, 0.0f, 1.0f},
                                .uv = {0.5f + places[i][0], 0.5f - places[i][1]},
                                .color = {1.0f, 0.25f * (float)i, 1.0f, 0.5f + 0.1f * (float)i}};
    }
    return q;
}

/// A grid of coloured squares with alpha.
static void write_texture(alp_context *context, const char *path)
{
    const alp_image_info info = {TEXTURE_SIDE, TEXTURE_SIDE, 4, ALP_COMPONENT_U8};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    uint8_t(*pixels)[4] = (uint8_t(*)[4])alp_image_bytes(image);
    for (int i = 0; i < TEXTURE_SIDE * TEXTURE_SIDE; i++) {
        const int x = i % TEXTURE_SIDE, y = i / TEXTURE_SIDE;
        pixels[i][0] = (uint8_t)(255 * (x / 4 % 2));
        pixels[i][1] = (uint8_t)(16 * y);
        pixels[i][2] = (uint8_t)(255 - 16 * x);
        pixels[i][3] = (uint8_t)(16 * ((x + y) % TEXTURE_SIDE));
    }
    ASSERT_OK(context, alp_image_save(image, path, true));
    alp_image_destroy(image);
}

/// The JSON up to materials and nodes.
#define HEAD                                                                                       \
    "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_texture_transform',"                        \
    "'KHR_materials_transmission'],"                                                               \
    "'buffers':[{'byteLength':204}],'bufferViews':[{'buffer':0,'byteLength':192,'byteStride':48}," \
    "{'buffer':0,'byteOffset':192,'byteLength':12}],'accessors':["                                 \
    "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','min':[-1,-1,0],"                \
    "'max':[1,1,0]},"                                                                              \
    "{'bufferView':0,'byteOffset':12,'componentType':5126,'count':4,'type':'VEC3'},"               \
    "{'bufferView':0,'byteOffset':24,'componentType':5126,'count':4,'type':'VEC2'},"               \
    "{'bufferView':0,'byteOffset':32,'componentType':5126,'count':4,'type':'VEC4'},"               \
    "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}],"                            \
    "'images':[{'uri':'texture.png'}],'samplers':[{},{'wrapS':33071,'wrapT':33648}],"              \
    "'textures':[{'source':0,'sampler':0},{'source':0,'sampler':1}],"                              \
    "'scene':0,'scenes':[{'nodes':[0,1,2,3,4]}],"
#define PRIMITIVE(material)                                                                        \
    "{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,'COLOR_0':3},"           \
    "'indices':4,'material':" #material "}]}"

/// Five quads behind each other, each to be seen in part, in front of nothing.
static const char TEXT[] = HEAD
    "'materials':["
    "{'pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{'index':0}},"
    "'emissiveFactor':[0.1,0.2,0.4],'emissiveTexture':{'index':1}},"
    "{'alphaMode':'MASK','alphaCutoff':0.2,'doubleSided':true,'pbrMetallicRoughness':{"
    "'metallicFactor':0.5,'metallicRoughnessTexture':{'index':1},'baseColorTexture':{'index':1,"
    "'extensions':{'KHR_texture_transform':{'offset':[0.1,0.2],'rotation':0.7,'scale':[2,3]}}}}},"
    "{'alphaMode':'BLEND','pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{"
    "'index':0}},'emissiveFactor':[0.2,0.1,0]},"
    "{'doubleSided':true,'pbrMetallicRoughness':{'metallicFactor':0,'baseColorFactor':["
    "0.3,0.9,0.5,1]},'extensions':{'KHR_materials_transmission':{'transmissionFactor':0.8,"
    "'transmissionTexture':{'index':0}}}},"
    "{'pbrMetallicRoughness':{'metallicFactor':0}}],"
    "'meshes':[" PRIMITIVE(0) "," PRIMITIVE(1) "," PRIMITIVE(2) "," PRIMITIVE(3) "," PRIMITIVE(
        4) "],'nodes':[{'mesh':0,'translation':[0,0,-1]},"
           "{'mesh':1,'translation':[0.6,0.3,-0.5]},{'mesh':2,'translation':[-0.3,0.5,0]},"
           "{'mesh':3,'translation':[0.2,-0.6,0.5],'rotation':[0,1,0,0]},"
           "{'mesh':4,'translation':[-1.7,-1.2,0.3],'rotation':[0,1,0,0],'scale':[0.5,0.5,0.5]}]}";

static alp_scene *load_quads(alp_context *context)
{
    const char *folder = test_folder();
    const quad q = make_quad();
    size_t size = 0;
    uint8_t *bytes = test_glb(context, TEXT, &q, sizeof q, &size);
    FILE *file = fopen(test_path(folder, "quads.glb"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    alpi_release(context, bytes);
    write_texture(context, test_path(folder, "texture.png"));
    return test_load(context, test_path(folder, "quads.glb"));
}

static alp_render_options look_at_quads(alp_render_method method)
{
    alp_render_options o = alp_render_options_default();
    o.method = method;
    o.width = 240;
    o.height = 180;
    o.camera = (alp_camera){
        .position = {0.3f, 0.2f, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 0.8f};
    return o;
}

/// Nearly all pixels see the same triangles, and all of these are equal.
static void check(const alp_scene *scene, const alp_render_options *o)
{
    test_pair pair = test_gl_pair(scene, o);
    const double equal = test_pair_equal_share(&pair);
    if (!(pair.alike_share > 0.9 && equal > 0.999)) {
        fail_msg("%.4f of the pixels are alike, and %.4f of these equal", pair.alike_share, equal);
    }
    test_pair_destroy(&pair);
}

TEST_WITH_CONTEXT(albedos_of_textures_are_those_of_render, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_quads(context);
    const alp_render_options o = look_at_quads(ALP_RENDER_ALBEDO);
    check(scene, &o);
    alp_scene_set_metals(scene, ALP_METALS_BLACK);
    check(scene, &o);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(light_goes_through_panes_as_in_render, 1)
{
    if (!test_gl_open()) {
        skip();
    }
    alp_scene *scene = load_quads(context);
    alp_render_options o = look_at_quads(ALP_RENDER_LIGHTMAP);
    alp_bake_options bake = alp_bake_options_default();
    alp_lightmap *lightmap = NULL;
    bake.maps = ALP_MAP_LIGHT;
    bake.atlas.size = 64;
    bake.light.samples = 8;
    ASSERT_OK(context, alp_bake(scene, &bake, &lightmap, NULL)); // lit by its own emission
    o.lightmap = lightmap;
    check(scene, &o); // without a sky: alpha of panes before nothing
    o.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    o.lighting.sky.up[0] = 0.05f;
    check(scene, &o);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
