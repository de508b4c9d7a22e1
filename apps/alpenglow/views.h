// SPDX-License-Identifier: MIT
// Sizes, folders and rows of pictures.
#ifndef COMMAND_VIEWS_H
#define COMMAND_VIEWS_H

#include "options/options.h"

#include <alpenglow/image.h>

/// --resolution, "960x540". @return EXIT_DONE, or EXIT_USAGE after a message
int resolution_read(const command_line *arguments, uint32_t *width, uint32_t *height);

/// Makes the folder of --pictures if it is missing. @return EXIT_DONE, or EXIT_FAILED and a message
int pictures_folder(const char *folder);
/// "FOLDER/NAME.png"; malloc'ed.
char *pictures_path(const char *folder, const char *name);

/// Joins float RGBA images of equal size side by side.
/// @param images [count]   @param joined out, which the caller destroys
/// @return as alp_image_create
alp_result images_join(alp_context *context, alp_image *const *images, uint32_t count,
                       alp_image **joined);

#endif
