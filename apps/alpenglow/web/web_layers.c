// SPDX-License-Identifier: MIT
// The maps of single lights that bake --layers wrote beside the scene.
#include "web/web_scene.h"

#include "options/options.h"
#include "output.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char prefix[] = "irradiance.", ending[] = ".exr";

static int fail(const char *path, const char *text)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, path);
    fprintf(stderr, ": %s\n", text);
    return EXIT_FAILED;
}

/// The name of the light, malloc'ed; NULL: the file is no map of one light.
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

/// @param name becomes the layer's
static int add_layer(web_scene *scene, const char *folder, const char *file, char *name)
{
    const size_t size = strlen(folder) + strlen(file) + 2;
    char *path = allocate_or_exit(NULL, size);
    snprintf(path, size, "%s/%s", folder, file);
    web_file layer = {.uri = name};
    layer.bytes = web_read_file(path, &layer.size);
    int code = layer.bytes != NULL ? EXIT_DONE : EXIT_FAILED;
    if (code == EXIT_DONE && is_scaled(&layer)) {
        code = fail(path, "its values are scaled; bake again with --maps-as exr");
    }
    free(path);
    scene->layers =
        allocate_or_exit(scene->layers, (scene->layer_count + 1) * sizeof *scene->layers);
    scene->layers[scene->layer_count++] = layer;
    return code;
}

static int compare_layers(const void *a, const void *b)
{
    return strcmp(((const web_file *)a)->uri, ((const web_file *)b)->uri);
}

/// Layers stand for the light map of all materials: there must be one, of one page.
static int check_bake(const web_scene *scene)
{
    const json_t *asset = json_object_get(scene->document, "asset");
    const json_t *bake = json_object_get(json_object_get(asset, "extras"), "alpenglow");
    const json_t *light = json_object_get(bake, "light");
    const char *form = json_string_value(json_object_get(light, "as"));
    const char *units = json_string_value(json_object_get(light, "units"));
    if (form == NULL || (strcmp(form, "moz") != 0 && strcmp(form, "extras") != 0) ||
        (units != NULL && strcmp(units, "radiance") == 0)) {
        return fail(scene->path, "--maps-dir needs light as a map beside the colours; bake with "
                                 "--layers --lightmap-as extras (or moz)");
    }
    return json_integer_value(json_object_get(light, "pages")) > 1
               ? fail(scene->path, "--maps-dir: its light has several pages, layers are shown of "
                                   "one; bake with a larger --size")
               : EXIT_DONE;
}

int web_scene_read_layers(web_scene *scene, const char *folder)
{
    int code = check_bake(scene);
    DIR *list = code == EXIT_DONE ? opendir(folder) : NULL;
    if (list == NULL) {
        return code == EXIT_DONE ? fail(folder, strerror(errno)) : code;
    }
    for (struct dirent *d = readdir(list); d != NULL && code == EXIT_DONE; d = readdir(list)) {
        char *name = layer_name(d->d_name);
        code = name != NULL ? add_layer(scene, folder, d->d_name, name) : code;
    }
    closedir(list);
    if (code == EXIT_DONE && scene->layer_count == 0) {
        return fail(folder, "has no maps of single lights, irradiance.NAME.exr; bake with --layers "
                            "--maps-dir");
    }
    if (code == EXIT_DONE) {
        qsort(scene->layers, scene->layer_count, sizeof *scene->layers, compare_layers);
    }
    return code;
}
