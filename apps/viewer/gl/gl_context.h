// SPDX-License-Identifier: MIT
// OpenGL 4.5 without a window, by EGL.
#ifndef VIEWER_GL_CONTEXT_H
#define VIEWER_GL_CONTEXT_H

#include <stdbool.h>

/// A context of OpenGL. It must not move in memory. One at a time in a program.
typedef struct gl_context {
    void *display, *context, *surface; // of EGL; surface: NULL where none is needed
    char renderer[128];                // "llvmpipe (LLVM 15.0.6, 256 bits)"
    bool failed;                       // OpenGL has reported an error, and it was printed
} gl_context;

/// Makes a context and makes it current on this thread. Displays are tried in this order: devices
/// that are hardware, no surface at all, other devices, and the default display.
/// @return EXIT_DONE, or EXIT_FAILED after one line that names what was found
int gl_context_open(gl_context *context);
/// Also of a context that failed to open.
void gl_context_close(gl_context *context);

/// Whether OpenGL has reported no error so far. @return EXIT_DONE, or EXIT_FAILED after a message
int gl_context_check(gl_context *context);

#endif
