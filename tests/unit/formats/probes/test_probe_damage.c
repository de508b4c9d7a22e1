// SPDX-License-Identifier: MIT
// Damaged files of probes: each is refused with the right code and words, and nothing is left.
#include "test_small_bake.h"
#include "test_volume.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>

TEST_CONTEXT(1);

/// Good files of a lattice of 2 × 2 × 2 with a layer, gradients and moments, in memory.
typedef struct good_files {
    unsigned char *json, *coefficients, *moments;
    size_t json_size, coefficients_size, moments_size;
} good_files;

static good_files make_files(bool is_list)
{
    const char *folder = test_folder();
    good_files f;
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 2, 2},
                                                                     .is_list = is_list,
                                                                     .layers = 1,
                                                                     .gradients = true,
                                                                     .moments = true});
    ASSERT_OK(context, alpi_probes_save(&v, test_path(folder, "p.probes.json"), true));
    f.json = test_read_file(test_path(folder, "p.probes.json"), &f.json_size);
    f.coefficients = test_read_file(test_path(folder, "p.probes.ktx2"), &f.coefficients_size);
    f.moments = test_read_file(test_path(folder, "p.probes.moments.ktx2"), &f.moments_size);
    alpi_probe_volume_destroy(&v);
    return f;
}

static void free_files(good_files *f)
{
    free(f->json);
    free(f->coefficients);
    free(f->moments);
}

static alp_result decode(const good_files *f, const char *json, size_t size, bool unchecked,
                         alpi_probe_volume *v)
{
    const alpi_probe_bytes bytes = {
        "p.probes.json",      (const uint8_t *)json, f->coefficients, f->moments, size,
        f->coefficients_size, f->moments_size,       unchecked};
    return alpi_probes_decode(context, &bytes, v);
}

static void expect(alp_result result, alp_result code, const char *word)
{
    if (result != code || strstr(alp_context_message(context), word) == NULL) {
        fail_msg("%s, not %s: \"%s\" should say \"%s\"", alp_result_name(result),
                 alp_result_name(code), alp_context_message(context), word);
    }
}

// --- JSON ----------------------------------------------------------------------------------------

typedef struct change {
    const char *from, *to; // the first `from` becomes `to`
    alp_result code;
    const char *word; // that the message must have
} change;

static const change changes[] = {
    {"alpenglow-probes", "other", ALP_ERROR_INVALID_DATA, "no file of probes"},
    {"\"version\":1", "\"version\":2", ALP_ERROR_UNSUPPORTED, "version 2"},
    {"\"version\":1", "\"version\":2", ALP_ERROR_UNSUPPORTED, "reads version 1"},
    {"\"version\":1", "\"version\":0", ALP_ERROR_INVALID_DATA, "\"version\""},
    {"\"version\":1", "\"version\":1.5", ALP_ERROR_INVALID_DATA, "\"version\""},
    {"\"layout\":\"grid\"", "\"layout\":\"tree\"", ALP_ERROR_INVALID_DATA, "\"layout\""},
    {"\"layout\":\"grid\"", "\"layout\":\"list\"", ALP_ERROR_INVALID_DATA, "\"positions\""},
    {"[2,2,2]", "[2,2]", ALP_ERROR_INVALID_DATA, "\"size\""},
    {"[2,2,2]", "[2,0,2]", ALP_ERROR_INVALID_DATA, "\"size\""},
    {"[2,2,2]", "[2,-2,2]", ALP_ERROR_INVALID_DATA, "\"size\""},
    {"[2,2,2]", "[2,2.5,2]", ALP_ERROR_INVALID_DATA, "\"size\""},
    {"[2,2,2]", "[2,2,\"2\"]", ALP_ERROR_INVALID_DATA, "\"size\""},
    {"[2,2,2]", "[1000,1000,1000]", ALP_ERROR_LIMIT, "1000000000 probes"},
    {"[2,2,2]", "[4294967295,4294967295,4294967295]", ALP_ERROR_LIMIT, "probes"},
    {"[2,2,2]", "[2,2,4]", ALP_ERROR_INVALID_DATA, "\"count\""},
    {"\"count\":8", "\"count\":9", ALP_ERROR_INVALID_DATA, "\"count\""},
    {"\"spacing\":[", "\"spacing\":[-", ALP_ERROR_INVALID_DATA, "\"spacing\""},
    {"\"spacing\":[0.3", "\"spacing\":[0", ALP_ERROR_INVALID_DATA, "\"spacing\""},
    {"\"spacing\":[0.3", "\"spacing\":[1e99", ALP_ERROR_INVALID_DATA, "\"spacing\""},
    {"\"spacing\":[0.3", "\"spacing\":[NaN", ALP_ERROR_INVALID_DATA, "JSON, line"},
    {"\"origin\":[", "\"origin\":[1e999,", ALP_ERROR_INVALID_DATA, "JSON, line"},
    {"\"sh9\"", "\"sh16\"", ALP_ERROR_INVALID_DATA, "\"basis\""},
    {"\"radiance coefficients\"", "\"irradiance\"", ALP_ERROR_INVALID_DATA, "\"quantity\""},
    {"\"scale\":1", "\"scale\":3", ALP_ERROR_INVALID_DATA, "power of two"},
    {"\"scale\":1", "\"scale\":0", ALP_ERROR_INVALID_DATA, "\"scale\""},
    {"\"file\":\"", "\"file\":\"\\n", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"layers\":[", "\"layers\":[1,", ALP_ERROR_INVALID_DATA, "\"layers\""},
    {"\"layers\":[", "\"layers\":[{\"name\":\"b\"},", ALP_ERROR_INVALID_DATA, "texels"},
    {"\"gradients\":true", "\"gradients\":1", ALP_ERROR_INVALID_DATA, "\"gradients\""},
    {"\"gradients\":true", "\"gradients\":false", ALP_ERROR_INVALID_DATA, "texels"},
    {"\"file\":\"", "\"file\":\"../", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"file\":\"", "\"file\":\"/etc/", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"file\":\"", "\"file\":\"a\\\\", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"file\":\"p.probes.ktx2\"", "\"file\":\"..\"", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"file\":\"p.probes.ktx2\"", "\"file\":\"\"", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"file\"", "\"fill\"", ALP_ERROR_INVALID_DATA, "plain name"},
    {"\"fnv1a64\":\"", "\"fnv1a64\":\"0", ALP_ERROR_INVALID_DATA, "\"fnv1a64\""},
    {"\"fnv1a64\"", "\"md5\"", ALP_ERROR_INVALID_DATA, "\"fnv1a64\""},
    {"\"bytes\":", "\"bytes\":1", ALP_ERROR_INVALID_DATA, "its JSON states 1"},
    {"\"reach\":4", "\"reach\":-4", ALP_ERROR_INVALID_DATA, "\"reach\""},
    {"\"reach\":4", "\"far\":4", ALP_ERROR_INVALID_DATA, "\"reach\""},
    {"\"rays\":512,", "\"rays\":-1,", ALP_ERROR_INVALID_DATA, "\"rays\""},
    {"\"seed\":\"1", "\"seed\":\"x1", ALP_ERROR_INVALID_DATA, "\"seed\""},
    {"\"hash\":\"fe", "\"hash\":\"zz", ALP_ERROR_INVALID_DATA, "\"hash\""},
    {"\"options\":{", "\"options\":[],\"o\":{", ALP_ERROR_INVALID_DATA, "\"options\""},
    {"\"relative\":0", "\"relative\":-0", ALP_ERROR_INVALID_DATA, "\"relative\""},
    {"{\"format\"", "[{\"format\"", ALP_ERROR_INVALID_DATA, "JSON, line"},
    {"\"count\":8", "\"count\":8,\"count\":8", ALP_ERROR_INVALID_DATA, "JSON, line"},
};

/// @return malloc'ed
static char *changed(const good_files *f, const change *c)
{
    const char *text = (const char *)f->json, *at = strstr(text, c->from);
    char *result = malloc(f->json_size + strlen(c->to) + 1);
    assert_non_null(result);
    if (at == NULL) {
        fail_msg("%s is not in the file: %s", c->from, text);
    } else {
        sprintf(result, "%.*s%s%s", (int)(at - text), text, c->to, at + strlen(c->from));
    }
    return result;
}

TEST(changed_texts_are_refused)
{
    good_files f = make_files(false);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        alpi_probe_volume v;
        char *text = changed(&f, &changes[i]);
        expect(decode(&f, text, strlen(text), false, &v), changes[i].code, changes[i].word);
        assert_null(v.context);
        free(text);
    }
    free_files(&f);
}

TEST(changed_lists_are_refused)
{
    static const change lists[] = {
        {"[0,0.1", "[\"0\",0.1", ALP_ERROR_INVALID_DATA, "\"positions\""},
        {"[0,0.1,0.2]", "[0,0.1]", ALP_ERROR_INVALID_DATA, "\"positions\""},
        {"[0,0.1,0.2]", "[0,0.1,1e200]", ALP_ERROR_INVALID_DATA, "\"positions\""},
        {"[0,0.1,0.2],", "", ALP_ERROR_INVALID_DATA, "\"count\""},
        {"\"positions\"", "\"places\"", ALP_ERROR_INVALID_DATA, "\"positions\""},
    };
    good_files f = make_files(true);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        alpi_probe_volume v;
        char *text = changed(&f, &lists[i]);
        expect(decode(&f, text, strlen(text), false, &v), lists[i].code, lists[i].word);
        free(text);
    }
    free_files(&f);
}

/// Members of later versions do not hinder readers of this one.
TEST(unknown_members_are_ignored)
{
    static const change added = {"\"count\":8", "\"count\":8,\"later\":{\"a\":[1]}", 0, ""};
    good_files f = make_files(false);
    alpi_probe_volume v;
    char *text = changed(&f, &added);
    ASSERT_OK(context, decode(&f, text, strlen(text), false, &v));
    alpi_probe_volume_destroy(&v);
    free(text);
    free_files(&f);
}

/// Names reach terminals.
TEST(control_characters_leave_names)
{
    static const change added = {"lamp ", "lamp\\u001b\\n ", 0, ""};
    good_files f = make_files(false);
    alpi_probe_volume v;
    char *text = changed(&f, &added);
    ASSERT_OK(context, decode(&f, text, strlen(text), false, &v));
    assert_memory_equal(v.layers[0].name, "lamp?? ", 7);
    alpi_probe_volume_destroy(&v);
    free(text);
    free_files(&f);
}

// --- bytes ---------------------------------------------------------------------------------------

TEST(every_cut_is_noticed)
{
    good_files f = make_files(false);
    for (size_t size = 0; size + 2 < f.json_size; size += 1 + size / 64) {
        alpi_probe_volume v;
        expect(decode(&f, (const char *)f.json, size, false, &v), ALP_ERROR_INVALID_DATA,
               "p.probes.json: JSON");
    }
    for (int which = 0; which < 2; which++) {
        size_t *size = which == 0 ? &f.coefficients_size : &f.moments_size;
        const size_t whole = *size;
        for (size_t cut = 0; cut < whole; cut++) {
            alpi_probe_volume v;
            *size = cut;
            expect(decode(&f, (const char *)f.json, f.json_size, false, &v), ALP_ERROR_INVALID_DATA,
                   "copy all files");
            expect(decode(&f, (const char *)f.json, f.json_size, true, &v), ALP_ERROR_INVALID_DATA,
                   "KTX2");
        }
        *size = whole;
    }
    free_files(&f);
}

/// Every byte of the textures, turned over: the checksum differs. Without it nothing may break.
TEST(every_flipped_byte_is_noticed)
{
    good_files f = make_files(false);
    for (int which = 0; which < 2; which++) {
        unsigned char *bytes = which == 0 ? f.coefficients : f.moments;
        const size_t size = which == 0 ? f.coefficients_size : f.moments_size;
        for (size_t i = 0; i < size; i++) {
            alpi_probe_volume v;
            bytes[i] ^= 0xff;
            expect(decode(&f, (const char *)f.json, f.json_size, false, &v), ALP_ERROR_INVALID_DATA,
                   "checksum");
            if (decode(&f, (const char *)f.json, f.json_size, true, &v) == ALP_OK) {
                alpi_probe_volume_destroy(&v);
            }
            assert_null(v.context);
            bytes[i] ^= 0xff;
        }
    }
    free_files(&f);
}

// --- texels --------------------------------------------------------------------------------------

/// Decodes with one half of the coefficients (or moments) replaced.
static void expect_half(good_files *f, bool moment, size_t index, uint16_t half, const char *word)
{
    unsigned char **bytes = moment ? &f->moments : &f->coefficients;
    size_t *size = moment ? &f->moments_size : &f->coefficients_size;
    alpi_half_texture t;
    alpi_probe_volume v;
    uint8_t *written = NULL;
    size_t written_size = 0;
    ASSERT_OK(context, alpi_ktx2_read(context, "t", *bytes, *size, &t));
    t.texels[2 * index] = (uint8_t)half;
    t.texels[2 * index + 1] = (uint8_t)(half >> 8);
    ASSERT_OK(context, alpi_ktx2_write(context, &t, index % 2 == 0, &written, &written_size));
    unsigned char *kept = *bytes;
    const size_t kept_size = *size;
    *bytes = written;
    *size = written_size;
    expect(decode(f, (const char *)f->json, f->json_size, true, &v), ALP_ERROR_INVALID_DATA, word);
    *bytes = kept;
    *size = kept_size;
    alpi_release(context, written);
    alpi_release(context, t.texels);
}

TEST(texels_that_are_no_numbers_are_refused)
{
    enum { INFINITE = 0x7c00, NOT_A_NUMBER = 0x7e01, MINUS_ONE = 0xbc00, HALF = 0x3800 };
    enum { SLAB = 4 * 8, STATES = 7 * SLAB };
    good_files f = make_files(false);
    expect_half(&f, false, 4 * 5, INFINITE, "probe 5: value 0 of slab 0");
    expect_half(&f, false, 4 * 3 + 1, NOT_A_NUMBER, "probe 3: value 1 of slab 0");
    expect_half(&f, false, 8 * SLAB, NOT_A_NUMBER, "probe 0: value 0 of slab 8");
    expect_half(&f, false, STATES + 3, MINUS_ONE, "probe 0: state -1");
    expect_half(&f, false, STATES + 3, HALF, "probe 0: state 0.5");
    expect_half(&f, false, STATES + 3, NOT_A_NUMBER, "probe 0: state nan");
    expect_half(&f, false, STATES + 4, INFINITE, "probe 1: its move");
    expect_half(&f, true, 16, NOT_A_NUMBER, "probe 1: moment 0");
    expect_half(&f, true, 1, MINUS_ONE, "probe 0: moment 0");
    free_files(&f);
}

/// Whole files of another bake.
TEST(textures_that_are_swapped_are_refused)
{
    good_files f = make_files(false);
    alpi_probe_volume v;
    const alpi_probe_bytes bytes = {"p.probes.json",     f.json,      f.moments,
                                    f.coefficients,      f.json_size, f.moments_size,
                                    f.coefficients_size, true};
    expect(alpi_probes_decode(context, &bytes, &v), ALP_ERROR_INVALID_DATA, "channels");
    free_files(&f);
}

// --- the disk and memory -------------------------------------------------------------------------

TEST(missing_files_are_named)
{
    const char *folder = test_folder();
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {2, 2, 2}});
    ASSERT_OK(context, alpi_probes_save(&v, test_path(folder, "a.json"), true));
    alpi_probe_volume_destroy(&v);
    assert_int_equal(remove(test_path(folder, "a.ktx2")), 0);
    expect(alpi_probes_load(context, test_path(folder, "a.json"), &v), ALP_ERROR_IO, "a.ktx2");
    expect(alpi_probes_load(context, test_path(folder, "b.json"), &v), ALP_ERROR_IO, "b.json");
}

/// Saves and loads without one allocation. @return the allocations that there were
static long run_without(const char *path, long failing, alp_result *result)
{
    test_memory memory = {.failing = failing};
    alp_context *own = test_memory_context(&memory, 1);
    alpi_probe_volume v = test_volume(
        context,
        (test_volume_options){.size = {2, 2, 2}, .layers = 1, .gradients = true, .moments = true});
    alpi_probe_volume again;
    v.context = own;
    *result = alpi_probes_save(&v, path, true);
    v.context = context;
    alpi_probe_volume_destroy(&v);
    if (*result == ALP_OK) {
        *result = alpi_probes_load(own, path, &again);
    }
    if (*result == ALP_OK) {
        alpi_probe_volume_destroy(&again);
    } else {
        assert_int_equal(*result, ALP_ERROR_OUT_OF_MEMORY);
    }
    alp_context_destroy(own);
    assert_int_equal(atomic_load(&memory.live), 0);
    return atomic_load(&memory.count);
}

TEST(every_allocation_may_fail)
{
    const char *path = test_path(test_folder(), "memory.probes.json");
    alp_result result;
    const long total = run_without(path, -1, &result);
    assert_int_equal(result, ALP_OK);
    for (long i = 1; i < total; i++) { // the context is the first
        (void)run_without(path, i, &result);
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
    }
    print_message("%ld allocations failed in turn\n", total);
    assert_in_range(total, 30, 500);
}

/// A budget below the size of the arrays.
TEST(budgets_are_kept)
{
    const char *path = test_path(test_folder(), "budget.probes.json");
    alpi_probe_volume v = test_volume(context, (test_volume_options){.size = {20, 20, 20}}), again;
    ASSERT_OK(context, alpi_probes_save(&v, path, true));
    alpi_probe_volume_destroy(&v);
    const alpi_budget before =
        alpi_set_budget(context, (alpi_budget){.limit = alpi_memory_held(context) + (1 << 20)});
    assert_int_equal(alpi_probes_load(context, path, &again), ALP_ERROR_OUT_OF_MEMORY);
    assert_null(again.context);
    (void)alpi_set_budget(context, before);
    ASSERT_OK(context, alpi_probes_load(context, path, &again));
    alpi_probe_volume_destroy(&again);
}
