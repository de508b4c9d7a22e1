// SPDX-License-Identifier: MIT
#include "passes/pass_background.h"

#include "gl/gl_buffer.h"
#include "gl/gl_textures.h"
#include "light_views.h"
#include "options/options.h"
#include "passes/shader_list.h"
#include "printing/messages.h"
#include "shaders/bindings.h"

#include <math.h>
#include <stdlib.h>

/// Texture of a clear sky, which is smooth but for the horizon.
enum { CLEAR_WIDTH = 2048 };

/// Smaller disks are points, which nobody sees.
static const double LEAST_SUN_SIZE = 2e-4; // radians, full angle

// --- the sky -------------------------------------------------------------------------------------

/// Directions of the texels of a row, from the middle column at -Z to the right towards +X.
static void aim_row(uint32_t y, uint32_t width, uint32_t height, float (*directions)[3])
{
    const double theta = (y + 0.5) * M_PI / height;
    for (uint32_t x = 0; x < width; x++) {
        const double around = ((x + 0.5) / width - 0.5) * 2.0 * M_PI;
        directions[x][0] = (float)(sin(theta) * sin(around));
        directions[x][1] = (float)cos(theta);
        directions[x][2] = (float)(-sin(theta) * cos(around));
    }
}

static alp_result fill_sky(alp_context *context, const alp_lighting_options *lighting,
                           uint32_t width, uint32_t height, float (*texels)[3])
{
    float(*directions)[3] = allocate_or_exit(NULL, (size_t)width * height * sizeof *directions);
    for (uint32_t y = 0; y < height; y++) {
        aim_row(y, width, height, directions + (size_t)y * width);
    }
    const alp_result result =
        alp_sky_radiance(context, lighting, width * height, (const float(*)[3])directions, texels);
    free(directions);
    return result;
}

/// Makes the texture of a sky that is not two colours. It has the size of the sky's image.
static int load_sky(alp_context *context, const alp_lighting_options *lighting,
                    pass_background *pass)
{
    alp_lighting_options o = *lighting;
    uint32_t width = CLEAR_WIDTH;
    if (o.sky.kind == ALP_SKY_IMAGE) {
        width = alp_image_get_info(o.sky.image).width;
        pass->turn = (float)((double)o.sky.turn / (2.0 * M_PI));
        o.sky.turn = 0.0f; // texels of the texture are those of the image
    }
    const uint32_t height = width / 2;
    if (gl_texture_check("the image of the sky", width, height) != EXIT_DONE) {
        return EXIT_FAILED;
    }
    float(*texels)[3] = allocate_or_exit(NULL, (size_t)width * height * sizeof *texels);
    const alp_result result = fill_sky(context, &o, width, height, texels);
    if (result == ALP_OK) {
        glCreateTextures(GL_TEXTURE_2D, 1, &pass->sky);
        glTextureStorage2D(pass->sky, 1, GL_RGB32F, (GLsizei)width, (GLsizei)height);
        glTextureSubImage2D(pass->sky, 0, 0, 0, (GLsizei)width, (GLsizei)height, GL_RGB, GL_FLOAT,
                            texels);
    }
    free(texels);
    return result == ALP_OK ? EXIT_DONE : failure(alp_context_message(context));
}

static void set_colors(const alp_sky_options *sky, pass_background *pass)
{
    pass->kind = SKY_COLORS;
    for (int k = 0; k < 3; k++) {
        pass->up[k] = sky->strength * sky->up[k];
        pass->down[k] = sky->kind == ALP_SKY_CONSTANT ? pass->up[k] : sky->strength * sky->down[k];
    }
}

static int set_sky(alp_context *context, const alp_lighting_options *lighting,
                   pass_background *pass)
{
    const alp_sky_options *sky = &lighting->sky;
    if (sky->kind == ALP_SKY_CONSTANT || sky->kind == ALP_SKY_HEMISPHERE) {
        set_colors(sky, pass);
    } else if (sky->kind != ALP_SKY_NONE) {
        pass->kind = SKY_IMAGE;
        return load_sky(context, lighting, pass);
    }
    return EXIT_DONE;
}

// --- suns ----------------------------------------------------------------------------------------

/// shaders/background.frag, std430.
typedef struct shader_sun {
    float toward[4];   // unit, and the square of the chord to the rim
    float radiance[4]; // illuminance / (pi sin^2 of half the angle)
} shader_sun;

/// @param toward of any length   @param size radians, full angle
static shader_sun make_sun(const double toward[3], double illuminance, const float color[3],
                           double size)
{
    const double length = hypot(hypot(toward[0], toward[1]), toward[2]);
    const double sine = sin(0.5 * size), chord = 2.0 * sin(0.25 * size);
    shader_sun sun = {.toward = {[3] = (float)(chord * chord)}};
    for (int k = 0; k < 3; k++) {
        sun.toward[k] = (float)(toward[k] / length);
        sun.radiance[k] = (float)(illuminance * (double)color[k] / (M_PI * sine * sine));
    }
    return sun;
}

/// Suns of the options and of the file. @param suns [lights of the scene + 1]
static GLuint list_suns(const alp_scene *scene, const alp_lighting_options *o, shader_sun *suns)
{
    const alp_sun_options *s = &o->sun;
    const uint32_t lights = alp_scene_get_info(scene).lights;
    GLuint count = 0;
    if (s->illuminance > 0.0f && (double)s->size >= LEAST_SUN_SIZE) {
        double toward[3];
        sun_toward(s, toward);
        suns[count++] = make_sun(toward, (double)s->illuminance, s->color, (double)s->size);
    }
    for (uint32_t i = 0; i < lights; i++) {
        const alp_light_info l = alp_scene_get_light(scene, i);
        const double size = (double)(l.size > 0.0f ? l.size : o->file_sun_size);
        if (alp_light_traits_of(l.kind).has_size && size >= LEAST_SUN_SIZE) {
            const double toward[3] = {-(double)l.direction[0], -(double)l.direction[1],
                                      -(double)l.direction[2]};
            suns[count++] = make_sun(toward, (double)l.intensity, l.color, size);
        }
    }
    return count;
}

static int load_suns(const alp_scene *scene, const alp_lighting_options *lighting,
                     pass_background *pass)
{
    const size_t most = (size_t)alp_scene_get_info(scene).lights + 1;
    shader_sun *suns = allocate_or_exit(NULL, most * sizeof *suns);
    pass->sun_count = lighting != NULL ? list_suns(scene, lighting, suns) : 0;
    const int code =
        gl_buffer_load("the list of suns", suns, pass->sun_count * sizeof *suns, &pass->suns);
    free(suns);
    return code;
}

// --- the pass ------------------------------------------------------------------------------------

int pass_background_create(alp_context *context, const alp_scene *scene,
                           const alp_lighting_options *lighting, pass_background *pass)
{
    *pass = (pass_background){0};
    if (screen_pass_create(&shader_background_frag, &pass->screen) != EXIT_DONE ||
        load_suns(scene, lighting, pass) != EXIT_DONE) {
        return EXIT_FAILED;
    }
    return lighting != NULL ? set_sky(context, lighting, pass) : EXIT_DONE;
}

void pass_background_destroy(pass_background *pass)
{
    if (pass->screen.array != 0) {
        glDeleteTextures(1, &pass->sky);
        glDeleteBuffers(1, &pass->suns);
    }
    screen_pass_destroy(&pass->screen);
    *pass = (pass_background){0};
}

void pass_background_draw(const pass_background *pass, const camera_view *view, const gl_targets *t,
                          GLuint left)
{
    screen_pass_bind(&pass->screen, t, t->light_frame);
    camera_view_bind(view);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_SUNS, pass->suns);
    glBindTextureUnit(TEXTURE_PICTURE, t->sum);
    glBindTextureUnit(TEXTURE_LEFT, left);
    glBindTextureUnit(TEXTURE_SKY, pass->sky);
    glUniform1i(UNIFORM_SKY_KIND, pass->kind);
    glUniform3fv(UNIFORM_SKY_UP, 1, pass->up);
    glUniform3fv(UNIFORM_SKY_DOWN, 1, pass->down);
    glUniform1f(UNIFORM_SKY_TURN, pass->turn);
    glUniform1ui(UNIFORM_SUN_COUNT, pass->sun_count);
    screen_pass_draw();
}
