// SPDX-License-Identifier: MIT
// Ctrl-C and SIGTERM: end at once, or ask long work to stop.
#ifndef COMMAND_INTERRUPT_H
#define COMMAND_INTERRUPT_H

#include <stdbool.h>

/// From now on SIGINT and SIGTERM end the program at once with 130.
void interrupt_install(void);
/// From now on the first one only makes interrupt_asked() true; the second ends at once.
void interrupt_defer(void);
bool interrupt_asked(void);

#endif
