// SPDX-License-Identifier: MIT
// Maps as files of every format: what is read from them is what the library hands out, as near as
// their numbers go.
#include "base/half.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <zstd.h>

enum { SIZE = 24, NUMBERS = 4 * SIZE * SIZE, FORMATS = ALP_MAPS_KTX2 + 1 };
static const char *const endings[FORMATS] = {".exr", ".exr", ".hdr", ".ktx2"};

/// A page as it was read: RGBA; alpha 1 where the file has none.
typedef struct read_page {
    float pixels[NUMBERS];
    float scale; // that a KTX2 file states
} read_page;

static uint64_t number(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = 0; i < size; i++) {
        value |= (uint64_t)bytes[i] << 8 * i;
    }
    return value;
}

static float stated_scale(const uint8_t *bytes, size_t size)
{
    static const char key[] = "alpenglowScale";
    for (size_t i = 0; i + sizeof key < size; i++) {
        if (memcmp(bytes + i, key, sizeof key) == 0) {
            return strtof((const char *)bytes + i + sizeof key, NULL);
        }
    }
    return NAN;
}

static void read_ktx2(const char *path, read_page *page)
{
    size_t size = 0;
    uint8_t *bytes = test_read_file(path, &size), *halves = malloc(2 * NUMBERS);
    assert_non_null(halves);
    assert_true(number(bytes + 20, 4) == SIZE && number(bytes + 24, 4) == SIZE);
    const uint64_t level = number(bytes + 80, 8);
    assert_int_equal(ZSTD_decompress(halves, 2 * NUMBERS, bytes + level, size - level),
                     2 * NUMBERS);
    page->scale = stated_scale(bytes, level);
    for (int i = 0; i < NUMBERS; i++) {
        const float value = alpi_half_to_float((uint16_t)number(halves + 2 * (size_t)i, 2));
        page->pixels[i] = i % 4 == 3 ? value : value * page->scale;
    }
    free(halves);
    free(bytes);
}

static void read_file(alp_context *context, const char *path, read_page *page)
{
    if (strstr(path, ".ktx2") != NULL) {
        read_ktx2(path, page);
        return;
    }
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_load(context, path, &image));
    const alp_image_info info = alp_image_get_info(image);
    assert_true(info.width == SIZE && info.height == SIZE);
    assert_int_equal(info.channels, strstr(path, ".hdr") != NULL ? 3 : 4);
    for (size_t i = 0; i < NUMBERS; i++) {
        page->pixels[i] =
            i % 4 < info.channels ? alp_image_floats(image)[i / 4 * info.channels + i % 4] : 1.0f;
    }
    page->scale = NAN;
    alp_image_destroy(image);
}

/// How far a number may be off: halves are the nearest of 11 bits, and of 24 below the normal
/// ones; RGBE has 8 bits of the largest of three, rounded.
static double step_of(alp_maps_format format, const float *pixel, int channel, double scale)
{
    const double value = fabs((double)pixel[channel]);
    const double most =
        fmax(fmax(fabs((double)pixel[0]), fabs((double)pixel[1])), fabs((double)pixel[2]));
    return format == ALP_MAPS_EXR   ? 0.0
           : format == ALP_MAPS_HDR ? most / 255.0
                                    : fmax(value * 0x1p-11, scale * 0x1p-25);
}

/// Holds one file to one page. @param name "irradiance"   @return the brightest number
static double check_file(alp_context *context, const char *folder, const char *name, uint32_t page,
                         alp_maps_format format, const float *wanted)
{
    char file[64], number_of_page[16] = "";
    read_page got;
    double brightest = 0.0;
    if (page > 0) {
        snprintf(number_of_page, sizeof number_of_page, ".%u", page);
    }
    snprintf(file, sizeof file, "%s%s%s", name, number_of_page, endings[format]);
    read_file(context, test_path(folder, file), &got);
    const double scale = isnan(got.scale) ? 1.0 : (double)got.scale;
    for (size_t i = 0; i < NUMBERS; i++) {
        const float *pixel = wanted + i / 4 * 4;
        if (i % 4 == 3) {
            assert_true(format == ALP_MAPS_HDR || got.pixels[i] == pixel[3]);
            continue;
        }
        ASSERT_NEAR(got.pixels[i], wanted[i], step_of(format, pixel, (int)(i % 4), scale));
        brightest = fmax(brightest, (double)wanted[i]);
    }
    return brightest;
}

static alp_bake_options options_of(unsigned maps, const char *folder, alp_maps_format format)
{
    alp_bake_options o = alp_bake_options_default();
    o.atlas.size = SIZE;
    o.atlas.mode = ALP_ATLAS_CHARTS;
    o.atlas.texels_per_metre = 20.0; // two pages and more
    o.occlusion.samples = 16;
    o.light.samples = 32;
    o.maps = maps;
    o.maps_folder = folder;
    o.maps_format = format;
    return o;
}

/// Maps and the scene that they are of.
typedef struct baked {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *maps;
} baked;

static baked bake(const alp_bake_options *o)
{
    baked b = {.context = test_context(2)};
    ASSERT_OK(b.context, alp_scene_load(b.context, "builtin:cornell", &b.scene));
    ASSERT_OK(b.context, alp_bake(b.scene, o, &b.maps, NULL));
    return b;
}

static void close_bake(baked *b)
{
    alp_lightmap_destroy(b->maps);
    alp_scene_destroy(b->scene);
    alp_context_destroy(b->context);
}

TEST(every_map_of_every_page_comes_back)
{
    static const struct {
        const char *name;
        alp_map map;
        bool is_signed;
    } maps[] = {{"ao", ALP_MAP_AO, false},
                {"irradiance", ALP_MAP_LIGHT, false},
                {"irradiance.direct", ALP_MAP_DIRECT, false},
                {"irradiance.bounced", ALP_MAP_BOUNCED, false},
                {"bent", ALP_MAP_BENT, true},
                {"direction", ALP_MAP_DIRECTION, true}};
    for (int format = 0; format < FORMATS; format++) {
        const char *folder = test_folder();
        const unsigned with_signs =
            format == ALP_MAPS_HDR ? 0u : ALP_MAP_BENT | ALP_MAP_SH | ALP_MAP_DIRECTION;
        alp_bake_options o =
            options_of(ALP_MAP_AO | ALP_MAP_LIGHT | with_signs, folder, (alp_maps_format)format);
        o.light.direct = ALP_DIRECT_APART;
        baked b = bake(&o);
        const alp_lightmap *l = b.maps;
        const uint32_t pages = alp_lightmap_page_count(l);
        assert_true(pages > 1);
        for (uint32_t p = 0; p < pages; p++) {
            for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
                const float *wanted = alp_lightmap_map_page(l, maps[i].map, p, NULL, NULL);
                assert_true((wanted != NULL) == (!maps[i].is_signed || with_signs != 0));
                if (wanted != NULL) {
                    check_file(b.context, folder, maps[i].name, p, o.maps_format, wanted);
                }
            }
            for (uint32_t k = 0; k < 4 && with_signs != 0; k++) {
                char name[8];
                snprintf(name, sizeof name, "sh.%u", k);
                check_file(b.context, folder, name, p, o.maps_format,
                           alp_lightmap_sh_page(l, k, p, NULL, NULL));
            }
        }
        // pictures stay, and nothing is there twice
        assert_int_equal(access(test_path(folder, "ao.png"), F_OK), 0);
        assert_int_equal(access(test_path(folder, "ao.exr"), F_OK) == 0, format < ALP_MAPS_HDR);
        assert_false(test_log_has("hdr-range"));
        close_bake(&b);
    }
}

TEST(layers_too)
{
    alp_lamp lamp = alp_lamp_default();
    lamp.position[1] = 0.3f;
    lamp.intensity = 0.2f;
    for (int format = 0; format < FORMATS; format++) {
        const char *folder = test_folder();
        alp_bake_options o = options_of(ALP_MAP_LIGHT, folder, (alp_maps_format)format);
        o.light.layers = true;
        o.light.lighting.lamps = &lamp;
        o.light.lighting.lamp_count = 1;
        baked b = bake(&o);
        const alp_lightmap *l = b.maps;
        assert_int_equal(alp_lightmap_layer_count(l), 2);
        for (uint32_t i = 0; i < 2 * alp_lightmap_page_count(l); i++) {
            char name[96];
            snprintf(name, sizeof name, "irradiance.%.64s", alp_lightmap_layer_name(l, i % 2));
            check_file(b.context, folder, name, i / 2, o.maps_format,
                       alp_lightmap_layer_page(l, i % 2, i / 2, NULL, NULL));
        }
        close_bake(&b);
    }
}

/// Light beyond 65504: what is read is still the light, coverage is still coverage, and it is said.
TEST(light_beyond_halves_is_scaled)
{
    static const alp_maps_format formats[] = {ALP_MAPS_EXR_HALF, ALP_MAPS_KTX2};
    for (int i = 0; i < 2; i++) {
        const char *folder = test_folder();
        test_log_clear();
        alp_bake_options o = options_of(ALP_MAP_LIGHT, folder, formats[i]);
        o.light.lighting.sky.kind = ALP_SKY_CONSTANT;
        o.light.lighting.sky.strength = 1e6f;
        baked b = bake(&o);
        const alp_lightmap *l = b.maps;
        for (uint32_t p = 0; p < alp_lightmap_page_count(l); p++) {
            const float *wanted = alp_lightmap_map_page(l, ALP_MAP_LIGHT, p, NULL, NULL);
            const double most =
                check_file(b.context, folder, "irradiance", p, o.maps_format, wanted);
            read_page page;
            if (formats[i] == ALP_MAPS_KTX2 && p == 0) {
                int exponent;
                read_ktx2(test_path(folder, "irradiance.ktx2"), &page);
                assert_true(frexpf(page.scale, &exponent) == 0.5f);
                assert_true(most / (double)page.scale <= (double)ALPI_HALF_MAX &&
                            most / (double)page.scale > 0.5 * (double)ALPI_HALF_MAX);
            }
        }
        assert_true(test_log_has("maps-scaled"));
        close_bake(&b);
    }
}

TEST_WITH_CONTEXT(what_a_format_cannot_hold_is_refused, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const char *folder = test_path(test_folder(), "none");
    const struct {
        const char *folder;
        unsigned maps;
        int format;
    } bad[] = {{folder, ALP_MAP_AO | ALP_MAP_BENT, ALP_MAPS_HDR},
               {folder, ALP_MAP_LIGHT | ALP_MAP_SH, ALP_MAPS_HDR},
               {folder, ALP_MAP_LIGHT | ALP_MAP_DIRECTION, ALP_MAPS_HDR},
               {NULL, ALP_MAP_AO, ALP_MAPS_KTX2},
               {folder, ALP_MAP_AO, FORMATS},
               {folder, ALP_MAP_AO, -1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const alp_bake_options o =
            options_of(bad[i].maps, bad[i].folder, (alp_maps_format)bad[i].format);
        assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
        assert_int_not_equal(access(folder, F_OK), 0);
    }
    alp_scene_destroy(scene);
}

/// A file that is there stops the bake before it begins, by the name it has in that format.
TEST(files_are_checked_by_their_names)
{
    for (int format = 0; format < FORMATS; format++) {
        alp_context *context = test_context(1);
        const char *folder = test_folder();
        alp_bake_options o = options_of(ALP_MAP_AO, folder, (alp_maps_format)format);
        char name[16];
        snprintf(name, sizeof name, "ao%s", endings[format]);
        FILE *file = fopen(test_path(folder, name), "wb");
        assert_non_null(file);
        fclose(file);
        alp_scene *scene = test_load(context, "builtin:cornell");
        assert_int_equal(alp_bake(scene, &o, NULL, NULL), ALP_ERROR_IO);
        o.overwrite = true;
        ASSERT_OK(context, alp_bake(scene, &o, NULL, NULL));
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
