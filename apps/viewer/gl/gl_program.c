// SPDX-License-Identifier: MIT
#include "gl/gl_program.h"

#include "printing/messages.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOG_SIZE = 4096 };

/// Prints a line of a compiler's log. "2:14" becomes "surface.glsl:14"; Mesa writes that, and
/// NVIDIA "2(14)".
static void print_line(const gl_shader *shader, const char *line, size_t length)
{
    char *end = NULL;
    const unsigned long file = strtoul(line, &end, 10);
    if (end != line && (*end == ':' || *end == '(') && file < shader->file_count) {
        const unsigned long number = strtoul(end + 1, &end, 10);
        end += *end == ')' ? 1 : 0;
        fprintf(stderr, "alpenglow: %s:%lu%.*s\n", shader->files[file], number,
                (int)(length - (size_t)(end - line)), end);
    } else {
        fprintf(stderr, "alpenglow: %s: %.*s\n", shader->files[0], (int)length, line);
    }
}

static void print_log(const gl_shader *shader, const char *log)
{
    for (const char *line = log; *line != '\0';) {
        const size_t length = strcspn(line, "\n");
        if (length > 0) {
            print_line(shader, line, length);
        }
        line += length + (line[length] == '\n' ? 1 : 0);
    }
}

/// @return 0 after a message
static GLuint compile(GLenum kind, const gl_shader *shader)
{
    char log[LOG_SIZE] = "";
    GLint good = 0;
    const GLuint compiled = glCreateShader(kind);
    glShaderSource(compiled, 1, &shader->text, NULL);
    glCompileShader(compiled);
    glGetShaderiv(compiled, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        glGetShaderInfoLog(compiled, LOG_SIZE, NULL, log);
        print_log(shader, log[0] != '\0' ? log : "does not compile");
        glDeleteShader(compiled);
        return 0;
    }
    return compiled;
}

static bool link_program(GLuint program, const gl_shader *shader)
{
    char log[LOG_SIZE] = "";
    GLint good = 0;
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) {
        glGetProgramInfoLog(program, LOG_SIZE, NULL, log);
        print_log(shader, log[0] != '\0' ? log : "does not link");
    }
    return good != 0;
}

GLuint gl_program_create_compute(const gl_shader *shader)
{
    const GLuint compiled = compile(GL_COMPUTE_SHADER, shader);
    GLuint program = 0;
    if (compiled != 0) {
        program = glCreateProgram();
        glAttachShader(program, compiled);
        if (!link_program(program, shader)) {
            glDeleteProgram(program);
            program = 0;
        }
    }
    glDeleteShader(compiled);
    return program;
}

GLuint gl_program_create(const gl_shader *vertex, const gl_shader *fragment)
{
    const GLuint first = compile(GL_VERTEX_SHADER, vertex);
    const GLuint second = first != 0 ? compile(GL_FRAGMENT_SHADER, fragment) : 0;
    GLuint program = 0;
    if (second != 0) {
        program = glCreateProgram();
        glAttachShader(program, first);
        glAttachShader(program, second);
        if (!link_program(program, fragment)) {
            glDeleteProgram(program);
            program = 0;
        }
    }
    glDeleteShader(first); // 0 does nothing
    glDeleteShader(second);
    return program;
}
