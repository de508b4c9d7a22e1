// SPDX-License-Identifier: MIT
// What must hold of every input, whatever it is.
#include "fuzz.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_read.h"

#include <jansson.h>
#include <libxml/parser.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void fuzz_print(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("fuzz: ", stderr);
    // Just started. NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

// --- memory --------------------------------------------------------------------------------------

#define MOST_MORE ((uint64_t)64 << 20)
enum { MOST_TIMES = 4 };

static uint64_t bytes_now, bytes_peak;

static void count_more(size_t size)
{
    bytes_now += size;
    bytes_peak = bytes_now > bytes_peak ? bytes_now : bytes_peak;
}

static void count_less(size_t size)
{
    bytes_now -= size < bytes_now ? size : bytes_now; // made before we counted
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_HOOKS
#endif
#endif

#ifdef HAS_HOOKS // everything counts, the other libraries' too

#include <sanitizer/allocator_interface.h>

static void on_malloc(const volatile void *pointer, size_t size)
{
    (void)pointer;
    count_more(size);
}

static void on_free(const volatile void *pointer)
{
    const void *plain;
    memcpy(&plain, &pointer, sizeof plain); // without "volatile", which it does not take
    count_less(plain != NULL ? __sanitizer_get_allocated_size(plain) : 0);
}

static void start_counting(void)
{
    if (__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) == 0) {
        fuzz_abort("no place for the hooks that count memory");
    }
}

static void *allocate(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void release(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

#else // our own allocations

enum { HEAD = 16 }; // keeps the alignment

static void start_counting(void)
{
}

static void *allocate(void *user, size_t size)
{
    (void)user;
    char *block = malloc(size + HEAD);
    if (block == NULL) {
        return NULL;
    }
    memcpy(block, &size, sizeof size);
    count_more(size);
    return block + HEAD;
}

static void release(void *user, void *pointer)
{
    (void)user;
    size_t size;
    char *block = (char *)pointer - HEAD;
    memcpy(&size, block, sizeof size);
    count_less(size);
    free(block);
}

#endif

// --- a run ---------------------------------------------------------------------------------------

fuzz_run fuzz_begin(size_t size)
{
    static bool started;
    if (!started) { // what libraries make once is no leak and no memory of the first input
        started = true;
        json_object_seed(1); // else the order of its tables is another in every process
        xmlInitParser();
        start_counting();
    }
    fuzz_run run = {.decoded = size, .before = bytes_now};
    bytes_peak = bytes_now;
    alp_context_options options = alp_context_options_default();
    options.allocate = allocate;
    options.release = release;
    options.worker_count = 1;
    if (alp_context_create(&options, &run.context) != ALP_OK) {
        fuzz_abort("no context");
    }
    return run;
}

void fuzz_decoded(fuzz_run *run, uint64_t bytes)
{
    run->decoded += bytes;
}

uint64_t fuzz_texture_promise(const uint8_t *bytes, size_t size)
{
    const uint64_t most = ((uint64_t)size / 4 + 1) << 17; // blocks of Zstandard
    uint64_t promise = 0;
    if (size >= 104) {
        memcpy(&promise, bytes + 96, sizeof promise);
    }
    return promise < most ? promise : most;
}

void fuzz_peak(fuzz_run *run)
{
    run->checked = true;
    const uint64_t peak = bytes_peak - run->before;
    const uint64_t most = MOST_TIMES * run->decoded + MOST_MORE;
    if (peak > most) {
        fuzz_abort("%llu bytes at the highest; %llu were decoded, which allows %llu (%s)",
                   (unsigned long long)peak, (unsigned long long)run->decoded,
                   (unsigned long long)most, alp_context_message(run->context));
    }
}

void fuzz_end(fuzz_run *run)
{
    if (!run->checked) {
        fuzz_peak(run);
    }
    alp_context_destroy(run->context);
}

uint8_t *fuzz_copy(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size > 0 ? size : 1);
    if (copy == NULL) {
        fuzz_abort("no memory for a copy");
    }
    if (size > 0) {
        memcpy(copy, data, size);
    }
    return copy;
}

uint8_t *fuzz_owned(const fuzz_run *run, const uint8_t *data, size_t size, size_t zeros)
{
    uint8_t *copy = alpi_allocate(run->context, size + zeros, 1);
    if (copy == NULL) {
        fuzz_abort("no memory for a copy");
    }
    if (size > 0) {
        memcpy(copy, data, size);
    }
    return copy;
}

// --- what came of it -----------------------------------------------------------------------------

void fuzz_result(const fuzz_run *run, alp_result result, const void *object)
{
    if (getenv("FUZZ_TELL") != NULL) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(run->context));
    }
    if ((result == ALP_OK) != (object != NULL)) {
        fuzz_abort("%s with%s an object", alp_result_name(result), object != NULL ? "" : "out");
    }
    if (result != ALP_OK && alp_context_message(run->context)[0] == '\0') {
        fuzz_abort("%s without a message", alp_result_name(result));
    }
    if (result == ALP_ERROR_INVALID_ARGUMENT || strcmp(alp_result_name(result), "UNKNOWN") == 0) {
        fuzz_abort("%s is no answer to bad bytes: %s", alp_result_name(result),
                   alp_context_message(run->context));
    }
}

static uint64_t image_size(const alp_image *image)
{
    const alp_image_info info = alp_image_get_info(image);
    return (uint64_t)info.width * info.height * info.channels *
           (info.component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1);
}

static void check_numbers(const float *values, size_t count, const char *what)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            fuzz_abort("%s: number %zu is not finite", what, i);
        }
    }
}

static void check_indices(const alp_scene *scene)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_surface[t] >= scene->surface_count) {
            fuzz_abort("triangle %u is of surface %u", t, scene->triangle_surface[t]);
        }
        for (int k = 0; k < 3; k++) {
            if (scene->triangles[t][k] >= scene->vertex_count) {
                fuzz_abort("triangle %u has vertex %u", t, scene->triangles[t][k]);
            }
        }
    }
}

void fuzz_scene(fuzz_run *run, alp_result result, const alp_scene *scene)
{
    fuzz_result(run, result, scene);
    if (scene == NULL) {
        return;
    }
    check_indices(scene);
    if (scene->vertex_count > 0) {
        check_numbers(scene->positions[0], (size_t)3 * scene->vertex_count, "positions");
        check_numbers(scene->normals[0], (size_t)3 * scene->vertex_count, "normals");
    }
    uint64_t vertex = sizeof *scene->positions + sizeof *scene->normals +
                      (scene->colors != NULL ? sizeof *scene->colors : 0) +
                      sizeof *scene->vertex_source;
    for (int set = 0; set < ALPI_UV_SET_LIMIT; set++) {
        vertex += scene->uvs[set] != NULL ? sizeof *scene->uvs[set] : 0;
    }
    const uint64_t triangle =
        sizeof *scene->triangles + sizeof *scene->triangle_surface + sizeof *scene->triangle_usable;
    fuzz_decoded(run, vertex * scene->vertex_count + triangle * scene->triangle_count);
    for (uint32_t i = 0; i < scene->image_count; i++) {
        fuzz_decoded(run, image_size(scene->images[i]));
    }
}

void fuzz_image(fuzz_run *run, alp_result result, alp_image *image)
{
    fuzz_result(run, result, image);
    fuzz_decoded(run, image_size(image));
    alp_image_destroy(image);
}

// --- files ---------------------------------------------------------------------------------------

static char folder_path[256];

static void remove_folder(void)
{
    char command[320];
    snprintf(command, sizeof command, "rm -rf '%s'", folder_path);
    if (system(command) != 0) {
        fprintf(stderr, "fuzz: could not remove %s\n", folder_path);
    }
}

const char *fuzz_folder(void)
{
    if (folder_path[0] == '\0') {
        const char *base = getenv("TMPDIR"); // scripts/fuzz.sh names one in memory
        base = base != NULL ? base : "/tmp";
        snprintf(folder_path, sizeof folder_path, "%s/alpenglow-fuzz-XXXXXX", base);
        if (mkdtemp(folder_path) == NULL) {
            fuzz_abort("cannot make a folder in %s", base);
        }
        atexit(remove_folder);
    }
    return folder_path;
}

alp_scene *fuzz_gltf_scene(fuzz_run *run, const char *path, uint8_t *bytes, size_t size)
{
    alpi_gltf_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result = alpi_gltf_document_parse(run->context, path, bytes, size, &document);
    fuzz_result(run, result, document);
    if (document != NULL) {
        fuzz_decoded(run, document->decoded_size);
        result = alpi_gltf_scene_from_document(document, &scene);
        fuzz_scene(run, result, scene);
        fuzz_peak(run);
    }
    return scene;
}

void fuzz_write_back(fuzz_run *run, const alp_scene *scene, const char *name)
{
    alp_context *context = run->context;
    float(*uvs)[3][2] = alpi_allocate(context, scene->triangle_count, sizeof *uvs);
    uint32_t *pages = alpi_allocate(context, scene->triangle_count, sizeof *pages);
    if (uvs == NULL || pages == NULL) {
        fuzz_abort("no memory for a map");
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        pages[t] = t / 5 % 2;
        uvs[t][1][0] = uvs[t][2][1] = (float)(t % 3) / 3.0f;
    }
    const uint8_t *const pngs[] = {(const uint8_t *)"x", (const uint8_t *)"y"};
    const size_t sizes[] = {1, 1};
    const alpi_mesh_patch patch = {.page_count = 2,
                                   .corner_uvs = (const float(*)[3][2])uvs,
                                   .triangle_pages = pages,
                                   .page_pngs = pngs,
                                   .page_png_sizes = sizes,
                                   .occlusion_strength = 1.0f};
    char path[320];
    snprintf(path, sizeof path, "%s/%s", fuzz_folder(), name);
    alp_scene *again = NULL;
    alp_result result = alpi_scene_write_patched(scene, &patch, path, true);
    if (result == ALP_OK) {
        result = alp_scene_load(context, path, &again);
        if (result != ALP_OK) {
            fuzz_abort("what was written cannot be read: %s", alp_context_message(context));
        }
        const bool may_lose = alpi_path_has_ending(name, ".obj"); // triangles without area
        if (may_lose ? again->triangle_count > scene->triangle_count
                     : again->triangle_count != scene->triangle_count) {
            fuzz_abort("%u triangles were written, %u read", scene->triangle_count,
                       again->triangle_count);
        }
    } else {
        fuzz_result(run, result, NULL);
    }
    alp_scene_destroy(again);
    alpi_release(context, uvs);
    alpi_release(context, pages);
}
