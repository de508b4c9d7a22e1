// SPDX-License-Identifier: MIT
// The maps of single lights that bake --layers wrote beside the scene.
#include "web/web_scene.h"

#include "options/options.h"
#include "output.h"

#include <alpenglow/alpenglow.h>

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char prefix[] = "irradiance.", ending[] = ".exr";

/// The name of the light, malloc'ed; NULL: the file is no first page of one light. Names of lights
/// have no dots and are no numbers: those files are further pages.
static char *layer_name(const char *file)
{
    static const char *const others[] = {"error", "direct", "bounced"};
    const size_t length = strlen(file), start = sizeof prefix - 1, end = sizeof ending - 1;
    if (length <= start + end || strncmp(file, prefix, start) != 0 || !path_ends(file, ending)) {
        return NULL;
    }
    const size_t count = length - start - end;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (strlen(others[i]) == count && strncmp(file + start, others[i], count) == 0) {
            return NULL;
        }
    }
    if (memchr(file + start, '.', count) != NULL || strspn(file + start, "0123456789") >= count) {
        return NULL;
    }
    char *name = allocate_or_exit(NULL, count + 1);
    memcpy(name, file + start, count);
    name[count] = '\0';
    return name;
}

/// Whether the head of an EXR says that its values are divided by a scale.
static bool is_scaled(const web_file *layer)
{
    static const char word[] = "alpenglowScale";
    const size_t head = layer->size < 4096 ? layer->size : 4096;
    for (size_t i = 0; i + sizeof word <= head; i++) {
        if (memcmp(layer->bytes + i, word, sizeof word) == 0) {
            return true;
        }
    }
    return false;
}

static json_int_t light_number(const web_scene *scene, const char *key)
{
    const json_t *asset = json_object_get(scene->document, "asset");
    const json_t *bake = web_member(asset, "extras", "alpenglow");
    return json_integer_value(web_member(bake, "light", key));
}

/// Adds the texels of a page of a light. @param is_first whether they are counted
static void add_texels(web_scene *scene, alp_image *image, bool is_first)
{
    const alp_image_info info = alp_image_get_info(image);
    const float *pixels = alp_image_floats(image);
    const size_t count = (size_t)info.width * info.height, step = info.channels;
    for (size_t i = 0; i < count && pixels != NULL && step == 4; i++, pixels += step) {
        if (pixels[3] > 0.0f) {
            scene->layer_sum += (double)pixels[0] + (double)pixels[1] + (double)pixels[2];
            scene->layer_texels += is_first ? 1.0 : 0.0;
        }
    }
}

/// Whether the library reads the file, and it has the size of the light in the scene.
/// @param is_first whether the file is of the first light
static int read_image(web_scene *scene, const char *path, const web_file *layer, bool is_first)
{
    if (is_scaled(layer)) {
        return web_fail(path, "its values are scaled; bake again with --maps-as exr");
    }
    alp_image *image = NULL;
    int code = web_scene_end(scene, alp_image_load(scene->context, path, &image));
    const json_int_t size = light_number(scene, "size");
    const uint32_t width = code == EXIT_DONE ? alp_image_get_info(image).width : 0;
    if (code == EXIT_DONE && size > 0 && size != (json_int_t)width) {
        char text[160];
        snprintf(text, sizeof text,
                 "is of another bake: it has %u texels a side, the light of the scene %lld; name "
                 "the folder of its own bake",
                 width, (long long)size);
        code = web_fail(path, text);
    }
    if (code == EXIT_DONE) {
        add_texels(scene, image, is_first);
    }
    alp_image_destroy(image);
    return code;
}

/// Reads a page of the layer that scene->layers[index] stands for.
static int read_page(web_scene *scene, const char *folder, size_t index, unsigned page)
{
    web_file *layer = &scene->layers[index];
    char number[16] = "";
    if (page > 0) {
        snprintf(number, sizeof number, ".%u", page);
    }
    const size_t size = strlen(folder) + strlen(layer->uri) + sizeof number + 32;
    char *path = allocate_or_exit(NULL, size);
    snprintf(path, size, "%s/%s%s%s%s", folder, prefix, layer->uri, number, ending);
    layer->bytes = web_read_file(path, &layer->size);
    const int code =
        layer->bytes != NULL ? read_image(scene, path, layer, index < scene->pages) : EXIT_FAILED;
    free(path);
    return code;
}

static int compare_layers(const void *a, const void *b)
{
    return strcmp(((const web_file *)a)->uri, ((const web_file *)b)->uri);
}

/// Layers stand for the light map of all materials: there must be one.
static int check_bake(const web_scene *scene)
{
    const json_t *asset = json_object_get(scene->document, "asset");
    const json_t *bake = web_member(asset, "extras", "alpenglow");
    const char *form = json_string_value(web_member(bake, "light", "as"));
    const char *units = json_string_value(web_member(bake, "light", "units"));
    const bool is_map = form != NULL && (strcmp(form, "moz") == 0 || strcmp(form, "extras") == 0);
    return is_map && (units == NULL || strcmp(units, "radiance") != 0)
               ? EXIT_DONE
               : web_fail(scene->path, "--maps-dir needs light as a map beside the colours; bake "
                                       "with --layers --lightmap-as extras (or moz)");
}

/// Adds a layer for each name in the folder, once for each page, without its bytes.
static void list_layers(web_scene *scene, DIR *list)
{
    for (struct dirent *d = readdir(list); d != NULL; d = readdir(list)) {
        char *name = layer_name(d->d_name);
        for (unsigned page = 0; name != NULL && page < scene->pages; page++) {
            scene->layers =
                allocate_or_exit(scene->layers, (scene->layer_count + 1) * sizeof *scene->layers);
            char *copy = page == 0 ? name : allocate_or_exit(NULL, strlen(name) + 1);
            memmove(copy, name, strlen(name) + 1);
            scene->layers[scene->layer_count++] = (web_file){.uri = copy};
        }
    }
    if (scene->layer_count > 0) {
        qsort(scene->layers, scene->layer_count, sizeof *scene->layers, compare_layers);
    }
}

/// Warns of lights that together are far from the light of the file. The two means of one bake
/// differ by some 7 %, because texels count alike in a map and areas in the scene.
static void compare_light(const web_scene *scene, const char *folder, message_log *messages)
{
    static const double APART = 1.5;
    const json_t *asset = json_object_get(scene->document, "asset");
    const json_t *bake = web_member(asset, "extras", "alpenglow");
    const char *units = json_string_value(web_member(bake, "light", "units"));
    const bool is_over_pi = units != NULL && strcmp(units, "irradiance/pi") == 0;
    const double own = is_over_pi ? acos(-1.0) * scene->light : scene->light;
    const double mean = scene->layer_sum / (3.0 * scene->layer_texels);
    if (own > 0.0 && scene->layer_texels > 0.0 && !(mean < APART * own && own < APART * mean)) {
        char text[192];
        snprintf(text, sizeof text,
                 "is of another bake: its lights together have a mean of %.3g W/m2, the light of "
                 "the scene %.3g; name the folder of its own bake",
                 mean, own);
        web_report(messages, ALP_LOG_WARNING, "web-other-maps", folder, text);
    }
}

int web_scene_read_layers(web_scene *scene, const char *folder, message_log *messages)
{
    int code = check_bake(scene);
    if (code != EXIT_DONE) {
        return code;
    }
    DIR *list = opendir(folder);
    if (list == NULL) {
        return web_fail(folder, strerror(errno));
    }
    const json_int_t pages = light_number(scene, "pages");
    scene->pages = pages > 1 && pages < 100000 ? (unsigned)pages : 1;
    list_layers(scene, list);
    closedir(list);
    if (scene->layer_count == 0) {
        return web_fail(folder, "has no maps of single lights, irradiance.NAME.exr; bake with "
                                "--layers --maps-dir");
    }
    for (size_t i = 0; i < scene->layer_count && code == EXIT_DONE; i++) {
        code = read_page(scene, folder, i, (unsigned)(i % scene->pages));
    }
    if (code == EXIT_DONE) {
        compare_light(scene, folder, messages);
    }
    return code;
}
