// SPDX-License-Identifier: MIT
// How fast scenes are read from memory: an OBJ that the bench writes itself, against what only
// summing its bytes takes.
#include "bench.h"

#include "formats/gltf_splice.h"
#include "formats/obj.h"

#include <math.h>

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

/// Seconds of the two, medians of rounds in turns.
static bool measure(alp_context *context, const alpi_bytes *text, int rounds, double seconds[2])
{
    double values[2][ROUNDS];
    for (int round = 0; round < rounds; round++) {
        double started = bench_thread_seconds();
        const double nothing = sum_bytes(text);
        values[0][round] = bench_thread_seconds() - started + nothing;
        alp_scene *scene = NULL;
        started = bench_thread_seconds();
        if (alpi_obj_scene_from_bytes(context, "field.obj", text->bytes, text->size, &scene) !=
            ALP_OK) {
            fprintf(stderr, "alpenglow bench: %s\n", alp_context_message(context));
            return false;
        }
        values[1][round] = bench_thread_seconds() - started;
        alp_scene_destroy(scene);
    }
    for (int i = 0; i < 2; i++) {
        seconds[i] = bench_median(values[i], rounds);
    }
    return true;
}

int bench_formats(const bench_options *options)
{
    static const struct {
        const char *name;
        bool triangles;
        int digits;
    } fields[] = {{"OBJ, triangles, 6 digits", true, 6},
                  {"OBJ, quads, 6 digits", false, 6},
                  {"OBJ, triangles, 17 digits", true, 17}};
    bench_table table;
    alp_context *context = NULL;
    if (alp_context_create(NULL, &context) != ALP_OK) {
        return 1;
    }
    bench_table_start(&table, "Reading scenes",
                      "From memory to a scene that is ready to trace, one worker. Limit: a loop "
                      "that looks at every byte.",
                      "text|MB|limit MB/s|ours MB/s|ratio");
    int code = 0;
    for (size_t i = 0; code == 0 && i < sizeof fields / sizeof *fields; i++) {
        alpi_bytes text = alpi_bytes_create(context);
        double seconds[2];
        print_field(&text, options->quick ? 40 : 500, fields[i].triangles, fields[i].digits);
        code = text.failed || !measure(context, &text, options->quick ? 1 : ROUNDS, seconds);
        if (code == 0) {
            const double size = (double)text.size * 1e-6;
            bench_table_add(&table, "%s|%.1f|%.0f|%.0f|%.2f", fields[i].name, size,
                            size / seconds[0], size / seconds[1], seconds[0] / seconds[1]);
        }
        alpi_bytes_destroy(&text);
    }
    bench_table_print(&table, options);
    alp_context_destroy(context);
    return code;
}
