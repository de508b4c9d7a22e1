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
/// Keeps SIGTERM and SIGUSR1 until interrupt_decide(), for a bake that may keep its work.
void interrupt_remember(void);
/// Makes SIGUSR1 a request to stop, as SIGTERM is, for a command that keeps its work. Until
/// interrupt_defer(), both then end the program at once with 75. One that was remembered takes
/// effect: without kept work, as if it came now to a program that has no handler of SIGUSR1.
void interrupt_decide(bool keeps_work);
bool interrupt_keeps_work(void);
/// Whether the request was SIGTERM or SIGUSR1, to a command that keeps its work.
bool interrupt_stops(void);

#endif
