// SPDX-License-Identifier: MIT
// What a small glTF asset becomes as a scene, number by number.
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_read.h"

#include <math.h>
#include <stdio.h>

#define ASSET "'asset':{'version':'2.0'},"

/// A unit square in the xy plane: corners 00 10 01 11, as floats; then normals +z; then uvs; then
/// colours (RGB bytes, 4 apart); then indices of two triangles.
typedef struct square {
    float positions[4][3], normals[4][3], uvs[4][2];
    uint8_t colors[4][4], indices[8];
} square;

static const square geometry = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
    {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
    {{0, 1}, {1, 1}, {0, 0}, {1, 0}},
    {{0, 51, 255, 9}, {0, 51, 255, 9}, {0, 51, 255, 9}, {0, 51, 255, 9}},
    {0, 1, 3, 0, 3, 2, 0, 0},
};

#define BUFFERS                                                                                    \
    "'buffers':[{'byteLength':152}],'bufferViews':[{'buffer':0,'byteLength':48},"                  \
    "{'buffer':0,'byteOffset':48,'byteLength':48},{'buffer':0,'byteOffset':96,'byteLength':32},"   \
    "{'buffer':0,'byteOffset':128,'byteLength':16,'byteStride':4},"                                \
    "{'buffer':0,'byteOffset':144,'byteLength':8}],'accessors':["                                  \
    "{'bufferView':0,'componentType':5126,'type':'VEC3','count':4},"                               \
    "{'bufferView':1,'componentType':5126,'type':'VEC3','count':4},"                               \
    "{'bufferView':2,'componentType':5126,'type':'VEC2','count':4},"                               \
    "{'bufferView':3,'componentType':5121,'normalized':true,'type':'VEC3','count':4},"             \
    "{'bufferView':4,'componentType':5121,'type':'SCALAR','count':6}]"
#define POSITIONS "'attributes':{'POSITION':0}"
#define NORMALS "'attributes':{'POSITION':0,'NORMAL':1}"
#define SQUARE "'meshes':[{'name':'square','primitives':[{" NORMALS ",'indices':4}]}]"

static alp_scene *load(alp_context *context, const char *rest)
{
    char json[8192];
    snprintf(json, sizeof json, "{" ASSET BUFFERS ",%s}", rest);
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, test_gltf_scene(context, json, &geometry, sizeof geometry, &scene));
    return scene;
}

static void assert_vec3(vec3 actual, float x, float y, float z)
{
    ASSERT_NEAR(actual.x, x, 1e-6);
    ASSERT_NEAR(actual.y, y, 1e-6);
    ASSERT_NEAR(actual.z, z, 1e-6);
}

static void assert_vec(const float *actual, float x, float y, float z)
{
    assert_vec3(vec3_load(actual), x, y, z);
}

TEST_WITH_CONTEXT(node_hierarchy, 1)
{
    // (1,0,0) → +(1,0,0) → ×2 → turned by 90° about z → +(1,2,3) = (1,6,3); the root comes second
    // in the file; the third node says the same by a matrix.
    alp_scene *scene =
        load(context, "'nodes':[{'mesh':0,'translation':[1,0,0]},{'name':'root','children':[0,2],"
                      "'translation':[1,2,3],'rotation':[0,0,0.70710678118654752,"
                      "0.70710678118654752],'scale':[2,2,2]},{'name':'m','mesh':0,"
                      "'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,1,0,0,1]}],'scenes':[{'nodes':[1]}]"
                      "," SQUARE);
    assert_int_equal(scene->surface_count, 2);
    assert_int_equal(scene->triangle_count, 4);
    for (uint32_t s = 0; s < 2; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        assert_int_equal(surface->node, s == 0 ? 0 : 2);
        assert_string_equal(surface->name, s == 0 ? "square" : "m");
        assert_int_equal(surface->first_triangle, 2 * s);
        assert_int_equal(surface->first_vertex, 4 * s);
        assert_int_equal(surface->vertex_count, 4);
        assert_false(surface->mirrored);
        assert_int_equal(surface->material, ALPI_NONE);
        const float(*p)[3] = (const float(*)[3])scene->positions + surface->first_vertex;
        assert_vec(p[0], 1, 4, 3);
        assert_vec(p[1], 1, 6, 3);
        assert_vec(p[2], -1, 4, 3);
        assert_vec(scene->normals[surface->first_vertex], 0, 0, 1);
    }
    assert_true(test_log_has("no-material"));
    ASSERT_NEAR(scene->area, 8.0, 1e-6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(default_scene, 1)
{
    static const struct {
        const char *scene;
        float x;
    } cases[] = {
        {"'scene':1,'scenes':[{'nodes':[0]},{'nodes':[1]}]", 20},
        {"'scenes':[{'nodes':[0]},{'nodes':[1]}]", 10},
    };
    for (size_t i = 0; i < 2; i++) {
        char rest[1024];
        snprintf(rest, sizeof rest,
                 "%s,'nodes':[{'mesh':0,'translation':[10,0,0]},{'mesh':0,'translation':[20,0,0]}]"
                 "," SQUARE,
                 cases[i].scene);
        alp_scene *scene = load(context, rest);
        assert_int_equal(scene->surface_count, 1);
        assert_vec(scene->positions[0], cases[i].x, 0, 0);
        alp_scene_destroy(scene);
    }
    alp_scene *scene = load(context, "'nodes':[{'mesh':0},{'mesh':0}]," SQUARE);
    assert_int_equal(scene->surface_count, 2); // no scenes: all roots
    alp_scene_destroy(scene);
}

/// Normal of the winding of triangle t.
static vec3 winding(const alp_scene *scene, uint32_t t)
{
    vec3 c[3];
    alpi_triangle_corners(scene, t, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 0, 0});
}

/// Extras belong to somebody else: a hash beyond 64 bits there must not make the asset unreadable.
TEST_WITH_CONTEXT(integers_beyond_64_bits, 1)
{
    alp_scene *scene =
        load(context, SQUARE ",'nodes':[{'children':[1]},{'mesh':0,'translation':[1,2,3]}],"
                             "'scene':0,'scenes':[{'nodes':[0]}],"
                             "'extras':{'hash':123456789012345678901234567890}");
    assert_int_equal(alp_scene_get_info(scene).triangles, 2);
    assert_vec(scene->positions[0], 1, 2, 3);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(mirrored_nodes, 1)
{
    alp_scene *scene = load(context, "'nodes':[{'mesh':0,'scale':[-1,1,1],'children':[1]},"
                                     "{'mesh':0,'scale':[1,-1,1]},{'mesh':1,'scale':[-2,1,1]}],"
                                     "'meshes':[{'primitives':[{" NORMALS ",'indices':4}]},"
                                     "{'primitives':[{" POSITIONS ",'indices':4}]}]");
    assert_int_equal(scene->surface_count, 3);
    assert_true(scene->surfaces[0].mirrored);
    assert_false(scene->surfaces[1].mirrored); // mirrored twice
    assert_true(scene->surfaces[2].mirrored);
    for (uint32_t t = 0; t < 6; t++) { // the outside stays outside
        vec3 n = winding(scene, t);
        assert_vec3(n, 0, 0, 1);
        for (int k = 0; k < 3; k++) {
            assert_vec(scene->normals[scene->triangles[t][k]], 0, 0, 1);
        }
    }
    // corners 1 and 2 changed places, in the indexed and in the flat surface
    const uint32_t *triangle = scene->triangles[0];
    assert_int_equal(scene->vertex_source[triangle[0]], 0);
    assert_int_equal(scene->vertex_source[triangle[1]], 3);
    assert_int_equal(scene->vertex_source[triangle[2]], 1);
    triangle = scene->triangles[4];
    assert_int_equal(scene->vertex_source[triangle[0]], 0);
    assert_int_equal(scene->vertex_source[triangle[1]], 3);
    assert_int_equal(scene->vertex_source[triangle[2]], 1);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(flat_normals, 1)
{
    alp_scene *scene = load(context, "'nodes':[{'mesh':0,'rotation':[1,0,0,0]}],"
                                     "'meshes':[{'primitives':[{" POSITIONS ",'indices':4}]}]");
    assert_true(scene->surfaces[0].normals_generated);
    assert_int_equal(scene->vertex_count, 6); // three of its own for each triangle
    static const uint32_t sources[] = {0, 1, 3, 0, 3, 2};
    assert_memory_equal(scene->vertex_source, sources, sizeof sources);
    for (uint32_t v = 0; v < 6; v++) {
        assert_vec(scene->normals[v], 0, 0, -1); // turned over by 180° about x
        const float *p = geometry.positions[sources[v]];
        assert_vec(scene->positions[v], p[0], -p[1], 0);
    }
    assert_false(test_log_has("bad-normals"));
    alp_scene_destroy(scene);
}

/// A plane that leans by 45° keeps its right angle to its normal under non-uniform scale.
TEST_WITH_CONTEXT(normals_under_scale, 1)
{
    alp_scene *scene = load(context, "'nodes':[{'scale':[1,3,1],'children':[1]},{'mesh':0,"
                                     "'rotation':[0.38268343236509,0,0,0.92387953251129]}]"
                                     "," SQUARE);
    for (uint32_t t = 0; t < 2; t++) {
        vec3 n = winding(scene, t);
        assert_vec(scene->normals[scene->triangles[t][0]], n.x, n.y, n.z);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(triangle_modes, 1)
{
    static const struct {
        const char *primitive;
        uint32_t count, corners[12];
    } cases[] = {
        {"'mode':4,'indices':4", 2, {0, 1, 3, 0, 3, 2}},
        {"'mode':4", 1, {0, 1, 2}}, // a fourth vertex is left over
        {"'mode':5", 2, {0, 1, 2, 1, 3, 2}},
        {"'mode':5,'indices':4", 4, {0, 1, 3, 1, 0, 3, 3, 0, 3, 0, 2, 3}},
        {"'mode':6", 2, {1, 2, 0, 2, 3, 0}},
        {"'mode':6,'indices':4", 4, {1, 3, 0, 3, 0, 0, 0, 3, 0, 3, 2, 0}},
        {"'mode':0", 0, {0}},
        {"'mode':3,'indices':4", 0, {0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char rest[1024];
        snprintf(rest, sizeof rest,
                 "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{" NORMALS ",%s}]}]",
                 cases[i].primitive);
        alp_scene *scene = load(context, rest);
        assert_int_equal(scene->triangle_count, cases[i].count);
        assert_memory_equal(scene->triangles, cases[i].corners,
                            sizeof(uint32_t[3]) * cases[i].count);
        assert_int_equal(test_log_has("not-triangles"), cases[i].count == 0);
        assert_int_equal(test_log_has("leftover-indices"), i == 1);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(vertex_attributes, 1)
{
    alp_scene *scene =
        load(context, "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,"
                      "'NORMAL':1,'TEXCOORD_0':2,'TEXCOORD_2':2,'COLOR_0':3}},{" NORMALS "}]}]");
    assert_int_equal(scene->surface_count, 2);
    assert_int_equal(scene->surfaces[0].uv_sets, 1); // set 1 is missing: 0 alone is in a row
    assert_int_equal(scene->surfaces[1].uv_sets, 0);
    assert_int_equal(scene->surfaces[1].primitive, 1);
    assert_non_null(scene->uvs[0]);
    assert_null(scene->uvs[1]);
    assert_non_null(scene->uvs[2]);
    ASSERT_NEAR(scene->uvs[0][0][1], 1, 0);
    ASSERT_NEAR(scene->uvs[2][3][0], 1, 0);
    ASSERT_NEAR(scene->uvs[0][4][1], 0, 0); // the second primitive has none
    ASSERT_NEAR(scene->colors[0][1], 0.2, 1e-6);
    ASSERT_NEAR(scene->colors[0][3], 1, 0); // RGB: opaque
    ASSERT_NEAR(scene->colors[4][0], 1, 0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(materials, 1)
{
    alp_scene *scene = load(
        context,
        "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,"
        "'TEXCOORD_0':2},'material':1}]}],"
        "'images':[{'uri':'absent.png'},{'uri':'unused.png'}],'samplers':[{'wrapS':33071,"
        "'wrapT':33648},{}],'textures':[{'source':0,'sampler':0},{'source':1,'sampler':1}],"
        "'materials':[{},{'name':'all','doubleSided':true,'alphaMode':'MASK','alphaCutoff':0.25,"
        "'emissiveFactor':[1,0.5,0],'extensions':{'KHR_materials_emissive_strength':"
        "{'emissiveStrength':8}},'occlusionTexture':{'index':0,'strength':0.75,'texCoord':0},"
        "'pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],'metallicFactor':0.5,"
        "'baseColorTexture':{'index':0,'texCoord':0,'extensions':{'KHR_texture_transform':"
        "{'offset':[0.5,0.25],'scale':[2,4],'rotation':1.5707963267948966,'texCoord':3}}}}},"
        "{'pbrMetallicRoughness':{'metallicFactor':1},'extensions':"
        "{'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[0.9,0.8,0.7,1],"
        "'diffuseTexture':{'index':1}}}}]");
    assert_int_equal(scene->material_count, 3);
    const alpi_material *m = &scene->materials[0]; // all defaults: glTF's metallic is 1
    ASSERT_NEAR(m->metallic, 1, 0);
    ASSERT_NEAR(m->base_color[0], 1, 0);
    assert_int_equal(m->alpha_mode, ALPI_ALPHA_OPAQUE);
    assert_int_equal(m->base_color_texture.image, ALPI_NONE);
    m = &scene->materials[1];
    assert_string_equal(m->name, "all");
    assert_true(m->double_sided);
    assert_int_equal(m->alpha_mode, ALPI_ALPHA_MASK);
    ASSERT_NEAR(m->alpha_cutoff, 0.25, 0);
    ASSERT_NEAR(m->emission[0], 8, 0);
    ASSERT_NEAR(m->emission[1], 4, 0);
    ASSERT_NEAR(m->occlusion_strength, 0.75, 0);
    assert_int_equal(m->occlusion_texture.image, 0);
    ASSERT_NEAR(m->base_color[3], 0.4, 1e-7);
    ASSERT_NEAR(m->metallic, 0.5, 0);
    const alpi_texture *texture = &m->base_color_texture;
    assert_int_equal(texture->wrap_u, ALPI_WRAP_CLAMP);
    assert_int_equal(texture->wrap_v, ALPI_WRAP_MIRROR);
    assert_int_equal(texture->uv_set, 3); // the transform's texCoord goes before the texture's
    // (u, v) = (.1, .2) → scaled (.2, .8) → turned by 90° (.8, −.2) → moved (1.3, .05)
    vec2 uv = alpi_texture_transform(texture, (vec2){0.1f, 0.2f});
    ASSERT_NEAR(uv.x, 1.3, 1e-6);
    ASSERT_NEAR(uv.y, 0.05, 1e-6);
    m = &scene->materials[2];
    ASSERT_NEAR(m->metallic, 0, 0);
    ASSERT_NEAR(m->base_color[1], 0.8, 1e-7);
    assert_int_equal(m->base_color_texture.image, 1);
    // the image that is used and absent is told, the unused one is not looked for
    assert_true(test_log_has("image"));
    assert_non_null(strstr(test_log_text(), "absent.png"));
    assert_null(strstr(test_log_text(), "unused.png"));
    assert_true(test_log_has("no-uv")); // set 3
    assert_null(scene->images[0]);
    alp_scene_destroy(scene);
}

#define TRANSMITTING(TEXT)                                                                         \
    "'images':[{'uri':'absent.png'}],'textures':[{'source':0}],'materials':[{'extensions':"        \
    "{'KHR_materials_transmission':" TEXT "}},{}],'nodes':[{'mesh':0}],'meshes':[{'primitives':["  \
    "{" NORMALS ",'material':0}]}]"

TEST_WITH_CONTEXT(transmission, 1)
{
    alp_scene *scene =
        load(context, TRANSMITTING("{'transmissionFactor':0.75,'transmissionTexture':"
                                   "{'index':0,'texCoord':2}}"));
    ASSERT_NEAR(scene->materials[0].transmission, 0.75, 0);
    assert_int_equal(scene->materials[0].transmission_texture.image, 0);
    assert_int_equal(scene->materials[0].transmission_texture.uv_set, 2);
    assert_non_null(strstr(test_log_text(), "absent.png")); // it is wanted
    assert_true(test_log_has("no-uv"));
    ASSERT_NEAR(scene->materials[1].transmission, 0, 0);
    assert_int_equal(scene->materials[1].transmission_texture.image, ALPI_NONE);
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_gltf_export_scene(scene, true, &bytes, &size));
    alp_scene_destroy(scene);
    const char *json = (const char *)bytes + 20; // it ends in a BIN chunk's zeros
    assert_non_null(strstr(json, "\"extensionsUsed\":[\"KHR_materials_transmission\"]"));
    alpi_gltf_document *document = NULL;
    ASSERT_OK(context, alpi_gltf_document_parse(context, "again.glb", bytes, size, &document));
    ASSERT_OK(context, alpi_gltf_scene_from_document(document, &scene));
    ASSERT_NEAR(scene->materials[0].transmission, 0.75, 0);
    ASSERT_NEAR(scene->materials[1].transmission, 0, 0);
    alp_scene_destroy(scene);
    scene = load(context, TRANSMITTING("{}"));
    ASSERT_NEAR(scene->materials[0].transmission, 0, 0); // glTF's default
    alp_scene_destroy(scene);
    scene = load(context, TRANSMITTING("{'transmissionFactor':1.5}"));
    ASSERT_NEAR(scene->materials[0].transmission, 1, 0);
    assert_true(test_log_has("material-range"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(transmission_that_is_none, 1)
{
    static const char *const cases[][2] = {
        {TRANSMITTING("{'transmissionFactor':'much'}"),
         "material 0: transmissionFactor must be a number"},
        {TRANSMITTING("{'transmissionTexture':7}"), "transmissionTexture must be an object"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[8192];
        alp_scene *scene = NULL;
        snprintf(json, sizeof json, "{" ASSET BUFFERS ",%s}", cases[i][0]);
        assert_int_equal(test_gltf_scene(context, json, &geometry, sizeof geometry, &scene),
                         ALP_ERROR_INVALID_DATA);
        test_message_has(context, cases[i][1]);
    }
}

TEST_WITH_CONTEXT(lights, 1)
{
    alp_scene *scene =
        load(context, "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','name':'p',"
                      "'color':[1,0.5,0],'intensity':40,'range':7},{'type':'spot','intensity':2,"
                      "'spot':{'innerConeAngle':0.3,'outerConeAngle':0.6}},{'type':'spot',"
                      "'spot':{'innerConeAngle':1,'outerConeAngle':0.5}},{'type':'directional'},"
                      "{'type':'spot','range':2}]}},"
                      // 90° about x turns −z to +y
                      "'nodes':[{'translation':[0,5,0],'rotation':[0.70710678,0,0,0.70710678],"
                      "'scale':[3,3,3],'children':[1,2,3,4]},"
                      "{'extensions':{'KHR_lights_punctual':{'light':0}},'translation':[1,0,0]},"
                      "{'extensions':{'KHR_lights_punctual':{'light':1}}},"
                      "{'extensions':{'KHR_lights_punctual':{'light':2}}},"
                      "{'extensions':{'KHR_lights_punctual':{'light':3}}},"
                      // uneven, mirrored scale: −z is +z, and no number changes with it
                      "{'extensions':{'KHR_lights_punctual':{'light':4}},'scale':[2,0.5,-7]}]");
    assert_int_equal(scene->light_count, 5);
    const alpi_light *light = scene->lights;
    assert_int_equal(light[0].kind, ALP_LIGHT_POINT);
    for (uint32_t i = 0; i < 5; i++) { // the public view
        const alp_light_info told = alp_scene_get_light(scene, i);
        assert_int_equal(told.kind, light[i].kind);
        assert_string_equal(told.name, light[i].name);
        assert_true(told.intensity == light[i].intensity &&
                    told.position[0] == light[i].position.x);
    }
    assert_string_equal(alp_scene_get_light(scene, 5).name, "");
    const alp_light_traits spot = alp_light_traits_of(light[1].kind);
    assert_string_equal(spot.name, "spot");
    assert_string_equal(spot.unit, "candela");
    assert_true(spot.has_position && spot.has_direction && spot.has_cone && !spot.has_size);
    assert_string_equal(alp_light_traits_of((alp_light_kind)3).name, "");
    assert_string_equal(alp_light_traits_of((alp_light_kind)-1).unit, "");
    assert_string_equal(light[0].name, "p");
    assert_vec3(light[0].position, 3, 5, 0);
    ASSERT_NEAR(light[0].intensity, 40, 0);
    ASSERT_NEAR(light[0].color.y, 0.5, 0);
    ASSERT_NEAR(light[0].range, 7, 0);
    assert_int_equal(light[1].kind, ALP_LIGHT_SPOT);
    ASSERT_NEAR(light[1].inner_cone, 0.3, 1e-6);
    ASSERT_NEAR(light[1].outer_cone, 0.6, 1e-6);
    assert_true(isinf(light[1].range));
    assert_vec3(light[1].direction, 0, 1, 0);
    ASSERT_NEAR(light[2].inner_cone, 0.5, 1e-6); // was wider than the outer one
    assert_true(test_log_has("light"));
    assert_int_equal(light[3].kind, ALP_LIGHT_DIRECTIONAL);
    ASSERT_NEAR(light[3].intensity, 1, 0);
    assert_vec3(light[3].direction, 0, 1, 0);
    assert_vec3(light[4].direction, 0, 0, 1);
    ASSERT_NEAR(light[4].inner_cone, 0, 0); // what it does not say
    ASSERT_NEAR(light[4].outer_cone, 0.785398163, 1e-7);
    ASSERT_NEAR(light[4].color.z, 1, 0);
    ASSERT_NEAR(light[4].range, 2, 0);
    alp_scene_destroy(scene);
}

/// What is negative is none, and what sums of it could not hold is cut off.
TEST_WITH_CONTEXT(light_values_out_of_range, 1)
{
    static const struct {
        const char *light;
        float intensity, red, range;
        bool told;
    } cases[] = {
        {"'intensity':1e20,'color':[1e10,1,1],'range':1e300", 1e20f, 1e10f, 3.4028235e38f, false},
        {"'intensity':1.1e20", 1e20f, 1.0f, INFINITY, true},
        {"'intensity':1e300", 1e20f, 1.0f, INFINITY, true},
        {"'intensity':-1e-9", 0.0f, 1.0f, INFINITY, true},
        {"'color':[-1,1,1]", 1.0f, 0.0f, INFINITY, true},
        {"'color':[1e11,1,1]", 1.0f, 1e10f, INFINITY, true},
        {"'range':0", 1.0f, 1.0f, INFINITY, true},
        {"'range':-3", 1.0f, 1.0f, INFINITY, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char rest[512];
        snprintf(rest, sizeof rest,
                 "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point',%s}]}},"
                 "'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}}]",
                 cases[i].light);
        alp_scene *scene = load(context, rest);
        assert_int_equal(scene->light_count, 1);
        const alpi_light *light = &scene->lights[0];
        assert_true(light->intensity == cases[i].intensity);
        assert_true(light->color.x == cases[i].red && light->color.y == 1.0f);
        assert_true(light->range == cases[i].range);
        assert_int_equal(test_log_has("light"), cases[i].told);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(cameras, 1)
{
    alp_scene *scene =
        load(context, "'cameras':[{'type':'orthographic','orthographic':{}},{'type':'perspective',"
                      "'perspective':{'yfov':0.75,'znear':0.1}}],'nodes':[{'camera':0},{'camera':1,"
                      "'translation':[1,2,3],'rotation':[0,0.70710678,0,0.70710678],"
                      "'scale':[5,5,5]}]");
    assert_int_equal(scene->camera_count, 1);
    assert_true(test_log_has("camera"));
    alp_camera camera = alp_scene_get_camera(scene, 0);
    assert_vec(camera.position, 1, 2, 3);
    assert_vec(camera.target, 0, 2, 3); // 90° about y turns −z to −x; one metre ahead
    assert_vec(camera.up, 0, 1, 0);
    ASSERT_NEAR(camera.vertical_fov, 0.75, 1e-7);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(oddities_are_told, 1)
{
    alp_scene *scene =
        load(context, "'extensionsUsed':['KHR_materials_unlit','EXT_mesh_gpu_instancing'],"
                      "'nodes':[{'name':'a\\u001b[2Jb','mesh':0,'skin':0},{'mesh':0,'extensions':"
                      "{'EXT_mesh_gpu_instancing':{'attributes':{'SCALE':0}}}}],"
                      "'skins':[{'joints':[0]}],'meshes':[{'primitives':[{" NORMALS
                      ",'indices':4,'targets':[{}]},{'attributes':{'NORMAL':1}}]}]");
    assert_int_equal(scene->surface_count, 1 + 4);
    assert_int_equal(scene->triangle_count, 2 * (1 + 4));
    static const char *const codes[] = {"skin", "morph", "instancing", "no-positions"};
    for (size_t i = 0; i < 4; i++) {
        assert_true(test_log_has(codes[i]));
    }
    assert_string_equal(scene->surfaces[0].name, "a?[2Jb"); // no escape reaches a terminal
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(input_hash, 1)
{
    alp_scene *a = load(context, "'nodes':[]"), *b = load(context, "'nodes':[]"),
              *c = load(context, "'nodes':[{}]");
    assert_true(a->input_hash == b->input_hash && a->input_hash != c->input_hash);
    assert_int_equal(a->triangle_count, 0);
    assert_non_null(a->attachments[ALPI_ATTACHMENT_DOCUMENT].data);
    alp_scene_destroy(a);
    alp_scene_destroy(b);
    alp_scene_destroy(c);
}

// --- encodings -----------------------------------------------------------------------------------

/// A text of ASCII in units of `width` bytes. @param first number of the unit's byte with the
/// letter
static alp_result read_wide(alp_context *context, const char *text, size_t width, size_t first,
                            const char *mark, size_t mark_size)
{
    const size_t length = strlen(text), size = mark_size + width * length;
    uint8_t *bytes = alpi_allocate(context, size, 1);
    assert_non_null(bytes);
    memcpy(bytes, mark, mark_size);
    for (size_t i = 0; i < length; i++) {
        bytes[mark_size + width * i + first] = (uint8_t)text[i];
    }
    alpi_gltf_document *document = NULL;
    const alp_result result =
        alpi_gltf_document_parse(context, "wide.gltf", bytes, size, &document);
    alpi_gltf_document_destroy(document);
    return result;
}

TEST_WITH_CONTEXT(encodings_of_json, 1)
{
    static const struct {
        size_t width, first;
        const char *mark;
        size_t mark_size;
        const char *name;
    } cases[] = {{2, 0, "\xff\xfe", 2, "UTF-16,"},     {2, 1, "\xfe\xff", 2, "UTF-16,"},
                 {2, 0, "", 0, "UTF-16LE,"},           {2, 1, "", 0, "UTF-16BE,"},
                 {4, 0, "\xff\xfe\0\0", 4, "UTF-32,"}, {4, 3, "\0\0\xfe\xff", 4, "UTF-32,"},
                 {4, 0, "", 0, "UTF-32LE,"},           {4, 3, "", 0, "UTF-32BE,"}};
    static const char *const texts[] = {"{\"asset\":{\"version\":\"2.0\"}}",
                                        "\n{\"asset\":{\"version\":\"2.0\"}}"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (size_t k = 0; k < 2; k++) {
            assert_int_equal(read_wide(context, texts[k], cases[i].width, cases[i].first,
                                       cases[i].mark, cases[i].mark_size),
                             ALP_ERROR_INVALID_DATA);
            test_message_has(context, cases[i].name);
            test_message_has(context, "save it as UTF-8");
        }
    }
    ASSERT_OK(context, read_wide(context, texts[0], 1, 0, "\xef\xbb\xbf", 3)); // UTF-8
    static const char film[] = "\0\0\0\x20"
                               "ftyp";
    uint8_t *bytes = alpi_allocate(context, sizeof film, 1);
    memcpy(bytes, film, sizeof film);
    alpi_gltf_document *document = NULL;
    assert_int_equal(alpi_gltf_document_parse(context, "film.gltf", bytes, sizeof film, &document),
                     ALP_ERROR_INVALID_DATA);
    test_message_has(context, "is not glTF");
}
