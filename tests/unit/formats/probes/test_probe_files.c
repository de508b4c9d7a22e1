// SPDX-License-Identifier: MIT
// Probes come back from their files: all kinds of volumes, the power of two, names, overwriting.
#include "test_volume.h"

#include "base/half.h"
#include "base/memory.h"
#include "formats/formats.h"
#include "formats/probes/probe_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

TEST_CONTEXT(1);

static const char *folder;

static const char *path_of(const char *name)
{
    folder = folder != NULL ? folder : test_folder();
    return test_path(folder, name);
}

/// Writes, reads and compares.
static void round_trip(test_volume_options options)
{
    alpi_probe_volume v = test_volume(context, options), again;
    ASSERT_OK(context, alpi_probes_save(&v, path_of("trip.probes.json"), true));
    ASSERT_OK(context, alpi_probes_load(context, path_of("trip.probes.json"), &again));
    test_volume_same(&v, &again);
    alpi_probe_volume_destroy(&v);
    alpi_probe_volume_destroy(&again);
}

TEST(every_kind_comes_back)
{
    for (int basis = 0; basis < 3; basis++) {
        for (int kind = 0; kind < 16; kind++) {
            round_trip((test_volume_options){.size = {3, 4, 5},
                                             .is_list = (kind & 1) != 0,
                                             .basis = (alpi_probe_basis)basis,
                                             .layers = (kind & 2) != 0 ? 2 : 0,
                                             .gradients = (kind & 4) != 0,
                                             .moments = (kind & 8) != 0});
        }
    }
}

/// A single probe, a list that fills a row, and one that begins a second.
TEST(sizes_at_the_edges_come_back)
{
    static const uint32_t counts[] = {1, 255, 256, 257, 513};
    round_trip((test_volume_options){.size = {1, 1, 1}, .moments = true});
    round_trip((test_volume_options){.size = {1, 300, 2}, .basis = ALPI_PROBE_SH4});
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        round_trip((test_volume_options){
            .size = {counts[i]}, .is_list = true, .basis = ALPI_PROBE_SH4, .moments = true});
    }
}

TEST(scales_of_every_size_come_back)
{
    for (int exponent = -100; exponent <= 120; exponent += 11) {
        round_trip((test_volume_options){
            .size = {2, 2, 2}, .layers = 1, .gradients = true, .times = ldexpf(1.0f, exponent)});
    }
}

/// The largest stored magnitude is in (16384, 32768] where light is strong, in (½, 1] where it is
/// weak, else the light is stored as it is.
TEST(the_scale_is_the_right_power_of_two)
{
    static const struct {
        float most;
        double scale;
    } cases[] = {{0.0f, 1.0},         {1.0f, 1.0},      {32768.0f, 1.0},       {32769.0f, 2.0},
                 {65536.0f, 2.0},     {65537.0f, 4.0},  {0.0625f, 1.0},        {0.0624f, 0.0625},
                 {0.03125f, 0.03125}, {3e38f, 0x1p113}, {0x1p-149f, 0x1p-149}, {-70000.0f, 4.0}};
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {1, 1, 1}});
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memset(v.coefficients, 0, 27 * sizeof(float));
        v.coefficients[26] = cases[i].most;
        assert_true(alpi_probe_scale(&v) == cases[i].scale);
    }
    alpi_probe_volume_destroy(&v);
}

/// A value between halves is off by at most half a step of the largest binade that it lies in.
TEST(values_are_rounded_to_halves)
{
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {4, 4, 4}}), again;
    for (size_t i = 0; i < (size_t)27 * v.count; i++) {
        v.coefficients[i] = 1e5f * sinf((float)i);
    }
    ASSERT_OK(context, alpi_probes_save(&v, path_of("round.probes.json"), true));
    ASSERT_OK(context, alpi_probes_load(context, path_of("round.probes.json"), &again));
    for (size_t i = 0; i < (size_t)27 * v.count; i++) {
        ASSERT_NEAR(again.coefficients[i], v.coefficients[i],
                    fabsf(v.coefficients[i]) * 0x1p-11f + 1e-3f);
    }
    alpi_probe_volume_destroy(&v);
    alpi_probe_volume_destroy(&again);
}

/// Texels where the page on the format puts them.
TEST(texels_lie_where_the_format_says)
{
    enum { NX = 2, NY = 3, NZ = 4, C3 = 12, SET = 3 };
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {NX, NY, NZ},
                                                                     .basis = ALPI_PROBE_SH4,
                                                                     .layers = 1,
                                                                     .gradients = true,
                                                                     .moments = true});
    alpi_half_texture t, m;
    ASSERT_OK(context, alpi_probe_texture_shapes(&v, true, &t, &m));
    assert_int_equal(t.width, NX);
    assert_int_equal(t.height, NY);
    assert_int_equal(t.depth, NZ * (SET + 1 + SET + 3 * SET));
    assert_int_equal(m.width, 8 * NX);
    assert_int_equal(m.height, 8 * NY);
    assert_int_equal(m.depth, NZ);
    t.texels = ALPI_NEW(context, uint8_t, alpi_half_texture_size(&t));
    m.texels = ALPI_NEW(context, uint8_t, alpi_half_texture_size(&m));
    alpi_probe_pack(&v, 1.0, &t);
    alpi_probe_pack_moments(&v, &m);
    const uint32_t x = 1, y = 2, z = 3, probe = x + NX * (y + NY * z);
    const uint32_t firsts[] = {0, SET + 1, 2 * SET + 1, 3 * SET + 1, 4 * SET + 1};
    for (uint32_t set = 0; set < 5; set++) {
        for (uint32_t k = 0; k < C3; k++) {
            const uint32_t slice = (firsts[set] + k / 4) * NZ + z;
            const uint8_t *at = t.texels + 2 * (4 * ((slice * NY + y) * NX + x) + k % 4);
            assert_int_equal(at[0] | at[1] << 8,
                             alpi_half_from_float(test_volume_value(probe, set, k)));
        }
    }
    const uint8_t *state = t.texels + 8 * (((SET * NZ + z) * NY + y) * NX + x) + 6;
    assert_int_equal(state[0] | state[1] << 8, alpi_half_from_float((float)(probe % 4)));
    const uint32_t row = 8 * y + 5, column = 8 * x + 6; // direction 5 · 8 + 6
    const uint8_t *moment = m.texels + 4 * ((z * 8 * NY + row) * 8 * NX + column);
    const float mean = (float)(1 + (probe + 46) % 31) / 32.0f;
    assert_int_equal(moment[0] | moment[1] << 8, alpi_half_from_float(mean));
    assert_int_equal(moment[2] | moment[3] << 8, alpi_half_from_float(mean * mean));
    alpi_release(context, t.texels);
    alpi_release(context, m.texels);
    alpi_probe_volume_destroy(&v);
}

TEST(nothing_is_overwritten_unless_it_may)
{
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 2, 2}});
    size_t size = 0;
    FILE *file = fopen(path_of("kept.probes.ktx2"), "w");
    assert_non_null(file);
    fputs("precious", file);
    fclose(file);
    assert_int_equal(alpi_probes_save(&v, path_of("kept.probes.json"), false), ALP_ERROR_IO);
    assert_int_equal(alpi_probes_check_outputs(context, path_of("kept.probes.json"), false, false),
                     ALP_ERROR_IO);
    assert_int_not_equal(access(path_of("kept.probes.json"), F_OK), 0);
    unsigned char *bytes = test_read_file(path_of("kept.probes.ktx2"), &size);
    assert_int_equal(size, 8);
    assert_memory_equal(bytes, "precious", 8);
    free(bytes);
    ASSERT_OK(context, alpi_probes_check_outputs(context, path_of("kept.probes.json"), true, true));
    ASSERT_OK(context, alpi_probes_save(&v, path_of("kept.probes.json"), true));
    alpi_probe_volume_destroy(&v);
}

// --- refusals ------------------------------------------------------------------------------------

static void refused(const alpi_probe_volume *v, const char *name, const char *word)
{
    assert_int_equal(alpi_probes_save(v, path_of(name), true), ALP_ERROR_INVALID_ARGUMENT);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("\"%s\" does not say \"%s\"", alp_context_message(context), word);
    }
    assert_int_not_equal(access(path_of(name), F_OK), 0);
}

TEST(other_volumes_are_refused)
{
    alpi_probe_volume v = test_volume(
        context, (test_volume_options){.size = {2, 1, 1}, .layers = 1, .moments = true});
    static const char name[] = "refused.probes.json";
    refused(&v, "probes.txt", ".json");
    refused(&v, "\xff.probes.json", "UTF-8");
    refused(&v, "\n.probes.json", "control");
    v.coefficients[30] = NAN;
    refused(&v, name, "probe 1: coefficient");
    v.coefficients[30] = 0.0f;
    v.layers[0].coefficients[3] = INFINITY;
    refused(&v, name, "probe 0: coefficient of a layer");
    v.layers[0].coefficients[3] = 0.0f;
    v.moves[1][0] = 1e6f;
    refused(&v, name, "probe 1: move");
    v.moves[1][0] = 0.0f;
    v.spacing[1] = -1.0f;
    refused(&v, name, "-1 m apart");
    v.spacing[1] = 1.0f;
    v.reach = 0.0f;
    refused(&v, name, "reach");
    v.reach = 1.0f;
    v.size[0] = 3;
    refused(&v, name, "lattice");
    v.size[0] = 2;
    v.options[0] = '[';
    refused(&v, name, "options");
    v.options[0] = '{';
    ASSERT_OK(context, alpi_probes_save(&v, path_of(name), true));
    alpi_probe_volume_destroy(&v);
}
