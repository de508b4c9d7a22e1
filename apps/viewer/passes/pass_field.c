// SPDX-License-Identifier: MIT
#include "passes/pass_field.h"

#include "field_points.h"
#include "options/options.h"
#include "passes/shader_list.h"
#include "printing/messages.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static const view_mode points_mode = {.fragment = &shader_points_frag, .uses = USES_PANES};

int pass_field_create(const gl_targets *t, pass_field *pass)
{
    const size_t pixels = (size_t)t->width * t->height;
    *pass = (pass_field){0};
    if (pixels > INT_MAX / sizeof *pass->position_picture) { // OpenGL counts bytes by an int
        return failure("--resolution: a field is read at 134217727 pixels at most; give fewer, or "
                       "--read vertex");
    }
    pass->position_picture = allocate_or_exit(NULL, pixels * sizeof *pass->position_picture);
    pass->normal_picture = allocate_or_exit(NULL, pixels * sizeof *pass->normal_picture);
    pass->positions = allocate_or_exit(NULL, pixels * sizeof *pass->positions);
    pass->normals = allocate_or_exit(NULL, pixels * sizeof *pass->normals);
    pass->irradiance = allocate_or_exit(NULL, pixels * sizeof *pass->irradiance);
    return pass_surfaces_create(&points_mode, false, &pass->points);
}

void pass_field_destroy(pass_field *pass)
{
    pass_surfaces_destroy(&pass->points);
    free(pass->position_picture);
    free(pass->normal_picture);
    free(pass->positions);
    free(pass->normals);
    free(pass->irradiance);
    *pass = (pass_field){0};
}

/// Gathers the pixels that show a surface. @return their number
static uint32_t pack(const pass_field *pass, uint32_t pixels)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pixels; i++) {
        if (pass->position_picture[i][3] > 0.0f) {
            memcpy(pass->positions[count], pass->position_picture[i], sizeof *pass->positions);
            memcpy(pass->normals[count++], pass->normal_picture[i], sizeof *pass->normals);
        }
    }
    return count;
}

/// Puts the light of these pixels where their positions were.
static void unpack(const pass_field *pass, uint32_t pixels)
{
    uint32_t from = 0;
    for (uint32_t i = 0; i < pixels; i++) {
        if (pass->position_picture[i][3] > 0.0f) {
            memcpy(pass->position_picture[i], pass->irradiance[from++], sizeof *pass->irradiance);
        }
    }
}

/// Looks the field up where the points were drawn.
static void read_points(const pass_field *pass, const gl_field *field, const gl_targets *t,
                        GLuint places, GLuint normals)
{
    const uint32_t pixels = t->width * t->height;
    const GLsizei size = (GLsizei)(pixels * sizeof *pass->position_picture);
    glGetTextureImage(places, 0, GL_RGBA, GL_FLOAT, size, pass->position_picture);
    glGetTextureImage(normals, 0, GL_RGBA, GL_FLOAT, size, pass->normal_picture);
    const uint32_t count = pack(pass, pixels);
    field_points_read(field->field, field->workers, count, (const float(*)[3])pass->positions,
                      (const float(*)[3])pass->normals, pass->irradiance);
    unpack(pass, pixels);
    glTextureSubImage2D(field->pixels, 0, 0, 0, (GLsizei)t->width, (GLsizei)t->height, GL_RGBA,
                        GL_FLOAT, pass->position_picture);
}

void pass_field_draw_opaque(const pass_field *pass, const gl_field *field, const gl_scene *scene,
                            const gl_scene *object, const camera_view *view, const gl_targets *t)
{
    pass_surfaces_draw_opaque(&pass->points, scene, NULL, view, t);
    if (object != NULL) {
        pass_surfaces_add_object(&pass->points, object, NULL, view, t);
    }
    read_points(pass, field, t, t->opaque_light, t->opaque_through);
}

bool pass_field_draw_panes(const pass_field *pass, const gl_field *field, const gl_scene *scene,
                           const camera_view *view, const gl_targets *t, uint32_t layer)
{
    if (!pass_surfaces_draw_panes(&pass->points, scene, NULL, view, t, layer)) {
        return false;
    }
    read_points(pass, field, t, t->layer_light, t->layer_through);
    return true;
}
