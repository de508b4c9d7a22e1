// SPDX-License-Identifier: MIT
#include "web/web_scene.h"

#include "options/options.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void web_report(message_log *messages, alp_log_level level, const char *code, const char *object,
                const char *text)
{
    const alp_log_message logged = {.level = level, .code = code, .object = object, .text = text};
    messages_log(messages, &logged);
}

int web_scene_end(const web_scene *scene, alp_result result)
{
    return result == ALP_OK ? EXIT_DONE : failure(alp_context_message(scene->context));
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

/// Whether a uri names a file on a network, as https://host/name does.
static bool is_remote(const char *uri)
{
    return strncmp(uri, "//", 2) == 0 || strstr(uri, "://") != NULL;
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
    web_decode_address(name);
    if (is_remote(uri)) {
        reason = "a page loads nothing from the network; put the file beside the scene and name it "
                 "there";
    } else if (name[0] == '/') {
        reason = "lies outside of the folder of the scene";
    } else if (find_file(scene->path, name, path, &reason)) {
        file.bytes = web_read_bytes(path, &file.size);
        reason = web_reason(errno);
    }
    free(name);
    if (file.bytes == NULL) {
        char text[512];
        snprintf(text, sizeof text, "is left out of the page: %s", reason);
        web_report(messages, ALP_LOG_WARNING, "web-file-left-out", uri, text);
        free(file.uri);
        return;
    }
    scene->files = allocate_or_exit(scene->files, (scene->file_count + 1) * sizeof *scene->files);
    scene->files[scene->file_count++] = file;
}

const json_t *web_member(const json_t *object, const char *first, const char *second)
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
        add_file(scene, json_object_get(web_member(item, "extras", "lightmap"), "uri"), messages);
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
            web_member(m, "extensions", "MOZ_lightmap") != NULL ||
            web_member(m, "extras", "lightmap") != NULL) {
            return true;
        }
    }
    const json_t *bake = json_object_get(web_member(document, "asset", "extras"), "alpenglow");
    return web_member(bake, "light", "as") != NULL;
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
                return web_fail(scene->path, text);
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
        return web_fail(path, "its JSON cannot be read; save it again");
    }
    const int code = check_extensions(scene);
    if (code != EXIT_DONE) {
        return code;
    }
    if (!is_baked(scene->document)) {
        web_report(messages, ALP_LOG_NOTE, "web-no-maps", path,
                   "holds no baked map; the page shows it in plain light (bake it first: alpenglow "
                   "bake)");
    }
    scene->pages = 1;
    add_files(scene, messages);
    return EXIT_DONE;
}

/// Significant digits of a place, to print it to a hundredth of the scene's size.
static int digits_of(const web_scene *scene, double place)
{
    double side = 0.0;
    for (int k = 0; k < 3; k++) {
        side = fmax(side, scene->bounds[1][k] - scene->bounds[0][k]);
    }
    const double ratio = fabs(place) / side;
    return ratio > 1.0 && ratio < 1e12 ? 3 + (int)ceil(log10(ratio)) : 3;
}

const char *web_scene_hash(const web_scene *scene)
{
    const json_t *asset = json_object_get(scene->document, "asset");
    const json_t *bake = web_member(asset, "extras", "alpenglow");
    return json_string_value(json_object_get(bake, "input_hash"));
}

int web_scene_check_place(const web_scene *scene, const char *path, const json_t *document,
                          const double low[3], const double high[3], message_log *messages)
{
    const double *first = scene->bounds[0], *last = scene->bounds[1];
    for (int k = 0; k < 3; k++) {
        if (high[k] < first[k] || low[k] > last[k]) {
            const int digits = digits_of(scene, fmax(fabs(low[k]), fabs(high[k])));
            const int own = digits_of(scene, fmax(fabs(first[k]), fabs(last[k])));
            char text[256];
            snprintf(text, sizeof text,
                     "lies outside of the scene, from %.*g to %.*g m along %c, where the scene "
                     "reaches from %.*g to %.*g m; make it of this scene",
                     digits, low[k], digits, high[k], "xyz"[k], own, first[k], own, last[k]);
            return web_fail(path, text);
        }
    }
    const char *ours = web_scene_hash(scene),
               *theirs = json_string_value(web_member(document, "scene", "hash"));
    if (ours != NULL && theirs != NULL && strcmp(ours, theirs) != 0) {
        web_report(messages, ALP_LOG_WARNING, "web-other-scene", path,
                   "was made of another scene than this bake, or of another state of it; its light "
                   "may not fit");
    }
    return EXIT_DONE;
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
    release_files(scene->grids, scene->grid_count);
    json_decref(scene->volume);
    free(scene->probe_bytes);
    json_decref(scene->probes);
    free(scene->bytes);
    json_decref(scene->document);
    *scene = (web_scene){0};
}
