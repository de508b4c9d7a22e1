// SPDX-License-Identifier: MIT
// The commands, one cmd_NAME.c each. They return an exit code.
#ifndef COMMAND_COMMANDS_H
#define COMMAND_COMMANDS_H

#include "options/options.h"

int command_bake(const command_line *arguments);
int command_render(const command_line *arguments);
int command_info(const command_line *arguments);
int command_compare(const command_line *arguments);
int command_sample(const command_line *arguments);
int command_probes(const command_line *arguments);
int command_ambience(const command_line *arguments);
int command_lpv(const command_line *arguments);
int command_sh(const command_line *arguments);
int command_bench(const command_line *arguments);
int command_status(const command_line *arguments);
int command_merge(const command_line *arguments);
int command_web(const command_line *arguments);
int command_view(const command_line *arguments);

#endif
