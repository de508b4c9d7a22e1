// SPDX-License-Identifier: MIT
// The volume of alpenglow lpv --volume for the slices of the page.
#include "web/web_scene.h"

#include "options/options.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_LIMIT = 512, GRID_LIMIT = 8 };

static int fail_volume(const char *path)
{
    return web_fail(path, "is no volume of light, or damaged; write it again by alpenglow lpv "
                          "SCENE --volume FILE.lpv.json");
}

/// Reads three numbers. False: others.
static bool read_triple(const json_t *array, double low, double high, double values[3])
{
    for (size_t k = 0; k < 3; k++) {
        const json_t *value = json_array_get(array, k);
        values[k] = json_number_value(value);
        if (!json_is_number(value) || !(values[k] >= low && values[k] <= high)) {
            return false;
        }
    }
    return json_array_size(array) == 3;
}

static void write_float(char *bytes, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int k = 0; k < 4; k++) {
        bytes[k] = (char)(bits >> 8 * k & 0xFF);
    }
}

/// Reads the fluence of all cells. False: a value is missing, negative or no number.
static bool read_fluence(const json_t *array, size_t count, web_file *grid)
{
    if (json_array_size(array) != count) {
        return false;
    }
    grid->size = count * sizeof(float);
    grid->bytes = allocate_or_exit(NULL, grid->size);
    for (size_t i = 0; i < count; i++) {
        const json_t *value = json_array_get(array, i);
        const float fluence = (float)json_number_value(value);
        if (!json_is_number(value) || !(fluence >= 0.0f && isfinite(fluence))) {
            return false;
        }
        write_float(grid->bytes + i * sizeof(float), fluence);
    }
    return true;
}

/// Adds a grid. @param low, high out: its corners, metres
static bool add_grid(web_scene *scene, const json_t *grid, double low[3], double high[3])
{
    const json_t *given = json_object_get(grid, "cell"), *size = json_object_get(grid, "size");
    const double cell = json_number_value(given);
    double sides[3];
    if (!json_is_number(given) || !(cell > 0.0 && cell <= 1e12) ||
        !read_triple(size, 1.0, SIDE_LIMIT, sides) ||
        !read_triple(json_object_get(grid, "corner"), -1e12, 1e12, low)) {
        return false;
    }
    size_t count = 3;
    for (size_t k = 0; k < 3; k++) {
        high[k] = low[k] + cell * sides[k];
        if (!json_is_integer(json_array_get(size, k))) {
            return false;
        }
        count *= (size_t)sides[k];
    }
    scene->grids = allocate_or_exit(scene->grids, (scene->grid_count + 1) * sizeof *scene->grids);
    scene->grids[scene->grid_count] = (web_file){0};
    scene->grid_count += 1;
    json_array_append_new(scene->volume, json_pack("{s:f, s:[f, f, f], s:O}", "cell", cell,
                                                   "corner", low[0], low[1], low[2], "size", size));
    return read_fluence(json_object_get(grid, "fluence"), count,
                        &scene->grids[scene->grid_count - 1]);
}

static int read_grids(web_scene *scene, const char *path, const json_t *document,
                      message_log *messages)
{
    const char *format = json_string_value(json_object_get(document, "format"));
    const json_t *grids = json_object_get(document, "grids"), *grid;
    const size_t count = json_array_size(grids);
    double low[3], high[3];
    size_t i;
    if (format == NULL || strcmp(format, "alpenglow-volume") != 0 || count < 1 ||
        count > GRID_LIMIT) {
        return fail_volume(path);
    }
    if (json_integer_value(json_object_get(document, "version")) != 1) {
        return web_fail(path, "has another version than 1, which this alpenglow cannot read; write "
                              "it again with this one");
    }
    scene->volume = json_array();
    json_array_foreach(grids, i, grid)
    {
        if (!add_grid(scene, grid, low, high)) {
            return fail_volume(path);
        }
    }
    return web_scene_check_place(scene, path, document, low, high, messages); // of the coarsest
}

int web_scene_read_volume(web_scene *scene, const char *path, message_log *messages)
{
    size_t size = 0;
    char *bytes = web_read_file(path, &size);
    if (bytes == NULL) {
        return EXIT_FAILED;
    }
    json_t *document = json_loadb(bytes, size, 0, NULL);
    free(bytes);
    const int code =
        document != NULL ? read_grids(scene, path, document, messages) : fail_volume(path);
    json_decref(document);
    return code;
}
