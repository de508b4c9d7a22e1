// SPDX-License-Identifier: MIT
// The pictures of --pictures.
#ifndef COMMAND_PICTURES_H
#define COMMAND_PICTURES_H

#include "session.h"

#include <jansson.h>

/// Writes the pictures of a diagnosis into the folder of --pictures, which is made if missing. Does
/// nothing without the option.
/// @param paths out: [path]; the caller's, also after a failure
/// @return EXIT_DONE, or EXIT_FAILED after a message
int pictures_write(session *s, const alp_diagnosis *diagnosis, const command_line *arguments,
                   json_t **paths);

#endif
