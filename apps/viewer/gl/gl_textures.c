// SPDX-License-Identifier: MIT
#include "gl/gl_textures.h"

#include "options/options.h"
#include "printing/messages.h"

#include <math.h>
#include <stdlib.h>

enum { CHANNELS = 4 };

/// One component as a float in [0, 1], or as it is.
static float component(const void *pixels, bool floats, size_t index)
{
    return floats ? ((const float *)pixels)[index] : (float)((const uint8_t *)pixels)[index];
}

static float decode(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Spreads a pixel to RGBA. @param most the value that stands for 1
static void spread(const float in[CHANNELS], uint32_t channels, float most, float out[CHANNELS])
{
    const bool grey = channels <= 2;
    for (uint32_t k = 0; k < 3; k++) {
        out[k] = in[grey ? 0 : k];
    }
    out[3] = channels == 2 ? in[1] : channels == 4 ? in[3] : most;
}

/// Floats have no sRGB format: they are decoded here.
static void fill(const alp_image *image, bool srgb, void *out)
{
    const alp_image_info info = alp_image_get_info(image);
    const bool floats = info.component == ALP_COMPONENT_FLOAT;
    const void *pixels = alp_image_pixels(image);
    for (size_t i = 0; i < (size_t)info.width * info.height; i++) {
        float in[CHANNELS] = {0.0f}, rgba[CHANNELS];
        for (uint32_t k = 0; k < info.channels; k++) {
            in[k] = component(pixels, floats, i * info.channels + k);
        }
        spread(in, info.channels, floats ? 1.0f : 255.0f, rgba);
        for (int k = 0; k < CHANNELS; k++) {
            if (floats) {
                ((float *)out)[CHANNELS * i + (size_t)k] =
                    srgb && k < 3 ? decode(rgba[k]) : rgba[k];
            } else {
                ((uint8_t *)out)[CHANNELS * i + (size_t)k] = (uint8_t)rgba[k];
            }
        }
    }
}

static GLsizei count_levels(uint32_t width, uint32_t height)
{
    GLsizei levels = 1;
    for (uint32_t side = width > height ? width : height; side > 1; side /= 2) {
        levels++;
    }
    return levels;
}

int gl_texture_check(const char *what, uint32_t width, uint32_t height)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (width <= (uint32_t)most && height <= (uint32_t)most) {
        return EXIT_DONE;
    }
    char text[160];
    snprintf(text, sizeof text, "%s has %u x %u pixels, and the graphics card takes %d", what,
             width, height, most);
    return failure(text);
}

int gl_texture_create(const alp_image *image, bool srgb, GLuint *texture)
{
    const alp_image_info info = alp_image_get_info(image);
    const bool floats = info.component == ALP_COMPONENT_FLOAT;
    const GLsizei width = (GLsizei)info.width, height = (GLsizei)info.height;
    const int code = gl_texture_check("an image of the scene", info.width, info.height);
    if (code != EXIT_DONE) {
        return code;
    }
    const size_t size = (size_t)info.width * info.height * CHANNELS;
    void *pixels = allocate_or_exit(NULL, size * (floats ? sizeof(float) : 1));
    fill(image, srgb, pixels);
    glCreateTextures(GL_TEXTURE_2D, 1, texture);
    glTextureStorage2D(*texture, count_levels(info.width, info.height),
                       floats ? GL_RGBA32F
                       : srgb ? GL_SRGB8_ALPHA8
                              : GL_RGBA8,
                       width, height);
    glTextureSubImage2D(*texture, 0, 0, 0, width, height, GL_RGBA,
                        floats ? GL_FLOAT : GL_UNSIGNED_BYTE, pixels);
    glGenerateTextureMipmap(*texture);
    free(pixels);
    return EXIT_DONE;
}

GLuint gl_texture_white(void)
{
    static const uint8_t texel[CHANNELS] = {255, 255, 255, 255};
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA8, 1, 1);
    glTextureSubImage2D(texture, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, texel);
    return texture;
}

void gl_samplers_create(bool level_zero, GLuint samplers[9])
{
    static const GLint wraps[] = {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT}; // of alp_wrap
    glCreateSamplers(9, samplers);
    for (int i = 0; i < 9; i++) {
        glSamplerParameteri(samplers[i], GL_TEXTURE_WRAP_S, wraps[i / 3]);
        glSamplerParameteri(samplers[i], GL_TEXTURE_WRAP_T, wraps[i % 3]);
        glSamplerParameteri(samplers[i], GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glSamplerParameteri(samplers[i], GL_TEXTURE_MIN_FILTER,
                            level_zero ? GL_LINEAR : GL_LINEAR_MIPMAP_LINEAR);
    }
}
