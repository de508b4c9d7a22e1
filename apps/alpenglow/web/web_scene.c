// SPDX-License-Identifier: MIT
#include "web/web_scene.h"

#include "options/options.h"
#include "output.h"

#include <alpenglow/context.h>

#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(const char *path, const char *text)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, path);
    fprintf(stderr, ": %s\n", text);
    return EXIT_FAILED;
}

static void report(message_log *messages, alp_log_level level, const char *code, const char *object,
                   const char *text)
{
    const alp_log_message logged = {.level = level, .code = code, .object = object, .text = text};
    messages_log(messages, &logged);
}

/// The bytes of an ordinary file and a 0. NULL with errno.
static char *read_bytes(const char *path, size_t *size)
{
    struct stat about;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    char *bytes = NULL;
    errno = 0;
    if (fstat(fileno(file), &about) == 0 && S_ISREG(about.st_mode)) {
        *size = (size_t)about.st_size;
        bytes = allocate_or_exit(NULL, *size + 1);
        bytes[*size] = '\0';
    }
    if (bytes != NULL && fread(bytes, 1, *size, file) != *size) {
        free(bytes);
        bytes = NULL;
    }
    errno = bytes == NULL && errno == 0 ? EIO : errno;
    fclose(file);
    return bytes;
}

char *web_read_file(const char *path, size_t *size)
{
    char *bytes = read_bytes(path, size);
    if (bytes == NULL) {
        fail(path, strerror(errno));
    }
    return bytes;
}

static size_t read_u32(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (size_t)b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
}

/// The JSON of a .gltf, or of the first chunk of a .glb.
static json_t *parse(const web_scene *scene)
{
    const char *text = scene->bytes;
    size_t length = scene->size;
    if (length >= 20 && memcmp(text, "glTF", 4) == 0) {
        const size_t chunk = read_u32(text + 12);
        length = chunk < length - 20 ? chunk : length - 20;
        text += 20;
    } else if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        text += 3;
        length -= 3;
    }
    return json_loadb(text, length, JSON_ALLOW_NUL, NULL);
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/// Decodes %20 and the like in place.
static void decode_uri(char *text)
{
    char *to = text;
    for (const char *at = text; *at != '\0'; to++) {
        const int high = at[0] == '%' ? hex_digit(at[1]) : -1;
        const int low = high >= 0 ? hex_digit(at[2]) : -1;
        const bool coded = low >= 0 && 16 * high + low != 0;
        *to = coded ? (char)(16 * high + low) : *at;
        at += coded ? 3 : 1;
    }
    *to = '\0';
}

/// The path of a file that lies below the folder of the asset, links resolved. False with a reason.
static bool find_file(const char *asset, const char *name, char path[PATH_MAX], const char **reason)
{
    char joined[PATH_MAX], folder[PATH_MAX];
    const char *slash = strrchr(asset, '/');
    const int length = slash == NULL ? 0 : (int)(slash + 1 - asset);
    const int written = snprintf(joined, sizeof joined, "%.*s%s", length, asset, name);
    if (written < 0 || (size_t)written >= sizeof joined) {
        *reason = "its name is too long";
        return false;
    }
    const char *at = joined;
    joined[length] = '\0';
    const bool there = realpath(length > 0 ? at : ".", folder) != NULL;
    joined[length] = name[0];
    if (!there || realpath(joined, path) == NULL) {
        *reason = strerror(errno);
        return false;
    }
    const size_t root = strlen(folder);
    if (strncmp(path, folder, root) != 0 || (root > 1 && path[root] != '/')) {
        *reason = "lies outside of the folder of the scene";
        return false;
    }
    return true;
}

static bool is_known(const web_scene *scene, const char *uri)
{
    for (size_t i = 0; i < scene->file_count; i++) {
        if (strcmp(scene->files[i].uri, uri) == 0) {
            return true;
        }
    }
    return false;
}

/// Adds the file of a uri, unless the uri holds its data itself.
static void add_file(web_scene *scene, const json_t *value, message_log *messages)
{
    const char *uri = json_string_value(value), *reason = NULL;
    if (uri == NULL || uri[0] == '\0' || strncmp(uri, "data:", 5) == 0 || is_known(scene, uri)) {
        return;
    }
    char *name = strdup(uri), path[PATH_MAX];
    web_file file = {.uri = strdup(uri)};
    if (name == NULL || file.uri == NULL) {
        failure("out of memory");
        exit(EXIT_FAILED);
    }
    decode_uri(name);
    if (name[0] == '/') {
        reason = "lies outside of the folder of the scene";
    } else if (find_file(scene->path, name, path, &reason)) {
        file.bytes = read_bytes(path, &file.size);
        reason = strerror(errno);
    }
    free(name);
    if (file.bytes == NULL) {
        char text[512];
        snprintf(text, sizeof text, "is left out of the page: %s", reason);
        report(messages, ALP_LOG_WARNING, "web-file-left-out", uri, text);
        free(file.uri);
        return;
    }
    scene->files = allocate_or_exit(scene->files, (scene->file_count + 1) * sizeof *scene->files);
    scene->files[scene->file_count++] = file;
}

static const json_t *member(const json_t *object, const char *first, const char *second)
{
    return json_object_get(json_object_get(object, first), second);
}

static void add_files(web_scene *scene, message_log *messages)
{
    static const char *const lists[] = {"buffers", "images"};
    size_t i;
    const json_t *item;
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        json_array_foreach(json_object_get(scene->document, lists[k]), i, item)
        {
            add_file(scene, json_object_get(item, "uri"), messages);
        }
    }
    json_array_foreach(json_object_get(scene->document, "materials"), i, item)
    {
        add_file(scene, json_object_get(member(item, "extras", "lightmap"), "uri"), messages);
    }
}

/// Whether the asset holds a map that the page can switch.
static bool is_baked(const json_t *document)
{
    size_t i;
    const json_t *m;
    json_array_foreach(json_object_get(document, "materials"), i, m)
    {
        if (json_object_get(m, "occlusionTexture") != NULL ||
            member(m, "extensions", "MOZ_lightmap") != NULL ||
            member(m, "extras", "lightmap") != NULL) {
            return true;
        }
    }
    const json_t *bake = json_object_get(member(document, "asset", "extras"), "alpenglow");
    return member(bake, "light", "as") != NULL;
}

/// Refuses what three.js needs a decoder for that the page has not.
static int check_extensions(const web_scene *scene)
{
    static const char *const absent[] = {"KHR_draco_mesh_compression", "KHR_texture_basisu"};
    size_t i;
    const json_t *name;
    json_array_foreach(json_object_get(scene->document, "extensionsUsed"), i, name)
    {
        for (size_t k = 0; k < sizeof absent / sizeof *absent; k++) {
            if (json_is_string(name) && strcmp(json_string_value(name), absent[k]) == 0) {
                char text[128];
                snprintf(text, sizeof text,
                         "uses %s, which the page cannot decode; save it without", absent[k]);
                return fail(scene->path, text);
            }
        }
    }
    return EXIT_DONE;
}

int web_scene_read(web_scene *scene, const char *path, message_log *messages)
{
    scene->path = path;
    scene->bytes = web_read_file(path, &scene->size);
    if (scene->bytes == NULL) {
        return EXIT_FAILED;
    }
    scene->document = parse(scene);
    if (scene->document == NULL) {
        return fail(path, "its JSON cannot be read; save it again");
    }
    const int code = check_extensions(scene);
    if (code != EXIT_DONE) {
        return code;
    }
    if (!is_baked(scene->document)) {
        report(messages, ALP_LOG_NOTE, "web-no-maps", path,
               "holds no baked map; the page shows it in plain light (bake it first: alpenglow "
               "bake)");
    }
    add_files(scene, messages);
    return EXIT_DONE;
}

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

/// Writes JSON that can stand in a script element.
static void write_json(FILE *stream, const json_t *value)
{
    char *dump = value != NULL ? json_dumps(value, JSON_ENCODE_ANY) : NULL;
    for (const char *at = dump != NULL ? dump : "\"\""; *at != '\0'; at++) {
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

static void write_names(FILE *stream, const web_file *files, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        fputs(i > 0 ? ", " : "", stream);
        write_json_text(stream, files[i].uri);
    }
}

void web_scene_write(FILE *stream, const web_scene *scene)
{
    const char *slash = strrchr(scene->path, '/');
    fputs("<script type=\"application/json\" id=\"scene\">{\"name\": ", stream);
    write_json_text(stream, slash == NULL ? scene->path : slash + 1);
    fputs(", \"files\": [", stream);
    write_names(stream, scene->files, scene->file_count);
    fputs("], \"layers\": [", stream);
    write_names(stream, scene->layers, scene->layer_count);
    fputs("], \"probes\": ", stream);
    if (scene->probes != NULL) {
        write_json(stream, scene->probes);
    } else {
        fputs("null", stream);
    }
    fputs("}</script>\n", stream);
    write_data(stream, "asset", scene->bytes, scene->size);
    for (size_t i = 0; i < scene->file_count; i++) {
        write_data(stream, "file", scene->files[i].bytes, scene->files[i].size);
    }
    for (size_t i = 0; i < scene->layer_count; i++) {
        write_data(stream, "layer", scene->layers[i].bytes, scene->layers[i].size);
    }
    if (scene->probes != NULL) {
        write_data(stream, "probes", scene->probe_bytes, scene->probe_size);
    }
}

static void release_files(web_file *files, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free(files[i].uri);
        free(files[i].bytes);
    }
    free(files);
}

void web_scene_release(web_scene *scene)
{
    release_files(scene->files, scene->file_count);
    release_files(scene->layers, scene->layer_count);
    free(scene->probe_bytes);
    json_decref(scene->probes);
    free(scene->bytes);
    json_decref(scene->document);
    *scene = (web_scene){0};
}
