// SPDX-License-Identifier: MIT
// The lights of a file and of the user, in one list.
#ifndef ALPI_SCENE_LIGHTING_LIST_H
#define ALPI_SCENE_LIGHTING_LIST_H

#include "scene/scene.h"

#include <alpenglow/light.h>

enum { ALPI_LAMP_NAME_SIZE = 16 }; // "lamp 4294967295"

typedef struct alpi_light_list {
    alpi_light *lights; // [count] the file's first, then lamps and sun of the options; names of the
                        // file's are borrowed
    uint32_t count;
    char (*lamp_names)[ALPI_LAMP_NAME_SIZE]; // [lamps of the options]; NULL = none
    char *sun_name;                          // NULL = none
} alpi_light_list;

/// Fills a list that is all zero. Warns ("light") of lights of a scene made by hand that hold what
/// readers refuse; they give nothing.
/// @return ALP_OK; OUT_OF_MEMORY. On failure too the caller clears
alp_result alpi_light_list_gather(const alp_scene *scene, const alp_lighting_options *options,
                                  alpi_light_list *list);
void alpi_light_list_clear(alp_context *context, alpi_light_list *list);

#endif
