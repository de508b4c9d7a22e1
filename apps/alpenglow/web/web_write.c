// SPDX-License-Identifier: MIT
// The elements of the page that hold the scene.
#include "output.h"
#include "web/web_scene.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void write_base64(FILE *stream, const char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = (const unsigned char *)bytes;
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t bits = (uint32_t)b[i] << 16 | (left > 1 ? (uint32_t)b[i + 1] << 8 : 0) |
                              (left > 2 ? (uint32_t)b[i + 2] : 0);
        const char text[4] = {digits[bits >> 18], digits[bits >> 12 & 63],
                              left > 1 ? digits[bits >> 6 & 63] : '=',
                              left > 2 ? digits[bits & 63] : '='};
        fwrite(text, 1, sizeof text, stream);
    }
}

/// Writes JSON that can stand in a script element. NULL: null.
static void write_json(FILE *stream, const json_t *value)
{
    char *dump = value != NULL ? json_dumps(value, JSON_ENCODE_ANY) : NULL;
    for (const char *at = dump != NULL ? dump : "null"; *at != '\0'; at++) {
        if (*at == '<') {
            fputs("\\u003c", stream);
        } else {
            fputc(*at, stream);
        }
    }
    free(dump);
}

static void write_json_text(FILE *stream, const char *text)
{
    json_t *value = json_text(text);
    write_json(stream, value);
    json_decref(value);
}

static void write_data(FILE *stream, const char *kind, const char *bytes, size_t size)
{
    fprintf(stream, "<script type=\"application/base64\" class=\"%s\">", kind);
    write_base64(stream, bytes, size);
    fputs("</script>\n", stream);
}

/// Writes the data of files.
static void write_files(FILE *stream, const char *kind, const web_file *files, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        write_data(stream, kind, files[i].bytes, files[i].size);
    }
}

/// @param step 1, or more: names of each step-th file
static void write_names(FILE *stream, const web_file *files, size_t count, size_t step)
{
    for (size_t i = 0; i < count; i += step) {
        fputs(i > 0 ? ", " : "", stream);
        write_json_text(stream, files[i].uri);
    }
}

/// Writes the camera: metres, and degrees for the field of view.
static void write_camera(FILE *stream, const web_scene *scene)
{
    const double *eye = scene->eye, *target = scene->target;
    fprintf(stream, "{\"position\": [%.9g, %.9g, %.9g], \"target\": [%.9g, %.9g, %.9g]", eye[0],
            eye[1], eye[2], target[0], target[1], target[2]);
    fprintf(stream, ", \"fov\": %.6g}", scene->field_of_view * 180.0 / acos(-1.0));
}

void web_scene_write(FILE *stream, const web_scene *scene)
{
    const char *slash = strrchr(scene->path, '/');
    fputs("<script type=\"application/json\" id=\"scene\">{\"name\": ", stream);
    write_json_text(stream, slash == NULL ? scene->path : slash + 1);
    fputs(", \"camera\": ", stream);
    write_camera(stream, scene);
    fputs(", \"files\": [", stream);
    write_names(stream, scene->files, scene->file_count, 1);
    fputs("], \"layers\": [", stream);
    write_names(stream, scene->layers, scene->layer_count, scene->pages);
    fprintf(stream, "], \"pages\": %u, \"probes\": ", scene->pages);
    write_json(stream, scene->probes);
    fputs(", \"volume\": ", stream);
    write_json(stream, scene->volume);
    fputs("}</script>\n", stream);
    write_data(stream, "asset", scene->bytes, scene->size);
    write_files(stream, "file", scene->files, scene->file_count);
    write_files(stream, "layer", scene->layers, scene->layer_count);
    write_files(stream, "volume", scene->grids, scene->grid_count);
    if (scene->probes != NULL) {
        write_data(stream, "probes", scene->probe_bytes, scene->probe_size);
    }
}
