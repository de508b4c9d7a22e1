// SPDX-License-Identifier: MIT
#include "test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char log_text[1 << 16];

bool test_is_quick(void)
{
#ifdef TEST_SANITIZED
    return true;
#else
    return getenv("TEST_FAST") != NULL;
#endif
}

void test_assert_near(double actual, double expected, double tolerance, const char *text,
                      const char *file, int line)
{
    if (!(fabs(actual - expected) <= tolerance)) {
        print_error("%s = %.9g, expected %.9g +- %.3g (off by %.3g)\n", text, actual, expected,
                    tolerance, actual - expected);
        _fail(file, line);
    }
}

void test_assert_ok(alp_context *context, alp_result result, const char *text, const char *file,
                    int line)
{
    if (result != ALP_OK) {
        print_error("%s gave %s: %s\n", text, alp_result_name(result),
                    alp_context_message(context));
        _fail(file, line);
    }
}

static void collect(void *user, const alp_log_message *message)
{
    (void)user;
    size_t used = strlen(log_text);
    snprintf(log_text + used, sizeof log_text - used, "%s %s: %s\n", message->code, message->object,
             message->text);
}

alp_context *test_context(uint32_t workers)
{
    alp_context_options options = alp_context_options_default();
    options.worker_count = workers;
    options.log = collect;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    return context;
}

alp_scene *test_load(alp_context *context, const char *name)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, name, &scene));
    return scene;
}

alp_bake_options test_light_options(uint32_t size)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = size;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.maps = ALP_MAP_LIGHT;
    options.light.samples = 65536;
    return options;
}

static long blocks_not_released;

static void *allocate_while_any_left(void *user, size_t size)
{
    int *left = user;
    void *pointer = (*left)-- > 0 ? malloc(size) : NULL;
    blocks_not_released += pointer != NULL;
    return pointer;
}

static void release_any(void *user, void *pointer)
{
    (void)user;
    blocks_not_released -= pointer != NULL;
    free(pointer);
}

/// At exit. A sanitizer of addresses fails of itself then, and tells whose they were.
static void ask_for_blocks_back(void)
{
    if (blocks_not_released != 0) {
        fprintf(stderr, "%ld blocks of failing contexts were not released\n", blocks_not_released);
        fflush(NULL);
#ifndef TEST_SANITIZED
        _exit(1);
#endif
    }
}

alp_context *test_context_failing(int *left)
{
    static bool asked;
    if (!asked) {
        asked = true;
        assert_int_equal(atexit(ask_for_blocks_back), 0);
    }
    *left = 1 << 30;
    alp_context_options options = alp_context_options_default();
    options.allocate = allocate_while_any_left;
    options.release = release_any;
    options.allocator_user = left;
    options.worker_count = 1;
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    return context;
}

void test_log_clear(void)
{
    log_text[0] = '\0';
}

int test_log_has(const char *code)
{
    size_t length = strlen(code);
    for (const char *line = log_text; *line;) {
        if (strncmp(line, code, length) == 0 && line[length] == ' ') {
            return 1;
        }
        const char *next = strchr(line, '\n');
        line = next ? next + 1 : line + strlen(line);
    }
    return 0;
}

const char *test_log_text(void)
{
    return log_text;
}

void *test_any_workers(test_make *make, const void *what, size_t size)
{
    static const uint32_t all[] = {1, 2, 7, 32}, few[] = {1, 7};
    const uint32_t *workers = test_is_quick() ? few : all;
    const size_t ways = test_is_quick() ? 2 : 4;
    char *first = calloc(2, size), *other = first + size;
    assert_non_null(first);
    make(workers[0], what, first);
    for (size_t w = 1; w < ways; w++) {
        memset(other, 0, size);
        make(workers[w], what, other);
        if (memcmp(first, other, size) != 0) {
            fail_msg("%u workers make other bytes than one", workers[w]);
        }
    }
    return first;
}

static char folder_path[256];

static void remove_folder(void)
{
    char command[320];
    snprintf(command, sizeof command, "rm -rf '%s'", folder_path);
    if (system(command) != 0) {
        fprintf(stderr, "could not remove %s\n", folder_path);
    }
}

const char *test_folder(void)
{
    static char path[300];
    static int counter;
    if (folder_path[0] == '\0') {
        const char *base = getenv("TMPDIR");
        snprintf(folder_path, sizeof folder_path, "%s/alpenglow-test-XXXXXX", base ? base : "/tmp");
        if (mkdtemp(folder_path) == NULL) {
            fail_msg("cannot make a folder in %s", folder_path);
        }
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/%d", folder_path, counter++);
    assert_int_equal(mkdir(path, 0777), 0);
    return path;
}

const char *test_path(const char *folder, const char *name)
{
    static char buffers[8][1024];
    static int next;
    char *buffer = buffers[next++ % 8];
    snprintf(buffer, sizeof buffers[0], "%s/%s", folder, name);
    return buffer;
}

const char *test_shared(const char *relative)
{
    const char *base = getenv("ALPENGLOW_SHARED");
    if (base == NULL || base[0] == '\0') {
        base = ALP_SOURCE_FOLDER "/../shared";
    }
    if (access(base, R_OK) != 0) {
        print_message("%s is absent: skipped (set ALPENGLOW_SHARED)\n", base);
        return NULL;
    }
    return test_path(base, relative);
}

unsigned char *test_read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fail_msg("cannot open %s", path);
        return NULL;
    }
    fseek(file, 0, SEEK_END);
    long length = ftell(file);
    rewind(file);
    unsigned char *bytes = malloc((size_t)length + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)length, file), length);
    bytes[length] = 0;
    fclose(file);
    *size = (size_t)length;
    return bytes;
}
