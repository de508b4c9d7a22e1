// SPDX-License-Identifier: MIT
#include "picture.h"

/// Reads a target whose row 0 is the upper one.
static void read_target(GLuint frame, GLenum attachment, const gl_targets *t, GLenum format,
                        GLenum type, void *pixels)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame);
    glReadBuffer(attachment);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, (GLsizei)t->width, (GLsizei)t->height, format, type, pixels);
}

alp_result picture_read_light(alp_context *context, const gl_targets *t, alp_image **image)
{
    const alp_image_info info = {t->width, t->height, 4, ALP_COMPONENT_FLOAT};
    const alp_result result = alp_image_create(context, info, image);
    if (result == ALP_OK) {
        read_target(t->light_frame, GL_COLOR_ATTACHMENT0, t, GL_RGBA, GL_FLOAT,
                    alp_image_floats(*image));
    }
    return result;
}

alp_result picture_read_developed(alp_context *context, const gl_targets *t, alp_image **image)
{
    const alp_image_info info = {t->width, t->height, 3, ALP_COMPONENT_U8};
    const alp_result result = alp_image_create(context, info, image);
    if (result == ALP_OK) {
        read_target(t->developed_frame, GL_COLOR_ATTACHMENT0, t, GL_RGB, GL_UNSIGNED_BYTE,
                    alp_image_bytes(*image));
    }
    return result;
}

void picture_read_triangles(const gl_targets *t, uint32_t *triangles)
{
    read_target(t->opaque_frame, GL_COLOR_ATTACHMENT1, t, GL_RED_INTEGER, GL_UNSIGNED_INT,
                triangles);
}
