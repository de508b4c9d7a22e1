// SPDX-License-Identifier: MIT
#include "shader_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdio.h>
#include <stdlib.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

static EGLDisplay display = EGL_NO_DISPLAY;

static EGLDisplay find_display(void)
{
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    return get != NULL ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL)
                       : EGL_NO_DISPLAY;
}

bool shader_context_open(shader_language language)
{
    static const EGLint versions[SHADER_LANGUAGES][5] = {
        {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE},
        {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE}};
    static const EGLint wanted[SHADER_LANGUAGES][3] = {
        {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE},
        {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE}};
    const EGLenum api = language == SHADER_330 ? EGL_OPENGL_API : EGL_OPENGL_ES_API;
    EGLConfig config = NULL;
    EGLint count = 0;
    display = find_display();
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL) || !eglBindAPI(api) ||
        !eglChooseConfig(display, wanted[language], &config, 1, &count)) {
        fprintf(stderr, "there is no EGL display without a screen\n");
        return false;
    }
    EGLContext context = eglCreateContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR,
                                          EGL_NO_CONTEXT, versions[language]);
    if (context == EGL_NO_CONTEXT ||
        !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        fprintf(stderr, "there is no %s context\n", language == SHADER_330 ? "OpenGL 3.3" : "ES 3");
        return false;
    }
    return true;
}

void shader_context_close(void)
{
    EGLContext context = eglGetCurrentContext();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    eglTerminate(display);
}

static GLuint compile(GLenum kind, const char *const *parts, int count)
{
    const GLuint shader = glCreateShader(kind);
    char log[4096] = "";
    GLint good = 0;
    glShaderSource(shader, count, parts, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (good == 0 || log[0] != '\0') { // warnings too
        fprintf(stderr, "%s\n", log);
        exit(1);
    }
    return shader;
}

GLuint shader_program(shader_language language, const char *const *parts, int count)
{
    enum { MOST = 8 };
    const char *all[MOST] = {language == SHADER_330 ? "#version 330\n"
                                                    : "#version 300 es\nprecision highp float;\n"};
    const char *const corners[2] = {all[0],
                                    "void main() {\n"
                                    "  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                    "  gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);\n"
                                    "}\n"};
    GLint good = 0;
    for (int i = 0; i < count && i + 1 < MOST; i++) {
        all[i + 1] = parts[i];
    }
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, corners, 2));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, all, count + 1));
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) {
        fprintf(stderr, "the shaders do not link\n");
        exit(1);
    }
    glUseProgram(program);
    return program;
}

GLuint shader_texture(GLenum target, int unit)
{
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(target, texture);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

void shader_run(int width, float *rgba)
{
    GLuint frame = 0, array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    const GLuint target = shader_texture(GL_TEXTURE_2D, 7);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, 1, 0, GL_RGBA, GL_FLOAT, NULL);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glViewport(0, 0, width, 1);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, width, 1, GL_RGBA, GL_FLOAT, rgba);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE ||
        glGetError() != GL_NO_ERROR) {
        fprintf(stderr, "the shader does not run\n");
        exit(1);
    }
    glDeleteTextures(1, &target);
    glDeleteFramebuffers(1, &frame);
    glDeleteVertexArrays(1, &array);
}
