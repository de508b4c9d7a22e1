// SPDX-License-Identifier: MIT
#include "gl/gl_cube.h"

#include "options/options.h"
#include "passes/shader_list.h"
#include "shaders/bindings.h"

#include <math.h>
#include <string.h>

enum { FACES = 6, PART_ROWS = 8, VALUES = 27 };

int gl_cube_create(uint32_t side, gl_cube *cube)
{
    *cube = (gl_cube){.side = side, .parts = FACES * ((side + PART_ROWS - 1) / PART_ROWS)};
    cube->project = gl_program_create_compute(&shader_project_comp);
    cube->reduce = gl_program_create_compute(&shader_reduce_comp);
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &cube->faces);
    glTextureStorage3D(cube->faces, 1, GL_RGBA32F, (GLsizei)side, (GLsizei)side, FACES);
    glCreateBuffers(1, &cube->part_sums);
    glCreateBuffers(1, &cube->sums);
    glNamedBufferStorage(cube->part_sums, (GLsizeiptr)(cube->parts * VALUES * sizeof(float)), NULL,
                         0);
    glNamedBufferStorage(cube->sums, VALUES * sizeof(float), NULL, 0);
    return cube->project != 0 && cube->reduce != 0 ? EXIT_DONE : EXIT_FAILED;
}

void gl_cube_destroy(gl_cube *cube)
{
    if (cube->faces != 0) { // else there may be no context either
        glDeleteProgram(cube->project);
        glDeleteProgram(cube->reduce);
        glDeleteTextures(1, &cube->faces);
        glDeleteBuffers(1, &cube->part_sums);
        glDeleteBuffers(1, &cube->sums);
    }
    *cube = (gl_cube){0};
}

/// The view of a face. Seen from inside, faces are mirror images.
static camera_view view_of_face(const float point[3], int face, uint32_t side,
                                const alp_scene_info *info)
{
    static const float axes[FACES][3][3] = {
        // forward, right and up
        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
    alp_camera camera = {.target = {0.0f, 0.0f, -1.0f},
                         .up = {0.0f, 1.0f, 0.0f},
                         .vertical_fov = (float)(0.5 * M_PI)};
    camera_view view = camera_view_of(&camera, side, side, info);
    memcpy(view.origin, point, sizeof view.origin);
    memcpy(view.forward, axes[face][0], sizeof view.forward);
    memcpy(view.right, axes[face][1], sizeof view.right);
    memcpy(view.up, axes[face][2], sizeof view.up);
    return view;
}

void gl_cube_draw(const gl_cube *cube, drawing *d, const float point[3])
{
    const alp_scene_info info = alp_scene_get_info(d->scene);
    const GLsizei side = (GLsizei)cube->side;
    const float everywhere[3] = {0.0f, 0.0f, 0.0f};
    drawing_light(d, point, everywhere, NULL); // once for all faces
    glFrontFace(GL_CW);                        // of mirror images
    for (int face = 0; face < FACES; face++) {
        const camera_view view = view_of_face(point, face, cube->side, &info);
        drawing_draw_view(d, &view);
        glCopyImageSubData(d->targets.light, GL_TEXTURE_2D, 0, 0, 0, 0, cube->faces,
                           GL_TEXTURE_2D_ARRAY, 0, 0, 0, face, side, side, 1);
    }
    glFrontFace(GL_CCW);
}

void gl_cube_project(const gl_cube *cube, alp_sh9 *radiance)
{
    glBindTextureUnit(TEXTURE_PICTURE, cube->faces);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_SH_PARTS, cube->part_sums);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_SH, cube->sums);
    glUseProgram(cube->project);
    glDispatchCompute(cube->parts / FACES, FACES, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(cube->reduce);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(cube->sums, 0, sizeof radiance->c, radiance->c);
}
