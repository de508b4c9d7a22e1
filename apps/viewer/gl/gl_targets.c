// SPDX-License-Identifier: MIT
#include "gl/gl_targets.h"

#include "options/options.h"
#include "printing/messages.h"

#include <stdbool.h>

static GLuint make_target(GLenum format, const gl_targets *t)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, (GLsizei)t->width, (GLsizei)t->height);
    return texture;
}

/// A frame of up to three colours. @param depth 0 = none
static GLuint make_frame(const GLuint *colors, int count, GLuint depth)
{
    static const GLenum drawn[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                   GL_COLOR_ATTACHMENT2};
    GLuint frame = 0;
    glCreateFramebuffers(1, &frame);
    for (int i = 0; i < count; i++) {
        glNamedFramebufferTexture(frame, drawn[i], colors[i], 0);
    }
    if (depth != 0) {
        glNamedFramebufferTexture(frame, GL_DEPTH_ATTACHMENT, depth, 0);
    }
    glNamedFramebufferDrawBuffers(frame, count, drawn);
    return frame;
}

static void make_textures(gl_targets *t)
{
    t->layer_light = make_target(GL_RGBA32F, t);
    t->layer_through = make_target(GL_RGBA32F, t);
    t->triangles = make_target(GL_R32UI, t);
    t->opaque_light = make_target(GL_RGBA32F, t);
    t->opaque_through = make_target(GL_RGBA32F, t);
    t->opaque_depth = make_target(GL_DEPTH_COMPONENT32F, t);
    t->sum = make_target(GL_RGBA32F, t);
    t->light = make_target(GL_RGBA32F, t);
    t->developed = make_target(GL_RGBA8, t);
    for (int i = 0; i < 2; i++) {
        t->depths[i] = make_target(GL_DEPTH_COMPONENT32F, t);
        t->lefts[i] = make_target(GL_RGBA32F, t);
    }
}

/// @return whether all can be drawn into
static bool make_frames(gl_targets *t)
{
    const GLuint opaque[] = {t->opaque_light, t->triangles, t->opaque_through};
    const GLuint layer[] = {t->layer_light, t->triangles, t->layer_through};
    t->opaque_frame = make_frame(opaque, 3, t->opaque_depth);
    for (int i = 0; i < 2; i++) {
        t->layer_frames[i] = make_frame(layer, 3, t->depths[i]);
        t->sum_frames[i] = make_frame((const GLuint[]){t->sum, t->lefts[i]}, 2, 0);
    }
    t->light_frame = make_frame(&t->light, 1, 0);
    t->developed_frame = make_frame(&t->developed, 1, 0);
    const GLuint all[] = {t->opaque_frame,   t->layer_frames[0], t->layer_frames[1],
                          t->sum_frames[0],  t->sum_frames[1],   t->light_frame,
                          t->developed_frame};
    bool complete = true;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        complete = complete &&
                   glCheckNamedFramebufferStatus(all[i], GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }
    return complete;
}

int gl_targets_create(uint32_t width, uint32_t height, gl_targets *t)
{
    GLint most = 0;
    char text[128];
    *t = (gl_targets){.width = width, .height = height};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (width > (uint32_t)most || height > (uint32_t)most) {
        snprintf(text, sizeof text,
                 "--resolution %ux%u: the graphics card takes sides of up to %d pixels", width,
                 height, most);
        return failure(text);
    }
    make_textures(t);
    return make_frames(t) ? EXIT_DONE
                          : failure("the graphics card cannot draw into pictures of this size");
}

void gl_targets_destroy(gl_targets *t)
{
    const GLuint textures[] = {t->layer_light, t->layer_through, t->triangles,    t->depths[0],
                               t->depths[1],   t->sum,           t->lefts[0],     t->lefts[1],
                               t->light,       t->developed,     t->opaque_light, t->opaque_through,
                               t->opaque_depth};
    const GLuint frames[] = {t->opaque_frame,   t->layer_frames[0], t->layer_frames[1],
                             t->sum_frames[0],  t->sum_frames[1],   t->light_frame,
                             t->developed_frame};
    if (t->width > 0) {
        glDeleteTextures(sizeof textures / sizeof *textures, textures);
        glDeleteFramebuffers(sizeof frames / sizeof *frames, frames);
    }
    *t = (gl_targets){0};
}

void gl_targets_bind(const gl_targets *t, GLuint frame)
{
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glViewport(0, 0, (GLsizei)t->width, (GLsizei)t->height);
}
