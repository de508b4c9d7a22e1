// SPDX-License-Identifier: MIT
// The options of alpenglow bake, and its summary.
#ifndef COMMAND_BAKE_OPTIONS_H
#define COMMAND_BAKE_OPTIONS_H

#include "options/options.h"
#include "session.h"
#include "setup/lamps.h"

#include <alpenglow/alpenglow.h>

/// Reads all options, and refuses those that exclude each other.
/// @param lamps borrowed by the options; the caller releases them, also after a failure
/// @return EXIT_DONE, or an exit code after a message
int bake_options_read(const command_line *a, alp_bake_options *o, lamp_list *lamps);

void bake_summary_print(const session *s, const command_line *a, const alp_lightmap *lightmap,
                        const alp_bake_options *o, const alp_bake_report *r);

#endif
