// SPDX-License-Identifier: MIT
// Baked light in the asset: what a reader of each form gets is what was baked.
#include "orm_asset.h"

#include "bake/job.h"
#include "base/half.h"
#include "formats/text/json_spans.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const float PI = 3.14159265f;

// A floor that glows a little below a bright lid: two materials far apart in what they reach.
static const char plain[] =
    "[{'name':'floor','pbrMetallicRoughness':{'baseColorFactor':[0.8,0.4,0.1,1],"
    "'metallicFactor':0.25},'emissiveFactor':[0.05,0,0.2]},"
    "{'name':'lid','doubleSided':true,'emissiveFactor':[1,0.5,0.25],"
    "'pbrMetallicRoughness':{'metallicFactor':0},"
    "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':20}}}]";

static orm_bake start(const char *materials, alp_lightmap_as as)
{
    orm_asset asset = orm_asset_default();
    asset.materials = materials;
    orm_bake p = orm_start(&asset);
    p.options.ao_into = ALP_AO_INTO_SEPARATE;
    p.options.maps = ALP_MAP_LIGHT;
    p.options.lightmap_as = as;
    p.options.light.samples = 32;
    p.options.light.bounces = 1;
    p.options.light.lighting.sky.kind = ALP_SKY_HEMISPHERE;
    p.options.light.lighting.sky.up[0] = 0.5f; // of 1
    return p;
}

static uint32_t material_of(const orm_bake *p, uint32_t texel)
{
    const uint32_t triangle = p->lightmap->texels.triangles[texel];
    return p->scene->surfaces[p->scene->triangle_surface[triangle]].material;
}

static const float *irradiance_of(const orm_bake *p, uint32_t texel)
{
    const alp_lightmap *l = p->lightmap;
    const alpi_texels *t = &l->texels;
    return l->irradiance_pages[t->pages[texel]] +
           4 * ((size_t)t->pixels[texel][1] * l->width + t->pixels[texel][0]);
}

static const uint8_t *byte_of(const orm_bake *p, const alp_image *image, uint32_t texel)
{
    const uint16_t *pixel = p->lightmap->texels.pixels[texel];
    return (const uint8_t *)image->pixels + 3 * ((size_t)pixel[1] * image->info.width + pixel[0]);
}

// --- emissive ------------------------------------------------------------------------------------

/// ρE/π + Lₑ of a texel, with ρ and Lₑ as `plain` has them.
static double radiance_of(const orm_bake *p, uint32_t texel, int k)
{
    static const double albedo[2][3] = {{0.8, 0.4, 0.1}, {0.95, 0.95, 0.95}};
    static const double emission[2][3] = {{0.05, 0.0, 0.2}, {20.0, 10.0, 5.0}};
    const uint32_t m = material_of(p, texel);
    return albedo[m][k] * (double)irradiance_of(p, texel)[k] / (double)PI + emission[m][k];
}

/// A texel beside a chart has the bytes of a covered neighbour, or of one that has them.
static void check_padding(const orm_bake *p, const alp_image *image)
{
    const uint32_t width = image->info.width, height = image->info.height;
    const float *page = p->lightmap->irradiance_pages[0];
    const uint8_t *bytes = image->pixels;
    for (uint32_t y = 1; y + 1 < height; y++) {
        for (uint32_t x = 1; x + 1 < width; x++) {
            const size_t at = (size_t)y * width + x;
            const size_t beside[4] = {at - 1, at + 1, at - width, at + width};
            bool same = page[4 * at + 3] > 0.0f;
            for (int k = 0; k < 4; k++) {
                same = same || memcmp(bytes + 3 * at, bytes + 3 * beside[k], 3) == 0;
            }
            assert_true(same);
        }
    }
}

TEST(emission_is_the_light_that_leaves)
{
    orm_bake p = start(plain, ALP_LIGHTMAP_AS_EMISSIVE);
    orm_run(&p);
    const alpi_texture *texture = &p.result->materials[0].emission_texture;
    const alp_image *image = p.result->images[texture->image];
    assert_int_equal(texture->uv_set, 1);
    double most[2] = {0.0, 0.0}, off = 0.0;
    uint32_t noisy = 0;
    for (uint32_t i = 0; i < p.lightmap->texels.count; i++) {
        const uint32_t m = material_of(&p, i);
        const double strength = (double)p.result->materials[m].emission[0];
        for (int k = 0; k < 3; k++) {
            const double value = radiance_of(&p, i, k);
            most[m] = fmax(most[m], value);
            // dithered: noise of a step and rounding; 0.01 for sums of floats and of 2^-40
            const double code = 255.0 * (double)alpi_linear_to_srgb((float)(value / strength));
            ASSERT_NEAR(byte_of(&p, image, i)[k], code, 1.51);
            off += ((double)byte_of(&p, image, i)[k] - code) / (3.0 * p.lightmap->texels.count);
            noisy += fabs((double)byte_of(&p, image, i)[k] - code) > 0.51;
        }
    }
    // The mean is kept, to four standard errors of half a step; a quarter rounds to another byte.
    ASSERT_NEAR(off, 0.0, 4.0 * 0.5 / sqrt(3.0 * p.lightmap->texels.count));
    assert_true(noisy > p.lightmap->texels.count / 4);
    check_padding(&p, image);
    for (uint32_t m = 0; m < 2; m++) { // all of the 8 bits of each material
        ASSERT_NEAR(p.result->materials[m].emission[0], most[m], 1e-5 * most[m]);
        assert_true(p.result->materials[m].base_color[0] == 0.0f);
    }
    assert_true(most[1] > 2.0 * most[0]);
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"), "");
    assert_string_equal(orm_text(&p, "materials/1/doubleSided"), "true");
    assert_string_equal(orm_text(&p, "extensionsUsed"),
                        "[\"KHR_texture_transform\",\"KHR_materials_emissive_strength\"]");
    orm_stop(&p);
}

/// Means over a texel of noise, against twice as many points to a side.
TEST(textures_are_averaged_over_a_texel)
{
    orm_bake p = start("[{'name':'floor','pbrMetallicRoughness':{'metallicFactor':0,"
                       "'baseColorTexture':{'index':0}}},{'name':'lid','emissiveFactor':[1,1,1]}]",
                       ALP_LIGHTMAP_AS_EMISSIVE);
    p.options.atlas.size = 32;
    orm_run(&p);
    const alp_image *image = p.result->images[p.result->materials[0].emission_texture.image];
    const alpi_receivers receivers = alpi_texels_receivers(&p.lightmap->texels);
    double squares = 0.0, mean = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < p.lightmap->texels.count; i++) {
        if (material_of(&p, i) != 0 || p.lightmap->texels.coverages[i] < 0.99f) {
            continue;
        }
        double albedo = 0.0;
        for (int j = 0; j < 64; j++) { // the floor's coordinates are affine in place
            const float square[1][2] = {
                {((float)(j % 8) + 0.5f) / 8.0f, ((float)(j / 8) + 0.5f) / 8.0f}};
            alpi_receiver_point point;
            receivers.place(receivers.user, i, 1, square, &point);
            const float u = 0.1f + 0.6f * point.position.x / 2.0f;
            const float v = 0.125f + 0.8125f * (1.0f - point.position.z / 2.0f);
            float rgba[4];
            alpi_image_sample(p.scene->images[0], u, v, (alpi_sampler){.srgb = true}, rgba);
            albedo += (double)fminf(rgba[0], 0.95f) / 64.0;
        }
        const double wanted = albedo * (double)irradiance_of(&p, i)[0] / (double)PI;
        const double seen = (double)(alpi_srgb_to_linear((float)byte_of(&p, image, i)[0] / 255.0f) *
                                     p.result->materials[0].emission[0]);
        squares += (seen - wanted) * (seen - wanted);
        mean += wanted;
        count++;
    }
    assert_true(count > 100);
    // 16 against 64 points of noise of three texels to a side, and 8 bits; one point gives 30 %
    assert_true(sqrt(squares / count) < 0.05 * mean / count);
    orm_stop(&p);
}

TEST(what_else_a_material_has)
{
    orm_bake p = start(
        "[{'name':'floor','alphaMode':'MASK','alphaCutoff':0.25,'pbrMetallicRoughness':{"
        "'baseColorFactor':[0.5,0.5,0.5,0.75],'baseColorTexture':{'index':0}},'extras':{'a':1},"
        "'extensions':{'KHR_materials_unlit':{},'VENDOR_x':{'b':[2]},"
        "'KHR_materials_emissive_strength':{'emissiveStrength':3}}},"
        "{'name':'lid','extensions':{'KHR_materials_transmission':{'transmissionFactor':1}}}]",
        ALP_LIGHTMAP_AS_EMISSIVE);
    orm_run(&p);
    assert_string_equal(
        orm_text(&p, "materials/0/pbrMetallicRoughness"),
        "{\"baseColorFactor\":[0,0,0,0.75],\"metallicFactor\":1,\"roughnessFactor\":1,"
        "\"baseColorTexture\":{\"index\":0}}");
    assert_string_equal(orm_text(&p, "materials/0/extensions/VENDOR_x"), "{\"b\":[2]}");
    assert_string_equal(orm_text(&p, "materials/0/extensions/KHR_materials_unlit"), "");
    assert_string_equal(orm_text(&p, "materials/0/extras"), "{\"a\":1}");
    assert_string_equal(orm_text(&p, "materials/0/alphaCutoff"), "0.25");
    assert_true(p.result->materials[0].emission[0] != 3.0f);
    // glass stays, and so does its mesh
    assert_true(test_log_has("light-glass"));
    assert_string_equal(orm_text(&p, "materials/1/emissiveTexture"), "");
    assert_string_equal(orm_text(&p, "meshes/1/primitives/0/attributes/TEXCOORD_1"), "");
    orm_stop(&p);
}

TEST(both_maps_where_both_are_asked_for)
{
    orm_bake p = start(plain, ALP_LIGHTMAP_AS_EMISSIVE);
    p.options.maps = ALP_MAP_AO | ALP_MAP_LIGHT;
    orm_run(&p);
    assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"),
                        "{\"index\":1,\"texCoord\":1}");
    assert_string_equal(orm_text(&p, "materials/0/emissiveTexture"),
                        "{\"index\":2,\"texCoord\":1}");
    assert_string_equal(orm_text(&p, "asset/extras/alpenglow/occlusion/unit"), "\"1\"");
    orm_stop(&p);
}

/// A primitive without a material gets one, and a bake of that bake takes its mark away.
TEST(a_primitive_without_material)
{
    static const alp_lightmap_as forms[] = {ALP_LIGHTMAP_AS_EMISSIVE, ALP_LIGHTMAP_AS_MOZ,
                                            ALP_LIGHTMAP_AS_EXTRAS};
    static const char none[] =
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":6}]}]";
    for (int i = 0; i < 3; i++) {
        orm_bake p = start(plain, forms[i]);
        alp_scene *scene = NULL;
        const char *path = quad_write_glb("{\"version\":\"2.0\"}", none);
        ASSERT_OK(p.context, alp_scene_load(p.context, path, &scene));
        alp_scene_destroy(p.scene);
        p.scene = scene;
        snprintf(p.path, sizeof p.path, "%s lit.glb", path);
        orm_run(&p);
        assert_string_equal(orm_text(&p, "materials/0/extras/alpenglow"),
                            i == 0 ? "" : "\"no material\"");
        if (forms[i] == ALP_LIGHTMAP_AS_MOZ) { // again, as emission
            alp_scene *second = NULL;
            p.options.lightmap_as = ALP_LIGHTMAP_AS_EMISSIVE;
            ASSERT_OK(p.context, alp_bake(p.result, &p.options, NULL, NULL));
            ASSERT_OK(p.context, alp_scene_load(p.context, p.path, &second));
            assert_true(second->materials[0].base_color[0] == 0.0f);
            assert_true(second->materials[0].emission_texture.image != ALPI_NONE);
            alp_scene_destroy(second);
        }
        orm_stop(&p);
    }
}

// --- MOZ_lightmap --------------------------------------------------------------------------------

TEST(moz_is_irradiance_over_its_intensity)
{
    for (int over_pi = 0; over_pi < 2; over_pi++) {
        orm_bake p = start(plain, ALP_LIGHTMAP_AS_MOZ);
        p.options.light_units = over_pi ? ALP_LIGHT_IRRADIANCE_OVER_PI : ALP_LIGHT_UNITS_AUTO;
        orm_run(&p);
        double intensity[2];
        for (int m = 0; m < 2; m++) {
            char path[64];
            snprintf(path, sizeof path, "materials/%d/extensions/MOZ_lightmap/intensity", m);
            intensity[m] = strtod(orm_text(&p, path), NULL);
        }
        alp_image *image = NULL; // the asset's reader takes no notice of it
        const alpi_gltf_document *document = orm_document(p.result);
        const size_t begin = strtoul(orm_text(&p, "bufferViews/8/byteOffset"), NULL, 10);
        const size_t size = strtoul(orm_text(&p, "bufferViews/8/byteLength"), NULL, 10);
        ASSERT_OK(p.context,
                  alpi_png_decode(p.context, "light", document->bin + begin, size, &image));
        for (uint32_t i = 0; i < p.lightmap->texels.count; i++) {
            const double scale = intensity[material_of(&p, i)] * (over_pi ? (double)PI : 1.0);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(byte_of(&p, image, i)[k],
                            255.0 * (double)irradiance_of(&p, i)[k] / scale, 0.51); // rounding
            }
        }
        alp_image_destroy(image);
        assert_string_equal(orm_text(&p, "materials/0/extensions/MOZ_lightmap/texCoord"), "1");
        assert_string_equal(orm_text(&p, "materials/0/emissiveFactor"), "[0.05,0,0.2]");
        assert_string_equal(orm_text(&p, "extensionsRequired"), "");
        assert_string_equal(orm_text(&p, "asset/extras/alpenglow/light/units"),
                            over_pi ? "\"irradiance/pi\"" : "\"irradiance\"");
        assert_string_equal(orm_text(&p, "asset/extras/alpenglow/occlusion"), "");
        orm_stop(&p);
    }
}

// --- the file's own occlusion
// ---------------------------------------------------------------------

static const char occluded[] =
    "[{'name':'floor','pbrMetallicRoughness':{'metallicFactor':0},'occlusionTexture':{'index':0}},"
    "{'occlusionTexture':{'index':0,'strength':0.5}}]"; // one that has nothing else

/// A viewer would darken the light again. In emission it cannot, and what is asked for stays.
TEST(own_occlusion_goes_where_light_comes)
{
    static const struct {
        alp_lightmap_as as;
        unsigned maps;
        alp_existing_ao existing;
        const char *floor, *lid;
    } cases[] = {
        {ALP_LIGHTMAP_AS_MOZ, ALP_MAP_LIGHT, ALP_EXISTING_AO_REPLACE, "", ""},
        {ALP_LIGHTMAP_AS_EXTRAS, ALP_MAP_LIGHT, ALP_EXISTING_AO_REPLACE, "", ""},
        {ALP_LIGHTMAP_AS_EXTRAS, ALP_MAP_LIGHT, ALP_EXISTING_AO_KEEP, "{\"index\":0}",
         "{\"index\":0,\"strength\":0.5}"},
        {ALP_LIGHTMAP_AS_EMISSIVE, ALP_MAP_LIGHT, ALP_EXISTING_AO_REPLACE, "{\"index\":0}",
         "{\"index\":0,\"strength\":0.5}"},
        {ALP_LIGHTMAP_AS_MOZ, ALP_MAP_AO | ALP_MAP_LIGHT, ALP_EXISTING_AO_REPLACE,
         "{\"index\":0,\"texCoord\":1}", "{\"index\":0,\"texCoord\":1}"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        orm_bake p = start(occluded, cases[i].as);
        p.options.maps = cases[i].maps;
        p.options.existing_ao = cases[i].existing;
        test_log_clear();
        orm_run(&p);
        assert_string_equal(orm_text(&p, "materials/0/occlusionTexture"), cases[i].floor);
        assert_string_equal(orm_text(&p, "materials/1/occlusionTexture"), cases[i].lid);
        assert_int_equal(strstr(test_log_text(), "2 materials lose their own occlusion") != NULL,
                         cases[i].floor[0] == '\0');
        const bool moz = cases[i].as == ALP_LIGHTMAP_AS_MOZ;
        if (cases[i].as != ALP_LIGHTMAP_AS_EMISSIVE) {
            assert_string_not_equal(orm_text(&p, moz ? "materials/1/extensions/MOZ_lightmap"
                                                     : "materials/1/extras/lightmap"),
                                    "");
        }
        orm_stop(&p);
    }
}

// --- extras --------------------------------------------------------------------------------------

/// The file that extras name, beside the asset.
static alp_image *load_named(const orm_bake *p, const char *name)
{
    alp_image *image = NULL;
    char path[1100];
    snprintf(path, sizeof path, "%.*s%s", (int)(strrchr(p->path, '/') + 1 - p->path), p->path,
             name);
    ASSERT_OK(p->context, alp_image_load(p->context, path, &image));
    return image;
}

TEST(extras_name_a_file_of_irradiance)
{
    static const char *const endings[] = {".glb", ".gltf"};
    for (int i = 0; i < 2; i++) {
        orm_bake p = start(plain, ALP_LIGHTMAP_AS_EXTRAS);
        p.options.lightmap_format = ALP_LIGHTMAP_EXR;
        snprintf(strrchr(p.path, '.'), 8, "%s", endings[i]);
        orm_run(&p);
        assert_string_equal(orm_text(&p, "materials/0/extras/lightmap"),
                            "{\"uri\":\"asset%20baked.light.exr\",\"texCoord\":1,\"intensity\":1,"
                            "\"units\":\"irradiance\"}");
        assert_string_equal(orm_text(&p, "images/1"), ""); // glTF can carry none such
        alp_image *image = load_named(&p, "asset baked.light.exr");
        for (uint32_t t = 0; t < p.lightmap->texels.count; t++) {
            const uint16_t *pixel = p.lightmap->texels.pixels[t];
            float rgba[4];
            alpi_image_pixel(image, pixel[0], pixel[1], rgba);
            for (int k = 0; k < 3; k++) {
                const uint16_t half = alpi_half_from_float(irradiance_of(&p, t)[k]);
                assert_true(rgba[k] == alpi_half_to_float(half));
            }
        }
        alp_image_destroy(image);
        orm_stop(&p);
    }
}

/// Light beyond half floats: the least power of two that brings it in, stated where it is read.
TEST(halves_that_would_overflow_are_scaled)
{
    orm_bake p = start(plain, ALP_LIGHTMAP_AS_EXTRAS);
    p.options.lightmap_format = ALP_LIGHTMAP_EXR;
    p.options.light.lighting.sky.strength = 1e6f;
    orm_run(&p);
    float most = 0.0f;
    for (uint32_t t = 0; t < p.lightmap->texels.count; t++) {
        most = fmaxf(most, fmaxf(irradiance_of(&p, t)[0], irradiance_of(&p, t)[1]));
    }
    const float scale = strtof(orm_text(&p, "materials/0/extras/lightmap/intensity"), NULL);
    int exponent;
    assert_true(frexpf(scale, &exponent) == 0.5f);
    assert_true(most / scale <= ALPI_HALF_MAX && most / scale > ALPI_HALF_MAX / 2.0f);
    alp_image *image = load_named(&p, "asset baked.light.exr");
    const uint16_t *pixel = p.lightmap->texels.pixels[0];
    float rgba[4];
    alpi_image_pixel(image, pixel[0], pixel[1], rgba);
    const float e = irradiance_of(&p, 0)[0];
    ASSERT_NEAR(rgba[0], e, 0x1p-11 * (double)e); // half a step of 11 bits; the file states it too
    alp_image_destroy(image);
    orm_stop(&p);
}

TEST(every_format_is_written)
{
    static const char *const endings[] = {".ktx2", ".exr", ".hdr"};
    for (int i = 0; i < 3; i++) {
        orm_bake p = start(plain, ALP_LIGHTMAP_AS_EXTRAS);
        p.options.lightmap_format = (alp_lightmap_format)i;
        p.options.light_units = ALP_LIGHT_RADIANCE;
        orm_run(&p);
        char wanted[64], path[1100];
        snprintf(wanted, sizeof wanted, "\"asset%%20baked.light%s\"", endings[i]);
        assert_string_equal(orm_text(&p, "materials/1/extras/lightmap/uri"), wanted);
        assert_string_equal(orm_text(&p, "materials/1/extras/lightmap/units"), "\"radiance\"");
        snprintf(path, sizeof path, "%.*s.light%s", (int)strlen(p.path) - 4, p.path, endings[i]);
        assert_int_equal(access(path, F_OK), 0);
        // a file that is there stops the next bake before it begins
        snprintf(path, sizeof path, "%.*s.again.light%s", (int)strlen(p.path) - 4, p.path,
                 endings[i]);
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fclose(file);
        snprintf(strrchr(p.path, '.'), 16, ".again.glb");
        p.options.overwrite = false;
        assert_int_equal(alp_bake(p.scene, &p.options, NULL, NULL), ALP_ERROR_IO);
        assert_non_null(strstr(alp_context_message(p.context), endings[i]));
        orm_stop(&p);
    }
}

// --- what is refused, what may go wrong
// -----------------------------------------------------------

TEST(choices_without_meaning_are_refused)
{
    orm_bake p = start(plain, ALP_LIGHTMAP_AS_EMISSIVE);
    p.options.output = p.path;
    const alp_bake_options good = p.options;
    alp_bake_options bad[10];
    for (int i = 0; i < 10; i++) {
        bad[i] = good;
    }
    bad[0].lightmap_as = (alp_lightmap_as)9;
    bad[1].light_units = (alp_light_units)9;
    bad[2].light_units = ALP_LIGHT_IRRADIANCE; // of emission
    bad[3].lightmap_as = ALP_LIGHTMAP_AS_MOZ;
    bad[3].light_units = ALP_LIGHT_RADIANCE;
    bad[4].maps = ALP_MAP_AO;
    bad[5].lightmap_as = ALP_LIGHTMAP_AS_NONE; // and glTF has no place for light
    bad[6].lightmap_format = ALP_LIGHTMAP_EXR;
    bad[7].maps |= ALP_MAP_AO;
    bad[7].ao_into = ALP_AO_INTO_ORM;
    bad[8].output = NULL;
    bad[9].light.direct = ALP_DIRECT_OFF; // a black material shows no other light
    for (int i = 0; i < 10; i++) {
        assert_int_equal(alp_bake(p.scene, &bad[i], NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    }
    orm_stop(&p);
}

TEST(workers_do_not_change_a_bit)
{
    orm_bake p = start(plain, ALP_LIGHTMAP_AS_EMISSIVE);
    p.options.output = p.path;
    unsigned char *bytes[2];
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        alp_context *context = test_context(i == 0 ? 1 : 7);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, p.scene->name, &scene));
        ASSERT_OK(context, alp_bake(scene, &p.options, NULL, NULL));
        bytes[i] = test_read_file(p.path, &sizes[i]);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
    orm_stop(&p);
}

/// Whatever allocation fails, the bake says so, writes nothing, and loses no memory.
TEST(memory_may_run_out_anywhere)
{
    for (int form = ALP_LIGHTMAP_AS_EMISSIVE; form <= ALP_LIGHTMAP_AS_EXTRAS; form++) {
        orm_bake p = start(plain, (alp_lightmap_as)form);
        p.options.output = p.path;
        p.options.atlas.size = 16;
        p.options.light.samples = 1;
        int left = 1 << 20;
        alp_context *context = test_context_failing(&left);
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_load(context, p.scene->name, &scene));
        alp_result result = ALP_ERROR_OUT_OF_MEMORY;
        for (int i = 0; result != ALP_OK; i += TEST_STEP) {
            assert_true(i < 10000);
            left = i;
            result = alp_bake(scene, &p.options, NULL, NULL);
            left = 1 << 20; // the allocator reads it
            assert_int_equal(access(p.path, F_OK) == 0, result == ALP_OK);
            assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
        orm_stop(&p);
    }
}
