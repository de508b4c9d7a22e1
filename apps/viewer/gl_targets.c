// SPDX-License-Identifier: MIT
#include "gl_targets.h"

#include "messages.h"
#include "options/options.h"

#include <stdbool.h>

static GLuint make_target(GLenum format, const gl_targets *t)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, (GLsizei)t->width, (GLsizei)t->height);
    return texture;
}

static bool is_complete(GLuint frame)
{
    return glCheckNamedFramebufferStatus(frame, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

int gl_targets_create(uint32_t width, uint32_t height, gl_targets *t)
{
    static const GLenum drawn[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
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
    t->light = make_target(GL_RGBA32F, t);
    t->triangles = make_target(GL_R32UI, t);
    t->depth = make_target(GL_DEPTH_COMPONENT32F, t);
    t->developed = make_target(GL_RGBA8, t);
    glCreateFramebuffers(1, &t->light_frame);
    glNamedFramebufferTexture(t->light_frame, GL_COLOR_ATTACHMENT0, t->light, 0);
    glNamedFramebufferTexture(t->light_frame, GL_COLOR_ATTACHMENT1, t->triangles, 0);
    glNamedFramebufferTexture(t->light_frame, GL_DEPTH_ATTACHMENT, t->depth, 0);
    glNamedFramebufferDrawBuffers(t->light_frame, 2, drawn);
    glCreateFramebuffers(1, &t->developed_frame);
    glNamedFramebufferTexture(t->developed_frame, GL_COLOR_ATTACHMENT0, t->developed, 0);
    return is_complete(t->light_frame) && is_complete(t->developed_frame)
               ? EXIT_DONE
               : failure("the graphics card cannot draw into pictures of this size");
}

void gl_targets_destroy(gl_targets *t)
{
    const GLuint textures[] = {t->light, t->triangles, t->depth, t->developed};
    const GLuint frames[] = {t->light_frame, t->developed_frame};
    glDeleteTextures(sizeof textures / sizeof *textures, textures);
    glDeleteFramebuffers(sizeof frames / sizeof *frames, frames);
    *t = (gl_targets){0};
}
