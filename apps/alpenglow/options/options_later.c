// SPDX-License-Identifier: MIT
// Rows of the table of options: options of the contract that are not built yet.
#include "options/option_parts.h"

#define LATER(commands_, name_, value_, instead_)                                                  \
    {                                                                                              \
        .id = OPTION_LATER, .commands = (commands_), .group = GROUP_LATER, .kind = KIND_TEXT,      \
        .name = (name_), .value = (value_), .help = (instead_)                                     \
    }

static const option rows[] = {
    LATER(IN_PROBES, "--split", "rooms", "the look-up's visibility keeps light in its room"),
};

const option_part option_part_later = {rows, sizeof rows / sizeof *rows};
