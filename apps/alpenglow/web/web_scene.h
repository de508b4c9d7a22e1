// SPDX-License-Identifier: MIT
// A glTF and the files that it names, as text for a page.
#ifndef COMMAND_WEB_SCENE_H
#define COMMAND_WEB_SCENE_H

#include "printing/messages.h"
#include "web/web_file.h"

#include <alpenglow/alpenglow.h>

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/// A file beside the asset, by the name that the asset gives it.
typedef struct web_file {
    char *uri;
    char *bytes; // [size]
    size_t size;
} web_file;

/// Zeroed before web_scene_read, except the members up to light.
typedef struct web_scene {
    alp_context *context; // borrowed; loads files, so that their faults have the same messages
    double bounds[2][3];  // lowest and highest corner, metres in the world of the file
    double eye[3];        // place of the camera, metres
    double target[3];     // a point ahead of the camera, metres
    double field_of_view; // of a square picture, radians
    double light;         // mean of the light map over its surfaces, units of the file; 0: unknown
    const char *path;     // borrowed
    char *bytes;          // [size] of the asset
    size_t size;
    json_t *document;
    web_file *files; // [file_count]
    size_t file_count;
    unsigned pages;   // of the atlas of light, >= 1
    web_file *layers; // [layer_count], maps of single lights by the light's name, page after page
    size_t layer_count;
    double layer_sum, layer_texels; // sum of their red, green and blue; covered texels of one light
    json_t *probes;                 // NULL: none
    char *probe_bytes;              // [probe_size], their light as KTX2
    size_t probe_size;
    json_t *volume;  // cell, corner and size of each grid; NULL: none
    web_file *grids; // [grid_count], fluence of the cells: little-endian floats, RGB
    size_t grid_count;
} web_scene;

void web_report(message_log *messages, alp_log_level level, const char *code, const char *object,
                const char *text);
const json_t *web_member(const json_t *object, const char *first, const char *second);

/// Prints the message of a failed call of the library. @return EXIT_DONE or EXIT_FAILED
int web_scene_end(const web_scene *scene, alp_result result);
/// Reads an asset that the library has loaded, and the files that it names. A file that cannot be
/// read, or lies outside of the folder of the asset, is left out with a warning.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int web_scene_read(web_scene *scene, const char *path, message_log *messages);
/// Hash of the input of the bake, borrowed. NULL: the asset states none.
const char *web_scene_hash(const web_scene *scene);
/// Reads the maps of single lights from a folder of bake --maps-dir, after web_scene_read. Warns of
/// lights whose mean together is over 1.5 times that of the file's light, or under two thirds.
int web_scene_read_layers(web_scene *scene, const char *folder, message_log *messages);
/// Reads baked probes.
int web_scene_read_probes(web_scene *scene, const char *path, message_log *messages);
/// Reads the volume of alpenglow lpv --volume.
int web_scene_read_volume(web_scene *scene, const char *path, message_log *messages);
/// Whether light in space belongs to the scene: refuses a box that lies outside of its bounds, and
/// warns where the file names another scene.
/// @param document of the file   @param low, high metres   @return EXIT_DONE, or EXIT_FAILED
int web_scene_check_place(const web_scene *scene, const char *path, const json_t *document,
                          const double low[3], const double high[3], message_log *messages);
/// Writes the elements of the page that hold the scene.
void web_scene_write(FILE *stream, const web_scene *scene);
void web_scene_release(web_scene *scene);

#endif
