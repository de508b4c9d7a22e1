// SPDX-License-Identifier: MIT
// Standard streams of a program, at its start and its end.
#ifndef COMMAND_STREAMS_H
#define COMMAND_STREAMS_H

/// Opens standard streams that are closed. Else the first file that is opened would get their
/// number, and messages would be written into it. Using the stream fails, and is reported as usual.
/// A file that gets too large becomes a failed write, not the end.
void streams_open(void);
/// Detects a full disk or a closed pipe. @return the exit code, EXIT_FAILED after a message
int streams_close(int code);

#endif
