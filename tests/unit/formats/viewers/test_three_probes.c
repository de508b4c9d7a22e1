// SPDX-License-Identifier: MIT
// Probes for three.js: texels where LightProbeGrid reads them, the module, and refusals. The
// browser test loads the files in three.js itself.
#include "test_small_bake.h"
#include "test_volume.h"

#include "base/half.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

TEST_CONTEXT(1);

/// @return the texture, whose texels the caller releases
static alpi_half_texture export_texture(const alpi_probe_volume *v, double scale)
{
    const char *folder = test_folder();
    alpi_half_texture t;
    size_t size = 0;
    ASSERT_OK(context, alpi_probes_export_three(v, test_path(folder, "a.mjs"), scale, false));
    unsigned char *bytes = test_read_file(test_path(folder, "a.ktx2"), &size);
    ASSERT_OK(context, alpi_ktx2_read(context, "a.ktx2", bytes, size, &t));
    free(bytes);
    return t;
}

/// Float k (of 28) of the texel at (x, y) of slice z of a sub-volume of nz slices; z −1 and nz are
/// the copies.
static float texel(const alpi_half_texture *t, uint32_t x, uint32_t y, int z, uint32_t k)
{
    const uint32_t nz = t->depth / 7 - 2;
    const uint32_t slice = k / 4 * (nz + 2) + (uint32_t)(z + 1);
    const uint8_t *at = t->texels + 8 * ((slice * t->height + y) * t->width + x) + 2 * (k % 4);
    return alpi_half_to_float((uint16_t)(at[0] | at[1] << 8));
}

static void all_valid(const alpi_probe_volume *v)
{
    memset(v->states, ALPI_PROBE_VALID, v->count);
}

TEST(texels_lie_where_three_reads_them)
{
    enum { NX = 3, NY = 4, NZ = 2 };
    for (int basis = 0; basis < 2; basis++) {
        alpi_probe_volume v = test_volume(
            context, (test_volume_options){.size = {NX, NY, NZ}, .basis = (alpi_probe_basis)basis});
        all_valid(&v);
        alpi_half_texture t = export_texture(&v, 0.5);
        assert_int_equal(t.width, NX);
        assert_int_equal(t.height, NY);
        assert_int_equal(t.depth, 7 * (NZ + 2));
        for (uint32_t i = 0; i < NX * NY * (NZ + 2) * 28; i++) {
            const uint32_t k = i % 28, x = i / 28 % NX, y = i / 28 / NX % NY;
            const int z = (int)(i / 28 / NX / NY) - 1;
            const uint32_t inside = z < 0 ? 0 : z < NZ ? (uint32_t)z : NZ - 1;
            const uint32_t probe = x + NX * (y + NY * inside);
            const bool stored = k < (basis == 0 ? 27 : 12);
            assert_true(texel(&t, x, y, z, k) ==
                        (stored ? 0.5f * test_volume_value(probe, 0, k) : 0.0f));
        }
        alpi_release(context, t.texels);
        alpi_probe_volume_destroy(&v);
    }
}

/// A single probe along an axis is there twice.
TEST(single_probes_are_doubled)
{
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {1, 3, 1}});
    all_valid(&v);
    alpi_half_texture t = export_texture(&v, 1.0);
    assert_int_equal(t.width, 2);
    assert_int_equal(t.height, 3);
    assert_int_equal(t.depth, 7 * 4);
    for (uint32_t i = 0; i < 2 * 3 * 2; i++) {
        assert_true(texel(&t, i % 2, i / 2 % 3, (int)i / 6, 0) ==
                    test_volume_value(i / 2 % 3, 0, 0));
    }
    alpi_release(context, t.texels);
    alpi_probe_volume_destroy(&v);
}

/// A row of dark probes takes light from its one end that has some, a dark volume stays dark.
TEST(dark_probes_take_light_from_neighbours)
{
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {5, 2, 2}});
    for (uint32_t i = 0; i < v.count; i++) {
        v.states[i] = i % 5 == 0 ? ALPI_PROBE_FILLED : ALPI_PROBE_INVALID;
        for (uint32_t k = 0; k < 27; k++) {
            v.coefficients[27 * i + k] = i % 5 == 0 ? 2.0f : 0.0f;
        }
    }
    alpi_half_texture t = export_texture(&v, 1.0);
    for (uint32_t i = 0; i < v.count; i++) {
        assert_true(texel(&t, i % 5, i / 5 % 2, (int)i / 10, 26) == 2.0f);
    }
    alpi_release(context, t.texels);
    memset(v.states, ALPI_PROBE_INVALID, v.count);
    t = export_texture(&v, 1.0);
    assert_true(texel(&t, 4, 1, 1, 26) == 0.0f);
    alpi_release(context, t.texels);
    alpi_probe_volume_destroy(&v);
}

TEST(the_module_names_its_texture)
{
    const char *folder = test_folder();
    size_t size = 0;
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 3, 1}});
    ASSERT_OK(context,
              alpi_probes_export_three(&v, test_path(folder, "my room's#1.mjs"), 1.0, false));
    assert_int_equal(access(test_path(folder, "my room's#1.ktx2"), F_OK), 0);
    char *text = (char *)test_read_file(test_path(folder, "my room's#1.mjs"), &size);
    assert_non_null(strstr(text, "'./my%20room%27s%231.ktx2'"));
    assert_non_null(strstr(text, "size = [2, 3, 2]"));
    assert_non_null(strstr(text, "spacing = [0.300000011921, 0.550000011921, 0.800000011921]"));
    assert_non_null(strstr(text, "first = [0.1, 1000000.1, 1999999.7"));
    free(text);
    assert_int_equal(alpi_probes_export_three(&v, test_path(folder, "my room's#1.mjs"), 1.0, false),
                     ALP_ERROR_IO);
    ASSERT_OK(context,
              alpi_probes_export_three(&v, test_path(folder, "my room's#1.mjs"), 1.0, true));
    alpi_probe_volume_destroy(&v);
}

// --- refusals ------------------------------------------------------------------------------------

static void refused(const alpi_probe_volume *v, const char *name, double scale, alp_result code,
                    const char *word)
{
    assert_int_equal(alpi_probes_export_three(v, test_path(test_folder(), name), scale, false),
                     code);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("\"%s\" does not say \"%s\"", alp_context_message(context), word);
    }
}

TEST(others_are_refused)
{
    alpi_probe_volume list =
        test_volume(context, (test_volume_options){.size = {3}, .is_list = true});
    alpi_probe_volume cube = test_volume(
        context, (test_volume_options){.size = {2, 2, 2}, .basis = ALPI_PROBE_AMBIENT_CUBE});
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 2, 2}});
    refused(&list, "a.mjs", 1.0, ALP_ERROR_UNSUPPORTED, "list");
    refused(&cube, "a.mjs", 1.0, ALP_ERROR_UNSUPPORTED, "ambient cube");
    refused(&v, "a.json", 1.0, ALP_ERROR_INVALID_ARGUMENT, ".mjs");
    refused(&v, "a.mjs", 0.0, ALP_ERROR_INVALID_ARGUMENT, "--export-scale");
    refused(&v, "a.mjs", (double)NAN, ALP_ERROR_INVALID_ARGUMENT, "--export-scale");
    v.coefficients[5] = -65504.0f;
    alpi_half_texture t = export_texture(&v, 1.0);
    alpi_release(context, t.texels);
    v.coefficients[5] = -65505.0f;
    refused(&v, "a.mjs", 1.0, ALP_ERROR_LIMIT, "--export-scale 0.5 or less");
    t = export_texture(&v, 0.5);
    alpi_release(context, t.texels);
    v.coefficients[5] = 3e9f;
    refused(&v, "a.mjs", 0.5, ALP_ERROR_LIMIT, "--export-scale 1.52588e-05 or less");
    v.coefficients[5] = NAN;
    refused(&v, "a.mjs", 1.0, ALP_ERROR_INVALID_ARGUMENT, "probe 0");
    alpi_probe_volume_destroy(&list);
    alpi_probe_volume_destroy(&cube);
    alpi_probe_volume_destroy(&v);
}

TEST(every_allocation_may_fail)
{
    const char *folder = test_folder();
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 2, 2}});
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    long failing = 1; // the context is the first
    for (; result != ALP_OK; failing++) {
        test_memory memory = {.failing = failing};
        alp_context *own = test_memory_context(&memory, 1);
        v.context = own;
        result = alpi_probes_export_three(&v, test_path(folder, "m.mjs"), 1.0, false);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(access(test_path(folder, "m.ktx2"), F_OK) == 0, result == ALP_OK);
        alp_context_destroy(own);
        assert_int_equal(atomic_load(&memory.live), 0);
    }
    assert_in_range(failing, 10, 100);
    v.context = context;
    alpi_probe_volume_destroy(&v);
}
