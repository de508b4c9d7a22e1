// SPDX-License-Identifier: MIT
// A glTF and the files that it names, as text for a page.
#ifndef COMMAND_WEB_SCENE_H
#define COMMAND_WEB_SCENE_H

#include "printing/messages.h"

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/// A file beside the asset, by the name that the asset gives it.
typedef struct web_file {
    char *uri;
    char *bytes; // [size]
    size_t size;
} web_file;

/// Zeroed before web_scene_read.
typedef struct web_scene {
    const char *path; // borrowed
    char *bytes;      // [size] of the asset
    size_t size;
    json_t *document;
    web_file *files; // [file_count]
    size_t file_count;
    web_file *layers; // [layer_count], maps of single lights by the light's name
    size_t layer_count;
    json_t *probes;    // NULL: none
    char *probe_bytes; // [probe_size], their light as KTX2
    size_t probe_size;
} web_scene;

/// The bytes of a file and a 0 after them, malloc'ed. NULL after a message.
char *web_read_file(const char *path, size_t *size);

/// Reads an asset that the library has loaded, and the files that it names. A file that cannot be
/// read, or lies outside of the folder of the asset, is left out with a warning.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int web_scene_read(web_scene *scene, const char *path, message_log *messages);
/// Reads the maps of single lights from a folder of bake --maps-dir, after web_scene_read.
int web_scene_read_layers(web_scene *scene, const char *folder);
/// Reads baked probes.
int web_scene_read_probes(web_scene *scene, const char *path);
/// Writes the elements of the page that hold the scene.
void web_scene_write(FILE *stream, const web_scene *scene);
void web_scene_release(web_scene *scene);

#endif
