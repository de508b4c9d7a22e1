// SPDX-License-Identifier: MIT
#include "divider.h"

#include "picture.h"

uint32_t divider_column(double share, uint32_t width)
{
    return (uint32_t)(share * (double)(width - 1) + 0.5);
}

/// Copies the light of the columns behind the line.
static void join(const gl_targets *left, const gl_targets *right, uint32_t column)
{
    const GLint first = (GLint)column + 1, width = (GLint)left->width - first;
    if (width > 0) {
        glCopyImageSubData(right->light, GL_TEXTURE_2D, 0, first, 0, 0, left->light, GL_TEXTURE_2D,
                           0, first, 0, 0, width, (GLsizei)left->height, 1);
    }
}

/// Fills the column of the line.
static void draw_line(GLuint frame, const GLfloat color[4], uint32_t column, uint32_t height)
{
    glScissor((GLint)column, 0, 1, (GLsizei)height);
    glEnable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(frame, GL_COLOR, 0, color);
    glDisable(GL_SCISSOR_TEST);
}

alp_result divider_develop(const drawing *left, const drawing *right, uint32_t column,
                           alp_context *context, alp_film_options *film, alp_image **developed,
                           alp_image **light)
{
    static const GLfloat white[4] = {1.0f, 1.0f, 1.0f, 1.0f}, nothing[4];
    const gl_targets *t = &left->targets;
    alp_film_numbers numbers;
    alp_image *metered = NULL;
    *developed = NULL;
    alp_result result = picture_read_light(context, t, &metered);
    if (result == ALP_OK) {
        result = alp_film_resolve(metered, film, &numbers);
    }
    alp_image_destroy(metered);
    if (result == ALP_OK) {
        join(t, &right->targets, column);
        draw_line(t->light_frame, nothing, column, t->height);
        pass_film_draw(&left->film, film, &numbers, t);
        draw_line(t->developed_frame, white, column, t->height);
        film->exposure = numbers.exposure;
        result = picture_read_developed(context, t, developed);
    }
    if (result == ALP_OK && light != NULL) {
        result = picture_read_light(context, t, light);
    }
    return result;
}
