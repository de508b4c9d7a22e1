// SPDX-License-Identifier: MIT
#include "gl/gl_lights.h"

#include "gl/gl_buffer.h"
#include "light_views.h"
#include "options/options.h"
#include "printing/messages.h"
#include "shaders/bindings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Sides of shadow maps in texels, and texels of all maps of a kind. A texel has 4 bytes.
enum { SUN_SIDE = 4096, LAMP_SIDE = 2048, LEAST_SIDE = 64, TEXEL_LIMIT = 1 << 26 };

/// Lamps that light more have six views. Radians from the axis of a cone.
static const double WIDEST_CONE = 1.0471975511965976;

/// shaders/lights.glsl, std430.
typedef struct shader_light {
    float position[4], direction[4], color[4];
    uint32_t kind, first, views, unused;
} shader_light;
typedef struct shader_view {
    float origin[4], forward[4], right[4], up[4];
} shader_view;

/// Lights that shine.
typedef struct light_list {
    alp_light_info *lights;
    uint32_t count;
} light_list;

// --- lights --------------------------------------------------------------------------------------

static bool shines(const alp_light_info *l)
{
    const float sum = l->intensity * (l->color[0] + l->color[1] + l->color[2]);
    bool sound = sum > 0.0f && isfinite(sum);
    const alp_light_traits traits = alp_light_traits_of(l->kind);
    for (int k = 0; k < 3; k++) {
        sound = sound && (!traits.has_position || isfinite(l->position[k])) &&
                (!traits.has_direction || isfinite(l->direction[k])) && l->color[k] >= 0.0f;
    }
    return sound;
}

static void add(light_list *list, const alp_light_info *light)
{
    if (shines(light)) {
        list->lights[list->count++] = *light;
    }
}

static alp_light_info info_of_lamp(const alp_lamp *lamp)
{
    alp_light_info light = {.kind = lamp->kind,
                            .intensity = lamp->intensity,
                            .range = INFINITY,
                            .inner_cone = lamp->inner_cone,
                            .outer_cone = lamp->outer_cone};
    const double x = (double)lamp->direction[0], y = (double)lamp->direction[1],
                 z = (double)lamp->direction[2], length = sqrt(x * x + y * y + z * z);
    memcpy(light.color, lamp->color, sizeof light.color);
    memcpy(light.position, lamp->position, sizeof light.position);
    for (int k = 0; k < 3; k++) {
        light.direction[k] = (float)((double)lamp->direction[k] / length);
    }
    return light;
}

static alp_light_info info_of_sun(const alp_sun_options *sun)
{
    double toward[3];
    alp_light_info light = {
        .kind = ALP_LIGHT_DIRECTIONAL, .intensity = sun->illuminance, .range = INFINITY};
    sun_toward(sun, toward);
    for (int k = 0; k < 3; k++) {
        light.direction[k] = (float)-toward[k];
    }
    memcpy(light.color, sun->color, sizeof light.color);
    return light;
}

static light_list list_lights(const alp_scene *scene, const alp_lighting_options *o)
{
    const uint32_t own = alp_scene_get_info(scene).lights;
    light_list list = {
        .lights = allocate_or_exit(NULL, ((size_t)own + o->lamp_count + 1) * sizeof *list.lights)};
    for (uint32_t i = 0; i < own; i++) {
        const alp_light_info light = alp_scene_get_light(scene, i);
        add(&list, &light);
    }
    for (uint32_t i = 0; i < o->lamp_count; i++) {
        const alp_light_info light = info_of_lamp(&o->lamps[i]);
        add(&list, &light);
    }
    const alp_light_info sun = info_of_sun(&o->sun);
    add(&list, &sun);
    return list;
}

static bool is_sun(const alp_light_info *l)
{
    return l->kind == ALP_LIGHT_DIRECTIONAL;
}

static uint32_t views_of(const alp_scene_info *info, const alp_light_info *l)
{
    return is_sun(l) || light_cone_of(info, l).outer <= WIDEST_CONE ? 1 : LIGHT_FACES;
}

/// @param first of its views   @param views their number
static shader_light pack_light(const alp_light_info *l, uint32_t first, uint32_t views)
{
    const double outer = cos((double)l->outer_cone), inner = cos((double)l->inner_cone);
    shader_light s = {
        .position = {l->position[0], l->position[1], l->position[2],
                     isfinite(l->range) ? 1.0f / l->range : 0.0f},
        .direction = {l->direction[0], l->direction[1], l->direction[2], (float)outer},
        .color = {[3] = (float)(1.0 / fmax(0.001, inner - outer))},
        .kind = is_sun(l)                   ? LIGHT_SUN
                : l->kind == ALP_LIGHT_SPOT ? LIGHT_SPOT
                                            : LIGHT_POINT,
        .first = first,
        .views = views};
    for (int k = 0; k < 3; k++) {
        s.color[k] = l->intensity * l->color[k];
    }
    return s;
}

// --- shadow maps ---------------------------------------------------------------------------------

/// Makes the maps of all suns or of all lamps. @return their side; 0 after a message
static uint32_t make_maps(GLuint *maps, uint32_t layers, uint32_t side)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most);
    if (layers > (uint32_t)most) {
        char text[128];
        snprintf(text, sizeof text, "lights need %u shadow maps, and the graphics card takes %d",
                 layers, most);
        failure(text);
        return 0;
    }
    while (side > LEAST_SIDE && (uint64_t)layers * side * side > TEXEL_LIMIT) {
        side /= 2;
    }
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, maps);
    glTextureStorage3D(*maps, 1, GL_DEPTH_COMPONENT32F, (GLsizei)side, (GLsizei)side,
                       (GLsizei)(layers > 0 ? layers : 1));
    glTextureParameteri(*maps, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(*maps, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(*maps, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(*maps, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(*maps, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(*maps, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    return side;
}

/// Sides of the maps of suns and of lamps.
typedef struct map_sides {
    uint32_t sun, lamp;
} map_sides;

static camera_view view_of(const alp_scene_info *info, const alp_light_info *l, int face,
                           map_sides sides)
{
    if (is_sun(l)) {
        return light_view_of_sun(info, l->direction, sides.sun);
    }
    const light_cone cone = light_cone_of(info, l);
    return views_of(info, l) == 1 ? light_view_of_cone(info, l->position, &cone, sides.lamp)
                                  : light_view_of_face(info, l->position, face, sides.lamp);
}

static shader_view pack_view(const gl_shadow_view *v)
{
    const camera_view *c = &v->view;
    shader_view s = {.origin = {[3] = (float)v->layer},
                     .forward = {[3] = c->parallel ? 1.0f / c->far_plane : c->near_plane}};
    float right = 0.0f, up = 0.0f; // squares
    for (int k = 0; k < 3; k++) {
        right += c->right[k] * c->right[k];
        up += c->up[k] * c->up[k];
    }
    for (int k = 0; k < 3; k++) {
        s.origin[k] = c->origin[k];
        s.forward[k] = c->forward[k];
        s.right[k] = c->right[k] / right;
        s.up[k] = c->up[k] / up;
    }
    s.right[3] = 2.0f * sqrtf(fmaxf(right, up)) / (float)c->width;
    return s;
}

static int load_lights(const alp_scene_info *info, const light_list *list, map_sides sides,
                       gl_lights *d)
{
    shader_light *lights = allocate_or_exit(NULL, list->count * sizeof *lights + 1);
    shader_view *views = allocate_or_exit(NULL, d->view_count * sizeof *views + 1);
    uint32_t at = 0;
    GLint suns = 0, lamps = 0;
    d->shadow_views = allocate_or_exit(NULL, d->view_count * sizeof *d->shadow_views + 1);
    for (uint32_t i = 0; i < list->count; i++) {
        const alp_light_info *l = &list->lights[i];
        const uint32_t count = views_of(info, l);
        lights[i] = pack_light(l, at, count);
        for (uint32_t k = 0; k < count; k++, at++) {
            d->shadow_views[at] =
                (gl_shadow_view){.view = view_of(info, l, (int)k, sides),
                                 .map = is_sun(l) ? d->sun_shadows : d->lamp_shadows,
                                 .layer = is_sun(l) ? suns++ : lamps++};
            views[at] = pack_view(&d->shadow_views[at]);
        }
    }
    d->count = list->count;
    int code =
        gl_buffer_load("the list of lights", lights, list->count * sizeof *lights, &d->lights);
    if (code == EXIT_DONE) {
        code = gl_buffer_load("the list of shadow maps", views, d->view_count * sizeof *views,
                              &d->views);
    }
    free(lights);
    free(views);
    return code;
}

// --- the whole -----------------------------------------------------------------------------------

int gl_lights_create(const alp_scene *scene, const alp_lighting_options *lighting, gl_lights *d)
{
    const alp_scene_info info = alp_scene_get_info(scene);
    light_list list = list_lights(scene, lighting);
    uint32_t suns = 0;
    *d = (gl_lights){0};
    for (uint32_t i = 0; i < list.count; i++) {
        suns += is_sun(&list.lights[i]) ? 1 : 0;
        d->view_count += views_of(&info, &list.lights[i]);
    }
    map_sides sides = {.sun = make_maps(&d->sun_shadows, suns, suns > 0 ? SUN_SIDE : 1)};
    if (sides.sun > 0) {
        const uint32_t lamps = d->view_count - suns;
        sides.lamp = make_maps(&d->lamp_shadows, lamps, lamps > 0 ? LAMP_SIDE : 1);
    }
    d->infos = list.lights;
    return sides.sun > 0 && sides.lamp > 0 ? load_lights(&info, &list, sides, d) : EXIT_FAILED;
}

void gl_lights_destroy(gl_lights *d)
{
    free(d->infos);
    if (d->sun_shadows != 0 || d->lamp_shadows != 0) { // else there may be no context either
        glDeleteTextures(1, &d->sun_shadows);
        glDeleteTextures(1, &d->lamp_shadows);
        glDeleteBuffers(1, &d->lights);
        glDeleteBuffers(1, &d->views);
    }
    free(d->shadow_views);
    *d = (gl_lights){0};
}

void gl_lights_bind(const gl_lights *d)
{
    glUniform1ui(UNIFORM_LIGHTS, d->unseen ? 0 : d->count);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LIGHTS, d->lights);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_SHADOW_VIEWS, d->views);
    glBindTextureUnit(TEXTURE_SUN_SHADOWS, d->sun_shadows);
    glBindTextureUnit(TEXTURE_LAMP_SHADOWS, d->lamp_shadows);
}
