// SPDX-License-Identifier: MIT
#include "passes/pass_maps.h"

#include "options/options.h"
#include "passes/shader_list.h"

enum { FIRST = 3, TEXTURES = 4 }; // outputs of map.frag

static GLuint create_texture(GLenum format, uint32_t side)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, (GLsizei)side, (GLsizei)side);
    return texture;
}

int pass_maps_create(uint32_t side, pass_maps *pass)
{
    GLuint *const textures[TEXTURES] = {&pass->map.positions, &pass->map.normals, &pass->map.flux,
                                        &pass->map.albedos};
    GLenum outputs[FIRST + TEXTURES] = {GL_NONE, GL_NONE, GL_NONE};
    *pass = (pass_maps){.program = gl_program_create(&shader_surfaces_vert, &shader_map_frag),
                        .map = {.width = side, .height = side}};
    glCreateFramebuffers(1, &pass->frame);
    pass->depth = create_texture(GL_DEPTH_COMPONENT32F, side);
    glNamedFramebufferTexture(pass->frame, GL_DEPTH_ATTACHMENT, pass->depth, 0);
    for (GLenum i = 0; i < TEXTURES; i++) {
        *textures[i] = create_texture(GL_RGBA32F, side);
        glNamedFramebufferTexture(pass->frame, GL_COLOR_ATTACHMENT0 + i, *textures[i], 0);
        outputs[FIRST + i] = GL_COLOR_ATTACHMENT0 + i;
    }
    glNamedFramebufferDrawBuffers(pass->frame, FIRST + TEXTURES, outputs);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_maps_destroy(pass_maps *pass)
{
    if (pass->frame != 0) {
        const GLuint textures[] = {pass->map.positions, pass->map.normals, pass->map.flux,
                                   pass->map.albedos, pass->depth};
        glDeleteTextures(sizeof textures / sizeof *textures, textures);
        glDeleteFramebuffers(1, &pass->frame);
        glDeleteProgram(pass->program);
    }
    *pass = (pass_maps){0};
}

static void draw(const gl_scene *scene)
{
    gl_scene_bind(scene);
    gl_scene_draw(scene, GL_SCENE_ALL);
}

void pass_maps_draw(const pass_maps *pass, const gl_scene *scene, const gl_scene *object,
                    const gl_lights *lights, uint32_t light, bool metals_black,
                    const camera_view *view)
{
    static const GLfloat nothing[4], far = 0.0f;
    GLint front = GL_CCW; // another one where the picture is a mirror image
    glGetIntegerv(GL_FRONT_FACE, &front);
    glFrontFace(GL_CCW);
    glUseProgram(pass->program);
    glBindFramebuffer(GL_FRAMEBUFFER, pass->frame);
    for (GLint i = 0; i < TEXTURES; i++) {
        glClearNamedFramebufferfv(pass->frame, GL_COLOR, FIRST + i, nothing);
    }
    glClearNamedFramebufferfv(pass->frame, GL_DEPTH, 0, &far);
    glViewport(0, 0, (GLsizei)view->width, (GLsizei)view->height);
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    gl_lights_bind(lights);
    camera_view_bind(view);
    glUniform1ui(UNIFORM_MAP_LIGHT, light);
    glUniform1i(UNIFORM_METALS, metals_black);
    glUniform1i(UNIFORM_PEELED, 0);
    draw(scene);
    if (object != NULL) {
        draw(object);
    }
    glFrontFace((GLenum)front);
}
