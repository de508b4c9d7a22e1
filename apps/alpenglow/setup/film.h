// SPDX-License-Identifier: MIT
// Options of development: --exposure, --tone and --white-balance.
#ifndef COMMAND_FILM_H
#define COMMAND_FILM_H

#include "session.h"

/// Refuses them for an output of linear values.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int film_refuse(const command_line *arguments, const char *output);

/// Film options: defaults of the method, changed by the arguments.
alp_film_options film_read(const command_line *arguments, alp_render_method method);

#endif
