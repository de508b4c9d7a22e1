// SPDX-License-Identifier: MIT
#include "orm_asset.h"

#include "base/memory.h"
#include "formats/text/json_spans.h"
#include "test_gltf.h"

#include <math.h>
#include <stdio.h>

#include <jpeglib.h> // after stdio.h, which it needs

typedef struct orm_data {
    float positions[2][4][3], normals[2][4][3], uvs[2][4][2];
    uint16_t indices[6];
} orm_data;

orm_asset orm_asset_default(void)
{
    return (orm_asset){.floor = {0.1f, 0.125f, 0.7f, 0.9375f},
                       .lid = {0.75f, 0.125f, 0.95f, 0.5f},
                       .wrap = 10497, // repeat
                       .channels = 4};
}

uint8_t orm_asset_noise(uint32_t x, uint32_t y, uint32_t channel)
{
    uint32_t bits = (x + 1) * 2654435761u ^ (y + 7) * 2246822519u ^ (channel + 3) * 3266489917u;
    bits ^= bits >> 15;
    bits *= 2246822519u;
    return (uint8_t)(bits >> 21);
}

static void fill(const orm_asset *asset, orm_data *data)
{
    static const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    *data = (orm_data){0};
    memcpy(data->indices, indices, sizeof indices);
    for (int q = 0; q < 2; q++) {
        const float *range = q == 0 ? asset->floor : asset->lid;
        for (int v = 0; v < 4; v++) {
            data->positions[q][v][0] = (q == 0 ? 2.0f : 1.0f) * corners[v][0];
            data->positions[q][v][1] = q == 0 ? 0.0f : 0.5f;
            data->positions[q][v][2] = (q == 0 ? 2.0f : 1.0f) * (1.0f - corners[v][1]);
            data->normals[q][v][1] = 1.0f;
            for (int k = 0; k < 2; k++) {
                data->uvs[q][v][k] = range[k] + corners[v][k] * (range[2 + k] - range[k]);
            }
        }
    }
}

static void encode_noise(alp_context *context, uint32_t channels, uint8_t **bytes, size_t *size)
{
    alp_image *image = NULL;
    alp_image_info info = {ORM_WIDTH, ORM_HEIGHT, channels, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    for (uint32_t y = 0; y < ORM_HEIGHT; y++) {
        for (uint32_t x = 0; x < ORM_WIDTH; x++) {
            for (uint32_t c = 0; c < channels; c++) {
                alp_image_bytes(image)[(y * ORM_WIDTH + x) * channels + c] =
                    orm_asset_noise(x, y, c);
            }
        }
    }
    ASSERT_OK(context, alpi_png_encode(image, bytes, size));
    alp_image_destroy(image);
}

static size_t print_json(const orm_asset *asset, size_t image_size, bool jpeg, char *json,
                         size_t size)
{
    static const struct {
        int size, component, count;
        const char *type;
    } arrays[] = {{48, 5126, 4, "VEC3"},  {48, 5126, 4, "VEC3"}, {48, 5126, 4, "VEC3"},
                  {48, 5126, 4, "VEC3"},  {32, 5126, 4, "VEC2"}, {32, 5126, 4, "VEC2"},
                  {12, 5123, 6, "SCALAR"}};
    size_t at =
        (size_t)snprintf(json, size,
                         "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_texture_transform'],"
                         "'buffers':[{'byteLength':%zu}],'bufferViews':[",
                         sizeof(orm_data) + image_size);
    int offset = 0;
    for (int i = 0; i < 7; i++) {
        at += (size_t)snprintf(json + at, size - at,
                               "{'buffer':0,'byteOffset':%d,'byteLength':%d,'target':%d},", offset,
                               arrays[i].size, i == 6 ? 34963 : 34962);
        offset += arrays[i].size;
    }
    at += (size_t)snprintf(json + at, size - at,
                           "{'buffer':0,'byteOffset':%d,'byteLength':%zu}],'accessors':[", offset,
                           image_size);
    for (int i = 0; i < 7; i++) {
        at += (size_t)snprintf(
            json + at, size - at, "%s{'bufferView':%d,'componentType':%d,'count':%d,'type':'%s'%s}",
            i ? "," : "", i, arrays[i].component, arrays[i].count, arrays[i].type,
            i == 0   ? ",'min':[0,0,0],'max':[2,0,2]"
            : i == 1 ? ",'min':[0,0.5,0],'max':[1,0.5,1]"
                     : "");
    }
    at += (size_t)snprintf(
        json + at, size - at,
        "],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2,'TEXCOORD_0':4},"
        "'indices':6,'material':0}]},{'primitives':[{'attributes':{'POSITION':1,'NORMAL':3,"
        "'TEXCOORD_0':5},'indices':6,'material':1}]}],"
        "'samplers':[{'wrapS':%d,'wrapT':%d}],'images':[{'name':'orm','bufferView':7,"
        "'mimeType':'image/%s'}],'textures':%s,'materials':%s,%s}",
        asset->wrap, asset->wrap, jpeg ? "jpeg" : "png",
        asset->textures != NULL ? asset->textures : "[{'source':0,'sampler':0}]",
        asset->materials != NULL
            ? asset->materials
            : "[{'name':'floor','pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}},"
              "{'name':'lid','pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}}]",
        asset->nodes != NULL ? asset->nodes
                             : "'nodes':[{'name':'floor','mesh':0},{'name':'lid','mesh':1}],"
                               "'scenes':[{'nodes':[0,1]}],'scene':0");
    assert_true(at < size);
    return at;
}

const char *orm_asset_write(const orm_asset *asset)
{
    static char path[1024];
    static char json[8192];
    alp_context *context = test_context(1);
    uint8_t *png = NULL;
    size_t png_size = asset->image_size;
    if (asset->image == NULL) {
        encode_noise(context, asset->channels, &png, &png_size);
    }
    const uint8_t *image = asset->image != NULL ? asset->image : png;
    print_json(asset, png_size, image[0] == 0xff, json, sizeof json);
    uint8_t *bin = alpi_allocate(context, sizeof(orm_data) + png_size, 1);
    assert_non_null(bin);
    orm_data data;
    fill(asset, &data);
    memcpy(bin, &data, sizeof data);
    memcpy(bin + sizeof data, image, png_size);
    size_t size;
    uint8_t *glb = test_glb(context, json, bin, sizeof data + png_size, &size);
    snprintf(path, sizeof path, "%s/asset.glb", quad_folder());
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(glb, 1, size, file), size);
    fclose(file);
    alpi_release(context, glb);
    alpi_release(context, bin);
    alpi_release(context, png);
    alp_context_destroy(context);
    return path;
}

// --- a JPEG --------------------------------------------------------------------------------------

unsigned char *orm_asset_jpeg(size_t *jpeg_size)
{
    struct jpeg_compress_struct encoder;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    encoder.err = jpeg_std_error(&errors);
    jpeg_create_compress(&encoder);
    jpeg_mem_dest(&encoder, &bytes, &size);
    encoder.image_width = ORM_WIDTH;
    encoder.image_height = ORM_HEIGHT;
    encoder.input_components = 3;
    encoder.in_color_space = JCS_RGB;
    jpeg_set_defaults(&encoder);
    jpeg_start_compress(&encoder, TRUE);
    for (uint32_t y = 0; y < ORM_HEIGHT; y++) {
        uint8_t row[3 * ORM_WIDTH];
        for (uint32_t i = 0; i < 3 * ORM_WIDTH; i++) {
            row[i] = orm_asset_noise(i / 3, y, i % 3);
        }
        JSAMPROW rows[1] = {row};
        jpeg_write_scanlines(&encoder, rows, 1);
    }
    jpeg_finish_compress(&encoder);
    jpeg_destroy_compress(&encoder);
    *jpeg_size = (size_t)size;
    return bytes;
}

// --- a bake --------------------------------------------------------------------------------------

orm_bake orm_start(const orm_asset *asset)
{
    orm_bake p = {.context = test_context(2), .options = alp_bake_options_default()};
    test_log_clear();
    const char *path = orm_asset_write(asset);
    ASSERT_OK(p.context, alp_scene_load(p.context, path, &p.scene));
    snprintf(p.path, sizeof p.path, "%.*s baked.glb", (int)strlen(path) - 4, path);
    p.options.atlas.size = 64;
    p.options.atlas.mode = ALP_ATLAS_CHARTS;
    p.options.occlusion.samples = 64;
    p.options.occlusion.distance = INFINITY;
    p.options.occlusion.falloff = ALP_FALLOFF_NONE;
    p.options.ao_into = ALP_AO_INTO_ORM;
    p.options.overwrite = true;
    return p;
}

void orm_run(orm_bake *p)
{
    p->options.output = p->path;
    ASSERT_OK(p->context, alp_bake(p->scene, &p->options, &p->lightmap, NULL));
    quad_list(p->scene->name, p->path);
    ASSERT_OK(p->context, alp_scene_load(p->context, p->path, &p->result));
}

void orm_stop(orm_bake *p)
{
    alp_lightmap_destroy(p->lightmap);
    alp_scene_destroy(p->result);
    alp_scene_destroy(p->scene);
    alp_context_destroy(p->context);
}

const alpi_gltf_document *orm_document(const alp_scene *scene)
{
    return scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
}

const char *orm_text(const orm_bake *p, const char *path)
{
    static char text[4][4096];
    static int next;
    const alpi_gltf_document *document = orm_document(p->result);
    alpi_json_span root, span;
    assert_true(alpi_json_value(document->text, 0, document->text_size, &root));
    char *out = text[next++ % 4];
    out[0] = '\0';
    if (alpi_json_at(document->text, root, path, &span)) {
        snprintf(out, sizeof text[0], "%.*s", (int)(span.end - span.begin),
                 document->text + span.begin);
    }
    return out;
}

const alp_image *orm_image(const orm_bake *p, int material)
{
    const alpi_texture *texture = &p->result->materials[material].occlusion_texture;
    assert_int_not_equal(texture->image, ALPI_NONE);
    return p->result->images[texture->image];
}

void orm_check_meshes_kept(const orm_bake *p)
{
    const alpi_gltf_document *old = orm_document(p->scene), *new = orm_document(p->result);
    alpi_json_span root, a, b;
    assert_true(alpi_json_value(old->text, 0, old->text_size, &root));
    assert_true(alpi_json_at(old->text, root, "meshes", &a));
    assert_true(alpi_json_value(new->text, 0, new->text_size, &root));
    assert_true(alpi_json_at(new->text, root, "meshes", &b));
    assert_int_equal(a.end - a.begin, b.end - b.begin);
    assert_memory_equal(old->text + a.begin, new->text + b.begin, a.end - a.begin);
    json_t *view = alpi_gltf_item(old, "bufferViews", 7); // the image, which may go
    const json_int_t begin = json_integer_value(json_object_get(view, "byteOffset"));
    assert_memory_equal(old->bin, new->bin, (size_t)begin);
}
