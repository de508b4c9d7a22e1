// SPDX-License-Identifier: MIT
// Session of a command that loads a scene: context, messages, progress, exit code.
#ifndef COMMAND_SESSION_H
#define COMMAND_SESSION_H

#include "options/options.h"
#include "printing/messages.h"
#include "printing/progress.h"

#include <alpenglow/alpenglow.h>

typedef struct session {
    alp_context *context;
    alp_scene *scene; // NULL until session_load
    message_log messages;
    progress_display progress;
    bool warnings_as_errors;
    bool has_written; // some files, before the end
    double load_seconds;
} session;

/// The processes that run a command together.
typedef struct session_ranks {
    const alp_ranks *ranks; // NULL: this one alone
    const char *max_isa;    // highest instruction set that all have, or NULL: they have the same
    int (*meet)(int code);  // after loading. @return code, or that of another rank, which failed
} session_ranks;
/// Sets them for all sessions that follow. Copied.
void session_set_ranks(const session_ranks *ranks);
/// Whether this process prints and writes files: rank 0 does.
bool session_writes(void);
/// Waits until all ranks have come so far. @return code, or that of another rank, which failed
int session_meet(int code);

/// Makes the context of the arguments. `s` must not move in memory.
/// @return EXIT_DONE, or EXIT_FAILED after a message; session_close in both cases
int session_open(session *s, const command_line *arguments);
/// Loads operand 0, or its scene of --scene, in the pose of --animation-time.
/// @return EXIT_DONE, or an exit code after a message
int session_load(session *s, const command_line *arguments);
void session_close(session *s);

/// An alp_progress_fn; `user` is a session. False on Ctrl-C, and on a warning that is an error.
bool session_progress(void *user, const alp_progress *state);

/// Prints a warning of the command itself, which counts like one of the library.
void session_warn(session *s, const char *code, const char *object, const char *text);

/// Prints the message of a failed call. @return the exit code of the result
int session_end(session *s, alp_result result);

/// Whether a warning makes the command fail; prints a message if so.
int session_judge_warnings(const session *s);

/// The --ao-… options. @return EXIT_DONE, or EXIT_USAGE after a message
int occlusion_read(const command_line *arguments, alp_occlusion_options *options);

#endif
