// SPDX-License-Identifier: MIT
// How fast scenes are read: OBJ and COLLADA that the bench writes itself, and how long a file takes
// until rays can be traced.
#include "bench.h"

#include "base/decimal.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "formats/collada/collada_read.h"
#include "formats/formats.h"
#include "formats/obj/obj.h"
#include "formats/text/text_edits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROUNDS = 5 };

/// A field of side × side quads with normals and coordinates; quads as faces or as two triangles.
static void print_field(alpi_bytes *text, int side, bool triangles, int digits)
{
    for (int i = 0; i <= side; i++) {
        for (int k = 0; k <= side; k++) {
            const double x = i / (double)side, z = k / (double)side;
            alpi_bytes_print(text, "v %.*f %.*f %.*f\n", digits, x, digits, sin(9.0 * x) * z,
                             digits, z);
            alpi_bytes_print(text, "vt %.*f %.*f\nvn %.4f 0.5000 %.4f\n", digits, x, digits, z, x,
                             z);
        }
    }
    for (int i = 0; i < side; i++) {
        for (int k = 0; k < side; k++) {
            const int a = i * (side + 1) + k + 1, b = a + 1, c = b + side + 1, d = c - 1;
            alpi_bytes_print(text, "f %d/%d/%d %d/%d/%d %d/%d/%d", a, a, a, b, b, b, c, c, c);
            alpi_bytes_print(text, triangles ? "\nf %d/%d/%d %d/%d/%d %d/%d/%d\n" : " %d/%d/%d\n",
                             triangles ? a : d, triangles ? a : d, triangles ? a : d, c, c, c, d, d,
                             d);
        }
    }
}

/// Adds the bytes: a loop that only looks at all of them.
static double sum_bytes(const alpi_bytes *text)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < text->size; i++) {
        sum = sum * 31 + text->bytes[i]; // each needs the one before, as in text
    }
    return sum == 0 ? 1.0 : 0.0;
}

/// The same field as COLLADA: triangles, or a polylist of quads.
static void print_collada(alpi_bytes *text, int side, bool triangles, int digits)
{
    static const char *const names[] = {"p", "n", "t"};
    static const char *const semantics[] = {"VERTEX", "NORMAL", "TEXCOORD"};
    const int count = (side + 1) * (side + 1), quads = side * side;
    alpi_bytes_print(text, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA version=\"1.4.1\">"
                           "<library_geometries><geometry id=\"g\"><mesh>\n");
    for (int array = 0; array < 3; array++) {
        const int width = array == 2 ? 2 : 3;
        alpi_bytes_print(text, "<source id=\"%s\"><float_array id=\"%sa\" count=\"%d\">",
                         names[array], names[array], width * count);
        for (int i = 0; i < count; i++) {
            const int row = i / (side + 1), column = i % (side + 1);
            const double x = (double)row / side, z = (double)column / side;
            if (array == 0) {
                alpi_bytes_print(text, "%.*f %.*f %.*f ", digits, x, digits, sin(9.0 * x) * z,
                                 digits, z);
            } else if (array == 1) {
                alpi_bytes_print(text, "%.4f 0.5000 %.4f ", x, z);
            } else {
                alpi_bytes_print(text, "%.*f %.*f ", digits, x, digits, z);
            }
        }
        alpi_bytes_print(text,
                         "</float_array><technique_common><accessor source=\"#%sa\" count=\"%d\" "
                         "stride=\"%d\"/></technique_common></source>\n",
                         names[array], count, width);
    }
    const char *kind = triangles ? "triangles" : "polylist";
    alpi_bytes_print(text,
                     "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
                     "<%s count=\"%d\">",
                     kind, quads * (triangles ? 2 : 1));
    for (int k = 0; k < 3; k++) {
        alpi_bytes_print(text, "<input semantic=\"%s\" source=\"#%s\" offset=\"%d\"/>",
                         semantics[k], k == 0 ? "v" : names[k], k);
    }
    alpi_bytes_print(text, "%s", triangles ? "" : "<vcount>");
    for (int i = 0; !triangles && i < quads; i++) {
        alpi_bytes_print(text, "4 ");
    }
    alpi_bytes_print(text, "%s<p>", triangles ? "" : "</vcount>");
    for (int i = 0; i < quads; i++) {
        const int a = i / side * (side + 1) + i % side, b = a + 1, c = b + side + 1, d = c - 1;
        alpi_bytes_print(text, "%d %d %d %d %d %d %d %d %d ", a, a, a, b, b, b, c, c, c);
        if (triangles) {
            alpi_bytes_print(text, "%d %d %d %d %d %d ", a, a, a, c, c, c);
        }
        alpi_bytes_print(text, "%d %d %d ", d, d, d);
    }
    alpi_bytes_print(text,
                     "</p></%s></mesh></geometry></library_geometries><library_visual_scenes>"
                     "<visual_scene id=\"s\"><node><instance_geometry url=\"#g\"/></node>"
                     "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
                     "url=\"#s\"/></scene></COLLADA>\n",
                     kind);
}

/// Adds the numbers, which any reader must read: words that begin as one does.
static double sum_numbers(const alpi_bytes *text)
{
    const char *at = (const char *)text->bytes, *end = at + text->size;
    double sum = 0.0;
    while (at < end) {
        float value;
        const char *behind = alpi_decimal_float(at, end, &value);
        sum += behind != NULL ? (double)value : 0.0;
        at = behind != NULL ? behind : at + 1;
    }
    return sum == 0.5 ? 1.0 : 0.0;
}

static alp_result read_obj(alp_context *context, const alpi_bytes *text, alp_scene **scene)
{
    return alpi_obj_scene_from_bytes(context, "field.obj", text->bytes, text->size, scene);
}

static alp_result read_collada(alp_context *context, const alpi_bytes *text, alp_scene **scene)
{
    alpi_collada_document *document = NULL;
    uint8_t *copy = alpi_allocate(context, text->size, 1); // it keeps the bytes
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(copy, text->bytes, text->size);
    ALP_TRY(alpi_collada_document_parse(context, "field.dae", copy, text->size, &document));
    return alpi_collada_scene_from_document(document, scene);
}

/// A kind of text, how it is read, and a pass over it that any reader needs.
typedef struct text_kind {
    const char *name;
    void (*print)(alpi_bytes *text, int side, bool triangles, int digits);
    alp_result (*read)(alp_context *context, const alpi_bytes *text, alp_scene **scene);
    double (*limit)(const alpi_bytes *text);
    bool triangles;
    int digits;
} text_kind;

/// Seconds of the two, of all threads, medians of rounds in turns.
static bool measure(alp_context *context, const text_kind *kind, const alpi_bytes *text, int rounds,
                    double seconds[2])
{
    double values[2][ROUNDS];
    for (int round = 0; round < rounds; round++) {
        double started = bench_process_seconds();
        const double nothing = kind->limit(text);
        values[0][round] = bench_process_seconds() - started + nothing;
        alp_scene *scene = NULL;
        started = bench_process_seconds();
        if (kind->read(context, text, &scene) != ALP_OK) {
            fprintf(stderr, "alpenglow bench: %s\n", alp_context_message(context));
            return false;
        }
        values[1][round] = bench_process_seconds() - started;
        alp_scene_destroy(scene);
    }
    for (int i = 0; i < 2; i++) {
        seconds[i] = bench_median(values[i], rounds);
    }
    return true;
}

static int bench_texts(const bench_options *options)
{
    static const text_kind kinds[] = {
        {"OBJ, triangles, 6 digits", print_field, read_obj, sum_bytes, true, 6},
        {"OBJ, quads, 6 digits", print_field, read_obj, sum_bytes, false, 6},
        {"OBJ, triangles, 17 digits", print_field, read_obj, sum_bytes, true, 17},
        {"COLLADA, triangles, 6 digits", print_collada, read_collada, sum_numbers, true, 6},
        {"COLLADA, polylist, 6 digits", print_collada, read_collada, sum_numbers, false, 6},
        {"COLLADA, triangles, 17 digits", print_collada, read_collada, sum_numbers, true, 17}};
    bench_table table;
    alp_context *context = NULL;
    if (alp_context_create(NULL, &context) != ALP_OK) {
        return 1;
    }
    bench_table_start(
        &table, "Reading scenes",
        "From memory to a scene that is ready to trace, in seconds of all threads, so "
        "by core. Limit: for OBJ a loop that looks at every byte, for COLLADA one "
        "that reads its numbers.",
        "text|MB|limit MB/s|ours MB/s|ratio");
    int code = 0;
    for (size_t i = 0; code == 0 && i < sizeof kinds / sizeof *kinds; i++) {
        alpi_bytes text = alpi_bytes_create(context);
        double seconds[2];
        kinds[i].print(&text, options->quick ? 40 : 500, kinds[i].triangles, kinds[i].digits);
        code = text.failed ||
               !measure(context, &kinds[i], &text, options->quick ? 1 : ROUNDS, seconds);
        if (code == 0) {
            const double size = (double)text.size * 1e-6;
            bench_table_add(&table, "%s|%.1f|%.0f|%.0f|%.2f", kinds[i].name, size,
                            size / seconds[0], size / seconds[1], seconds[0] / seconds[1]);
        }
        alpi_bytes_destroy(&text);
    }
    bench_table_print(&table, options);
    alp_context_destroy(context);
    return code;
}

// --- ready to trace ------------------------------------------------------------------------------

enum { PATH_SIZE = 512 };

/// A field of hills as a GLB in a temporary file below $TMPDIR. @param path out; the caller removes
/// it @return false after a message: nothing is left
static bool write_hills(const char *name, char path[PATH_SIZE])
{
    const char *folder = getenv("TMPDIR");
    bench_scene hills;
    uint8_t *bytes = NULL;
    size_t size = 0;
    snprintf(path, PATH_SIZE, "%s/alpenglow-bench-XXXXXX.glb", folder != NULL ? folder : "/tmp");
    if (!bench_scene_open(name, 2, &hills)) {
        return false;
    }
    const int file = mkstemps(path, 4);
    FILE *stream = file >= 0 ? fdopen(file, "wb") : NULL;
    bool good =
        stream != NULL && alpi_gltf_export_scene(hills.scene, true, &bytes, &size) == ALP_OK;
    good = good && fwrite(bytes, 1, size, stream) == size;
    good = stream != NULL && fclose(stream) == 0 && good;
    if (!good) {
        fprintf(stderr, "alpenglow bench: %s: cannot be written\n", path);
    }
    if (!good && file >= 0) {
        (void)remove(path);
    }
    alpi_release(hills.scene->context, bytes);
    bench_scene_close(&hills);
    return good;
}

/// Seconds from the start of reading a file to a structure that rays can be asked of.
static bool add_ready(bench_table *table, const char *name, const char *path, int rounds)
{
    double values[3][ROUNDS];
    uint32_t triangles = 0;
    for (int round = 0; round < rounds; round++) {
        uint8_t *bytes = NULL;
        size_t size = 0;
        bench_scene scene;
        double started = alpi_seconds();
        if (!bench_scene_open(path, 2, &scene)) {
            return false;
        }
        values[0][round] = alpi_seconds() - started;
        values[1][round] = scene.build_seconds;
        triangles = scene.scene->triangle_count;
        started = alpi_seconds();
        const bool read =
            bench_good(&scene, alpi_file_read(scene.context, path, UINT64_MAX, &bytes, &size));
        values[2][round] = alpi_seconds() - started;
        alpi_release(scene.context, bytes);
        bench_scene_close(&scene);
        if (!read) {
            return false;
        }
    }
    const double whole = bench_median(values[0], rounds), build = bench_median(values[1], rounds);
    bench_table_add(table, "%s|%.2f|%.3f|%.3f|%.3f|%.3f|%.2f", name, triangles * 1e-6,
                    bench_median(values[2], rounds), whole - build, build, whole, build / whole);
    return true;
}

static int bench_ready(const bench_options *options)
{
    const char *salle = bench_shared("scenes/architecture/salle_de_bain.glb", NULL);
    bench_table table;
    bench_table_start(&table, "Ready to trace",
                      "Seconds on two workers from a file to a structure that rays can be asked "
                      "of. Limit: what Embree takes to build it.",
                      "file|M triangles|its bytes|read|build|whole|limit / whole");
    char hills[PATH_SIZE];
    int code = 1;
    if (write_hills(options->quick ? "hills:5000" : "hills:1000000", hills)) {
        code = !add_ready(&table, "hills.glb, made", hills, options->quick ? 1 : ROUNDS);
        (void)remove(hills);
    }
    if (code == 0 && salle != NULL && !options->quick) {
        code = !add_ready(&table, "salle_de_bain.glb", salle, ROUNDS);
    }
    bench_table_print(&table, options);
    return code;
}

int bench_formats(const bench_options *options)
{
    const int code = bench_texts(options);
    return code != 0 ? code : bench_ready(options);
}
