// SPDX-License-Identifier: MIT
// Progress of long work, on standard error.
#ifndef COMMAND_PROGRESS_H
#define COMMAND_PROGRESS_H

#include <alpenglow/context.h>

/// In the order of the choices of --progress.
typedef enum progress_mode {
    PROGRESS_AUTO,  // one updating line on a terminal, else a line at intervals
    PROGRESS_PLAIN, // a line at every stage and at intervals
    PROGRESS_JSON,
    PROGRESS_OFF
} progress_mode;

typedef struct progress_display {
    progress_mode mode;
    bool terminal;   // AUTO: the line is written over
    bool line_open;  // the terminal's line holds text
    double interval; // seconds between two lines
    double last;     // time of the last line, seconds
    char stage[32];
} progress_display;

progress_display progress_start(progress_mode mode);
void progress_show(progress_display *progress, const alp_progress *state);
void progress_clear(progress_display *progress); ///< frees the terminal's line for other text

/// Seconds of a clock that never goes back.
double clock_seconds(void);

#endif
