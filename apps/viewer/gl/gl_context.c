// SPDX-License-Identifier: MIT
#include "gl/gl_context.h"

#include "options/options.h"
#include "printing/messages.h"
#include "shaders/bindings.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

enum { DEVICE_LIMIT = 32, DISPLAY_LIMIT = 2 * DEVICE_LIMIT, LINE_SIZE = 640 };

/// A limit of OpenGL that is too low on some cards.
typedef struct gl_limit {
    GLenum name;
    GLint need;
    const char *text;
} gl_limit;
static const gl_limit limits[] = {
    {GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, BLOCKS_VERTEX, "storage blocks of vertex shaders"},
    {GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, BLOCKS_FRAGMENT, "storage blocks of fragment shaders"},
    {GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS, BLOCKS_VERTEX + BLOCKS_FRAGMENT,
     "storage blocks of a program"},
    {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, BUFFERS, "bindings of storage buffers"}};

// --- displays ------------------------------------------------------------------------------------

static bool has_word(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = words; at != NULL && (at = strstr(at, word)) != NULL; at += length) {
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

/// Displays of devices. @return the number of them
static int list_devices(const char *client, bool hardware, EGLDisplay *displays, int room)
{
    EGLDeviceEXT devices[DEVICE_LIMIT];
    EGLint count = 0;
    int listed = 0;
    if (!has_word(client, "EGL_EXT_device_enumeration") ||
        !has_word(client, "EGL_EXT_platform_device") ||
        !eglQueryDevicesEXT(DEVICE_LIMIT, devices, &count)) {
        return 0;
    }
    for (EGLint i = 0; i < count && listed < room; i++) {
        const char *words = has_word(client, "EGL_EXT_device_query")
                                ? eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS)
                                : NULL;
        if (has_word(words, "EGL_MESA_device_software") != hardware) {
            displays[listed++] =
                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
        }
    }
    return listed;
}

static int list_displays(EGLDisplay displays[DISPLAY_LIMIT + 2])
{
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    int count = list_devices(client, true, displays, DEVICE_LIMIT);
    if (has_word(client, "EGL_MESA_platform_surfaceless")) {
        displays[count++] =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    }
    count += list_devices(client, false, displays + count, DEVICE_LIMIT);
    displays[count++] = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    return count;
}

// --- contexts ------------------------------------------------------------------------------------

static EGLConfig choose_config(EGLDisplay display, bool surface)
{
    const EGLint wanted[] = {EGL_SURFACE_TYPE, surface ? EGL_PBUFFER_BIT : EGL_DONT_CARE,
                             EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    return eglChooseConfig(display, wanted, &config, 1, &count) && count > 0 ? config
                                                                             : EGL_NO_CONFIG_KHR;
}

/// Makes a context of an initialised display current.
/// @param version the attributes of the context
static bool make_current(gl_context *c, const EGLint *version)
{
    const EGLint tiny[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    const char *words = eglQueryString(c->display, EGL_EXTENSIONS);
    const bool surface = !has_word(words, "EGL_KHR_surfaceless_context");
    EGLConfig config = choose_config(c->display, surface);
    if (config == EGL_NO_CONFIG_KHR && !has_word(words, "EGL_KHR_no_config_context")) {
        return false;
    }
    c->context = eglCreateContext(c->display, config, EGL_NO_CONTEXT, version);
    c->surface = c->context != EGL_NO_CONTEXT && surface
                     ? eglCreatePbufferSurface(c->display, config, tiny)
                     : EGL_NO_SURFACE;
    return c->context != EGL_NO_CONTEXT &&
           eglMakeCurrent(c->display, c->surface, c->surface, c->context);
}

static void drop_context(gl_context *c)
{
    eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (c->surface != EGL_NO_SURFACE) {
        eglDestroySurface(c->display, c->surface);
    }
    if (c->context != EGL_NO_CONTEXT) {
        eglDestroyContext(c->display, c->context);
    }
    c->surface = c->context = NULL;
}

/// Describes what a display has instead of OpenGL 4.5.
static void describe(gl_context *c, char *text, size_t size)
{
    const EGLint any[] = {EGL_NONE};
    if (make_current(c, any)) {
        snprintf(text, size, "%s, %s, OpenGL %s", (const char *)glGetString(GL_VENDOR),
                 (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
    } else {
        snprintf(text, size, "%s, EGL %s without OpenGL", eglQueryString(c->display, EGL_VENDOR),
                 eglQueryString(c->display, EGL_VERSION));
    }
    drop_context(c);
}

/// The first limit of the current context that is too low, or NULL. @param has out: its value
static const gl_limit *find_low_limit(GLint *has)
{
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        glGetIntegerv(limits[i].name, has);
        if (*has < limits[i].need) {
            return &limits[i];
        }
    }
    return NULL;
}

/// @param found out: what a display without OpenGL 4.5 has instead; else unchanged
static bool open_display(gl_context *c, char found[LINE_SIZE])
{
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             4,
                             EGL_CONTEXT_MINOR_VERSION,
                             5,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_CONTEXT_OPENGL_DEBUG,
                             EGL_TRUE,
                             EGL_NONE};
    const gl_limit *low = NULL;
    GLint has = 0;
    if (c->display == EGL_NO_DISPLAY || !eglInitialize(c->display, NULL, NULL)) {
        return false;
    }
    if (eglBindAPI(EGL_OPENGL_API) && make_current(c, wanted)) {
        low = find_low_limit(&has);
        if (epoxy_gl_version() >= 45 && low == NULL) {
            return true;
        }
    }
    drop_context(c);
    if (found[0] == '\0') {
        describe(c, found, LINE_SIZE);
        if (low != NULL) {
            const size_t length = strlen(found);
            snprintf(found + length, LINE_SIZE - length, ", which has %d %s, and %d are needed",
                     has, low->text, low->need);
        }
    }
    eglTerminate(c->display);
    return false;
}

// --- errors --------------------------------------------------------------------------------------

/// A GLDEBUGPROC, whose `user` is a gl_context.
static void GLAPIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                  GLsizei length, const GLchar *text, const void *user)
{
    (void)id, (void)severity, (void)length;
    // Faults of shaders are printed with their file and line by gl_program_create.
    if (type == GL_DEBUG_TYPE_ERROR && source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
        gl_context *c = NULL;
        memcpy(&c, &user, sizeof c); // it is ours to change
        c->failed = true;
        fputs("alpenglow: OpenGL: ", stderr);
        print_clean(stderr, text);
        fputc('\n', stderr);
    }
}

int gl_context_check(gl_context *c)
{
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR && !c->failed) { // a driver that sends no messages
        c->failed = true;
        fprintf(stderr, "alpenglow: OpenGL: error 0x%x\n", error);
    }
    return c->failed ? EXIT_FAILED : EXIT_DONE;
}

// --- the whole -----------------------------------------------------------------------------------

/// Whether libepoxy finds a library: it ends the program where it does not.
static bool has_library(const char *name)
{
    void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library != NULL) {
        dlclose(library);
    }
    return library != NULL;
}

int gl_context_open(gl_context *c)
{
    *c = (gl_context){0};
    if (!has_library("libEGL.so.1")) {
        return failure("there is no EGL (libEGL.so.1); install libegl1, and libegl-mesa0 or the "
                       "driver of the graphics card");
    }
    if (!has_library("libOpenGL.so.0") && !has_library("libGL.so.1")) {
        return failure("there is no OpenGL (libOpenGL.so.0 or libGL.so.1); install libopengl0");
    }
    EGLDisplay displays[DISPLAY_LIMIT + 2];
    char found[LINE_SIZE] = "", text[LINE_SIZE + 160];
    const int count = list_displays(displays);
    for (int i = 0; i < count; i++) {
        c->display = displays[i];
        if (open_display(c, found)) {
            snprintf(c->renderer, sizeof c->renderer, "%s", (const char *)glGetString(GL_RENDERER));
            glEnable(GL_DEBUG_OUTPUT);
            glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            glDebugMessageCallback(on_message, c);
            return EXIT_DONE;
        }
    }
    c->display = NULL;
    snprintf(text, sizeof text,
             found[0] != '\0' ? "OpenGL 4.5 is needed; found %s"
                              : "EGL has no display that works%s; install libegl-mesa0 and "
                                "libgl1-mesa-dri, or the driver of the graphics card",
             found);
    return failure(text);
}

void gl_context_close(gl_context *c)
{
    if (c->display != NULL) {
        drop_context(c);
        eglTerminate(c->display);
        eglReleaseThread();
    }
    *c = (gl_context){0};
}
