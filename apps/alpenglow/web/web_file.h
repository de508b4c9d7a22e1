// SPDX-License-Identifier: MIT
// Files that alpenglow web reads, and their faults.
#ifndef COMMAND_WEB_FILE_H
#define COMMAND_WEB_FILE_H

#include <stddef.h>

/// The bytes of an ordinary file and a 0 after them, malloc'ed. NULL with errno: EFBIG above 400
/// MB.
char *web_read_bytes(const char *path, size_t *size);
/// The same. NULL after a message.
char *web_read_file(const char *path, size_t *size);
/// The text of an errno of web_read_bytes.
const char *web_reason(int number);
/// Prints a fault of a file. @return EXIT_FAILED
int web_fail(const char *path, const char *text);
/// Decodes %20 and the like in place.
void web_decode_address(char *text);

#endif
