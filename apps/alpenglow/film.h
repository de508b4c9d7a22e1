// SPDX-License-Identifier: MIT
// The options that say how a picture is shown: --exposure, --tone and --white-balance.
#ifndef COMMAND_FILM_H
#define COMMAND_FILM_H

#include "session.h"

/// Refuses them for an output that holds linear values, where none has a meaning.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int film_refuse(const command_line *arguments, const char *output);

/// How the picture is shown: as is best for the method, unless something else is asked for.
alp_film_options film_read(const command_line *arguments, alp_render_method method);

#endif
