// SPDX-License-Identifier: MIT
#include "gl/gl_buffer.h"

#include "options/options.h"
#include "printing/messages.h"

#include <stdio.h>

/// Bytes that any element fits in.
enum { LEAST_SIZE = 128 };

int gl_buffer_load(const char *what, const void *data, size_t size, GLuint *buffer)
{
    static const unsigned char nothing[LEAST_SIZE];
    GLint64 most = 0;
    *buffer = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (size > (size_t)most) {
        char text[192];
        snprintf(text, sizeof text,
                 "%s needs a buffer of %zu bytes, and the graphics card takes %lld", what, size,
                 (long long)most);
        return failure(text);
    }
    glCreateBuffers(1, buffer);
    glNamedBufferStorage(*buffer, (GLsizeiptr)(size > 0 ? size : LEAST_SIZE),
                         size > 0 ? data : nothing, data == NULL ? GL_DYNAMIC_STORAGE_BIT : 0);
    return EXIT_DONE;
}
