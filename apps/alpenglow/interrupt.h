// SPDX-License-Identifier: MIT
// Ctrl-C and SIGTERM: end at once, or cancel long work.
#ifndef COMMAND_INTERRUPT_H
#define COMMAND_INTERRUPT_H

#include <stdbool.h>

/// Sets SIGINT and SIGTERM to end the program at once with 130.
void interrupt_install(void);
/// Sets the first signal to make interrupt_asked() true, and the second to end at once.
void interrupt_defer(void);
bool interrupt_asked(void);
/// Makes SIGUSR1 a request to stop, as SIGTERM is, for a command that keeps its work.
void interrupt_keep_work(void);
bool interrupt_keeps_work(void);
/// Whether the request was SIGTERM or SIGUSR1, to a command that keeps its work.
bool interrupt_stops(void);

#endif
