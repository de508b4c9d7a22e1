// SPDX-License-Identifier: MIT
// Baked probes for the sphere of the page.
#include "web/web_scene.h"

#include "options/options.h"

#include <alpenglow/alpenglow.h>

#include <stdlib.h>
#include <string.h>

static int fail(const char *path, const char *text)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, path);
    fprintf(stderr, ": %s\n", text);
    return EXIT_FAILED;
}

/// Loads the probes as all commands do: sizes and checksums are right then.
static int check_probes(const char *path)
{
    alp_context *context = NULL;
    alp_probes *probes = NULL;
    if (alp_context_create(NULL, &context) != ALP_OK) {
        return failure("out of memory");
    }
    const int code = alp_probes_load(context, path, &probes) == ALP_OK
                         ? EXIT_DONE
                         : failure(alp_context_message(context));
    alp_probes_destroy(probes);
    alp_context_destroy(context);
    return code;
}

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
        return fail(path, "the page shows grids of spherical harmonics alone; bake probes with "
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

int web_scene_read_probes(web_scene *scene, const char *path)
{
    const int code = check_probes(path);
    if (code != EXIT_DONE) {
        return code;
    }
    scene->probes = json_load_file(path, 0, NULL);
    return scene->probes != NULL ? read_texture(scene, path)
                                 : fail(path, "its JSON cannot be read; bake the probes again");
}
