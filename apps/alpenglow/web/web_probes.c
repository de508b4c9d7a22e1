// SPDX-License-Identifier: MIT
// Baked probes for the sphere of the page.
#include "web/web_scene.h"

#include "options/options.h"

#include <alpenglow/alpenglow.h>

#include <stdlib.h>
#include <string.h>

/// Reads the texture that the JSON names, in its folder.
static int read_texture(web_scene *scene, const char *path)
{
    const json_t *textures = json_object_get(scene->probes, "textures");
    const json_t *light = json_object_get(textures, "coefficients");
    const char *name = json_string_value(json_object_get(light, "file"));
    const char *layout = json_string_value(json_object_get(scene->probes, "layout"));
    const char *basis = json_string_value(json_object_get(scene->probes, "basis"));
    if (name == NULL || layout == NULL || basis == NULL || strcmp(layout, "grid") != 0 ||
        strcmp(basis, "ambient-cube") == 0) {
        return web_fail(path, "the page shows grids of spherical harmonics alone; bake probes with "
                              "--spacing and --basis sh9 or sh4");
    }
    const char *slash = strrchr(path, '/');
    const int length = slash == NULL ? 0 : (int)(slash + 1 - path);
    const size_t size = (size_t)length + strlen(name) + 1;
    char *texture = allocate_or_exit(NULL, size);
    snprintf(texture, size, "%.*s%s", length, path, name);
    scene->probe_bytes = web_read_file(texture, &scene->probe_size);
    free(texture);
    return scene->probe_bytes != NULL ? EXIT_DONE : EXIT_FAILED;
}

/// Whether the grid lies in the scene.
static int check_place(const web_scene *scene, const char *path, message_log *messages)
{
    double low[3], high[3];
    for (size_t k = 0; k < 3; k++) {
        const json_t *size = json_object_get(scene->probes, "size");
        low[k] = json_number_value(json_array_get(json_object_get(scene->probes, "origin"), k));
        high[k] = low[k] + (json_number_value(json_array_get(size, k)) - 1.0) *
                               json_number_value(
                                   json_array_get(json_object_get(scene->probes, "spacing"), k));
    }
    return web_scene_check_place(scene, path, scene->probes, low, high, messages);
}

int web_scene_read_probes(web_scene *scene, const char *path, message_log *messages)
{
    alp_probes *probes = NULL; // loading checks sizes and sums
    int code = web_scene_end(scene, alp_probes_load(scene->context, path, &probes));
    alp_probes_destroy(probes);
    if (code != EXIT_DONE) {
        return code;
    }
    scene->probes = json_load_file(path, 0, NULL);
    if (scene->probes == NULL) {
        return web_fail(path, "its JSON cannot be read; bake the probes again");
    }
    code = read_texture(scene, path);
    return code == EXIT_DONE ? check_place(scene, path, messages) : code;
}
