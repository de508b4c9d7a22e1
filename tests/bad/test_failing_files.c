// SPDX-License-Identifier: MIT
// Each call that makes, writes, flushes, closes or renames a file fails once in a small bake, for
// each kind of file: the bake says which file and why, no file is lost, none is half there. The
// linker puts the functions below between our code and the system (--wrap).
#include "test_small_bake.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

typedef enum fault_kind { FAULTS_WRITING, FAULTS_READING, FAULTS_SHRINKING } fault_kind;

static struct {
    fault_kind kind; // of calls that are counted
    long count, failing;
    const char *failed; // what has failed
    int error;
} faults = {.failing = -1};

static bool fails(fault_kind kind, const char *call, int error)
{
    if (kind != faults.kind || faults.count++ != faults.failing) {
        return false;
    }
    faults.failed = call;
    faults.error = errno = error;
    return true;
}

// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c): the linker has these names
int __real_open(const char *path, int flags, ...);
ssize_t __real_read(int descriptor, void *bytes, size_t size);
ssize_t __real_write(int descriptor, const void *bytes, size_t size);
int __real_fsync(int descriptor);
int __real_close(int descriptor);
int __real_rename(const char *from, const char *to);
int __real_link(const char *from, const char *to);
int __real_fstat(int descriptor, struct stat *status);
int __wrap_open(const char *path, int flags, ...);
ssize_t __wrap_read(int descriptor, void *bytes, size_t size);
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size);
int __wrap_fsync(int descriptor);
int __wrap_close(int descriptor);
int __wrap_rename(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);
int __wrap_fstat(int descriptor, struct stat *status);

int __wrap_open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    const bool reads = (flags & O_CREAT) == 0;
    return fails(reads ? FAULTS_READING : FAULTS_WRITING, "open", EMFILE)
               ? -1
               : __real_open(path, flags, mode);
}

ssize_t __wrap_read(int descriptor, void *bytes, size_t size)
{
    if (fails(FAULTS_SHRINKING, "read", 0)) {
        return 0; // the end, before where it was said to be
    }
    return fails(FAULTS_READING, "read", EIO) ? -1 : __real_read(descriptor, bytes, size);
}

/// A disk gets full in the middle.
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size)
{
    if (fails(FAULTS_WRITING, "write", ENOSPC)) {
        (void)!__real_write(descriptor, bytes, size / 2);
        errno = ENOSPC;
        return -1;
    }
    return __real_write(descriptor, bytes, size);
}

int __wrap_fsync(int descriptor)
{
    return fails(FAULTS_WRITING, "fsync", EIO) ? -1 : __real_fsync(descriptor);
}

/// Also after a failure the descriptor is gone.
int __wrap_close(int descriptor)
{
    const bool writes = (fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
    const int code = __real_close(descriptor);
    return writes && fails(FAULTS_WRITING, "close", EDQUOT) ? -1 : code;
}

int __wrap_rename(const char *from, const char *to)
{
    return fails(FAULTS_WRITING, "rename", EBUSY) ? -1 : __real_rename(from, to);
}

int __wrap_link(const char *from, const char *to)
{
    return fails(FAULTS_WRITING, "link", EPERM) ? -1 : __real_link(from, to);
}

int __wrap_fstat(int descriptor, struct stat *status)
{
    return fails(FAULTS_READING, "fstat", EOVERFLOW) ? -1 : __real_fstat(descriptor, status);
}

// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c)

// --- the tests -----------------------------------------------------------------------------------

static void arm(fault_kind kind, long failing)
{
    faults.kind = kind;
    faults.count = 0;
    faults.failing = failing;
    faults.failed = NULL;
}

static uint32_t count_descriptors(void)
{
    DIR *stream = opendir("/proc/self/fd");
    uint32_t count = 0;
    for (; stream != NULL && readdir(stream) != NULL; count++) {
    }
    if (stream != NULL) {
        closedir(stream);
    }
    return count;
}

static long count_calls(const test_small_bake *bake, fault_kind kind)
{
    alp_context *context = test_context(1);
    arm(kind, -1);
    ASSERT_OK(context, test_small_bake_run(bake, context));
    alp_context_destroy(context);
    return faults.count;
}

/// The message has the reason, and a file of the test.
static void check_message(const alp_context *context)
{
    const char *text = alp_context_message(context);
    if (strstr(text, strerror(faults.error)) == NULL || strchr(text, '/') == NULL) {
        fail_msg("%s failed, and the message is \"%s\"", faults.failed, text);
    }
}

static void fail_write(const test_small_bake *bake, long failing, bool has_old)
{
    alp_context *context = test_context(1);
    const uint32_t descriptors = count_descriptors();
    arm(FAULTS_WRITING, failing);
    const alp_result result = test_small_bake_run(bake, context);
    const test_small_bake_state state = test_small_bake_look(bake);
    assert_non_null(faults.failed);
    assert_int_equal(count_descriptors(), descriptors);
    assert_int_equal(state.others, 0);
    if (result == ALP_OK) { // a former file without a second name could only not be taken back
        assert_string_equal(faults.failed, "link");
        assert_int_equal(state.new, bake->file_count);
    } else {
        assert_int_equal(result, ALP_ERROR_IO);
        check_message(context);
        assert_int_equal(has_old ? state.old : state.missing, bake->file_count);
        assert_true(has_old || access(bake->maps, F_OK) != 0);
    }
    alp_context_destroy(context);
}

TEST(failing_writes)
{
    for (int kind = 0; kind < TEST_SMALL_BAKE_KINDS; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        for (int has_old = 0; has_old < 2; has_old++) {
            test_small_bake_clear(&bake);
            long calls = 0;
            const int step = has_old ? TEST_STEP : 1; // most are calls for new files too
            for (long i = 0; i == 0 || i < calls; i += step) {
                void (*const prepare)(const test_small_bake *) =
                    has_old ? test_small_bake_reset : test_small_bake_clear;
                prepare(&bake);
                calls = i == 0 ? count_calls(&bake, FAULTS_WRITING) : calls;
                prepare(&bake);
                fail_write(&bake, i, has_old != 0);
            }
            print_message("%s: %ld calls that write %s, one in %d failed\n", bake.kind, calls,
                          has_old ? "over files" : "new files", step);
            assert_in_range(calls, 5 * bake.file_count, 8 * bake.file_count);
        }
        test_small_bake_close(&bake);
    }
}

/// A picture or a library of materials that cannot be read costs a warning; what lies at the place
/// of a copy and cannot be compared with it is written; everything else costs the bake.
TEST(failing_reads)
{
    for (int kind = 0; kind < 3; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        const long calls = count_calls(&bake, FAULTS_READING);
        long told = 0;
        for (long i = 0; i < calls; i++) {
            test_small_bake_reset(&bake);
            test_log_clear();
            alp_context *context = test_context(1);
            arm(FAULTS_READING, i);
            const alp_result result = test_small_bake_run(&bake, context);
            const test_small_bake_state state = test_small_bake_look(&bake);
            const bool is_told =
                test_log_has("image") || test_log_has("mtllib") || test_log_has("missing-file");
            if (result == ALP_ERROR_INVALID_ARGUMENT) { // nothing emits without the materials
                assert_true(is_told && strstr(alp_context_message(context), "--sky") != NULL);
                assert_int_equal(state.old, bake.file_count);
            } else if (result == ALP_OK) {
                assert_true(is_told || state.new == bake.file_count);
                told += is_told;
            } else {
                assert_int_equal(result, ALP_ERROR_IO);
                check_message(context);
                assert_int_equal(state.old, bake.file_count);
            }
            assert_int_equal(state.others, 0);
            alp_context_destroy(context);
        }
        print_message("%s: %ld calls that read failed in turn, %ld cost a warning\n", bake.kind,
                      calls, told);
        assert_in_range(calls, 6, 100);
        test_small_bake_close(&bake);
    }
}

/// A file that is cut off between the question how long it is and the reading.
TEST(shrinking_files)
{
    for (int kind = 0; kind < 3; kind++) {
        test_small_bake bake = test_small_bake_open(kind);
        for (long i = 0; i < 3; i++) { // the scene first
            test_log_clear();
            alp_context *context = test_context(1);
            alp_scene *scene = NULL;
            arm(FAULTS_SHRINKING, i);
            const alp_result result = alp_scene_load(context, bake.scene, &scene);
            const char *text = result == ALP_OK ? test_log_text() : alp_context_message(context);
            assert_true(faults.failed == NULL || strstr(text, "became shorter") != NULL);
            assert_true(i > 0 || result == ALP_ERROR_IO);
            assert_int_equal(result == ALP_OK, scene != NULL);
            arm(FAULTS_WRITING, -1);
            alp_scene_destroy(scene);
            alp_context_destroy(context);
        }
        test_small_bake_close(&bake);
    }
}

/// A folder where nothing may be made is told before the work. Root may make files anywhere.
TEST(unwritable_folder)
{
    if (geteuid() == 0) {
        print_message("permissions do not bind root: skipped\n");
        skip();
    }
    test_small_bake bake = test_small_bake_open(0);
    arm(FAULTS_WRITING, -1);
    alp_context *context = test_context(1);
    assert_int_equal(chmod(bake.maps, 0555), 0);
    assert_int_equal(test_small_bake_run(&bake, context), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "its folder cannot be written"));
    assert_int_equal(faults.count, 0);
    assert_int_equal(test_small_bake_look(&bake).old, bake.file_count);
    assert_int_equal(chmod(bake.maps, 0755), 0);
    alp_context_destroy(context);
    test_small_bake_close(&bake);
}

/// One picture, and the page of a report: alone, so a former file is simply replaced or not.
TEST_WITH_CONTEXT(single_files, 1)
{
    static const char *const names[] = {"a.png", "a.exr", "a.hdr", "a.html"};
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 16;
    options.occlusion.samples = 4;
    alp_scene *scene = NULL;
    alp_lightmap *lightmap = NULL;
    alp_bake_report made;
    alp_image *images[2];
    ASSERT_OK(context, alp_scene_load(context, "builtin:sphere-plane", &scene));
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &made));
    for (int i = 0; i < 2; i++) {
        const alp_image_info info = {16, 16, 3, i == 0 ? ALP_COMPONENT_U8 : ALP_COMPONENT_FLOAT};
        ASSERT_OK(context, alp_image_create(context, info, &images[i]));
    }
    alp_report_options report = alp_report_options_default();
    report.overwrite = true;
    for (int i = 0; i < 4; i++) {
        const char *path = test_path(test_folder(), names[i]);
        alp_result result = ALP_ERROR_IO;
        for (long n = 0; result != ALP_OK; n++) {
            struct stat before, after;
            assert_in_range(n, 0, 40);
            FILE *file = fopen(path, "w");
            assert_non_null(file);
            fputs("precious", file);
            fclose(file);
            assert_int_equal(stat(path, &before), 0);
            arm(FAULTS_WRITING, n);
            result = i < 3 ? alp_image_save(images[i > 0], path, true)
                           : alp_bake_write_report(scene, lightmap, &made, &report, path);
            if (result != ALP_OK) {
                assert_int_equal(result, ALP_ERROR_IO);
                check_message(context);
                assert_int_equal(stat(path, &after), 0);
                assert_true(before.st_ino == after.st_ino && after.st_size == 8);
            }
        }
    }
    arm(FAULTS_WRITING, -1);
    for (int i = 0; i < 2; i++) {
        alp_image_destroy(images[i]);
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}
