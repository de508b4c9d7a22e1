// SPDX-License-Identifier: MIT
// Sizes and folders of pictures.
#ifndef COMMAND_VIEWS_H
#define COMMAND_VIEWS_H

#include "options/options.h"

/// --resolution, "960x540". @return EXIT_DONE, or EXIT_USAGE after a message
int resolution_read(const command_line *arguments, uint32_t *width, uint32_t *height);

/// Makes the folder of --pictures if it is missing. @return EXIT_DONE, or EXIT_FAILED and a message
int pictures_folder(const char *folder);
/// "FOLDER/NAME.png"; malloc'ed.
char *pictures_path(const char *folder, const char *name);

#endif
