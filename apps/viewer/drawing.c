// SPDX-License-Identifier: MIT
#include "drawing.h"

#include "options/options.h"
#include "picture.h"
#include "printing/messages.h"

#include <math.h>
#include <string.h>

/// More panes than any eye sees through.
enum { LAYER_LIMIT = 4096 };

/// Whether a field is read on the processor at every pixel.
static bool reads_pixels(const drawing *d)
{
    return (d->surfaces.mode->uses & USES_FIELD) != 0 && d->light.field.read == READ_PIXEL;
}

static void draw_shadows(const drawing *d)
{
    pass_shadows_draw(&d->shadows, &d->drawn, gl_object_drawn(&d->object), &d->light.lights);
}

/// Draws the shadows, which stay until something moves.
/// @param seen whether they light surfaces, beside a volume
static int add_lights(const alp_scene *scene, const alp_lighting_options *lighting, bool seen,
                      drawing *d)
{
    int code = gl_lights_create(scene, lighting, &d->light.lights);
    d->light.lights.unseen = !seen;
    code = code == EXIT_DONE ? pass_shadows_create(&d->shadows) : code;
    if (code == EXIT_DONE) {
        draw_shadows(d);
    }
    return code;
}

static int add_ssao(const drawing_options *o, drawing *d)
{
    const bool panes = pass_surfaces_has_panes(&d->surfaces, &d->drawn);
    const int code = pass_ssao_create(&d->targets, panes, o->ssao_radius, &d->ssao);
    d->light.ssao = d->ssao.share;
    return code;
}

static int place_object(alp_context *context, const alp_render_object *object, drawing *d)
{
    const uint32_t first = alp_scene_get_geometry(d->scene).triangle_count;
    return gl_object_place(context, object, first, &d->object);
}

int drawing_create(const alp_scene *scene, const drawing_options *o, drawing *d)
{
    const bool open = (o->mode->uses & USES_BACKGROUND) != 0;
    *d = (drawing){.scene = scene, .light = o->light};
    int code = gl_targets_create(o->width, o->height, &d->targets);
    if (code == EXIT_DONE) {
        code = pass_surfaces_create(o->mode, o->metals_black, &d->surfaces);
    }
    if (code == EXIT_DONE && reads_pixels(d)) {
        code = pass_field_create(&d->targets, &d->field);
    }
    if (code == EXIT_DONE) {
        code = pass_background_create(o->context, scene, open ? o->lighting : NULL, &d->background);
    }
    code = code == EXIT_DONE ? pass_layers_create(&d->layers) : code;
    code = code == EXIT_DONE ? pass_film_create(&d->film) : code;
    code =
        code == EXIT_DONE ? gl_scene_create(scene, o->level_zero, o->normal_maps, &d->drawn) : code;
    if (code == EXIT_DONE && o->object.kind != ALP_OBJECT_NONE) {
        code = place_object(o->context, &o->object, d);
    }
    if (code == EXIT_DONE && d->light.scattering > 0.0f) {
        code = pass_air_create(&d->air);
    }
    const bool lit = o->direct && (o->mode->uses & USES_DIRECT) != 0;
    if (code == EXIT_DONE && (lit || d->light.lpv != NULL)) {
        code = add_lights(scene, o->lighting, lit, d);
    }
    const bool occluded = o->ssao_radius > 0.0f && (o->mode->uses & USES_SSAO) != 0;
    return code == EXIT_DONE && occluded ? add_ssao(o, d) : code;
}

void drawing_destroy(drawing *d)
{
    mode_light_destroy(&d->light);
    pass_ssao_destroy(&d->ssao);
    gl_object_destroy(&d->object);
    gl_scene_destroy(&d->drawn);
    screen_pass_destroy(&d->air);
    pass_shadows_destroy(&d->shadows);
    pass_film_destroy(&d->film);
    pass_layers_destroy(&d->layers);
    pass_background_destroy(&d->background);
    pass_field_destroy(&d->field);
    pass_surfaces_destroy(&d->surfaces);
    gl_targets_destroy(&d->targets);
}

/// Lists the lights of the scene again, and draws their shadows, if the mode has lights.
static int update_lights(drawing *d, const alp_lighting_options *lighting)
{
    const bool lit = d->shadows.program != 0, seen = !d->light.lights.unseen;
    pass_shadows_destroy(&d->shadows);
    gl_lights_destroy(&d->light.lights);
    return lit ? add_lights(d->scene, lighting, seen, d) : EXIT_DONE;
}

static int update_background(drawing *d, alp_context *context, const alp_lighting_options *lighting)
{
    pass_background_destroy(&d->background);
    return pass_background_create(context, d->scene, lighting, &d->background);
}

int drawing_set_lighting(drawing *d, alp_context *context, const alp_lighting_options *lighting)
{
    const int code = update_background(d, context, lighting);
    return code == EXIT_DONE ? update_lights(d, lighting) : code;
}

/// Finds the surfels that lamps do not light again.
static int update_volume(const drawing *d, alp_context *context)
{
    return d->light.lpv == NULL || lpv_frame_collect(d->scene, d->light.lpv) == ALP_OK
               ? EXIT_DONE
               : failure(alp_context_message(context));
}

int drawing_set_pose(drawing *d, alp_context *context, const alp_scene *posed,
                     const alp_lighting_options *lighting)
{
    const bool suns = (d->surfaces.mode->uses & USES_BACKGROUND) != 0 &&
                      alp_scene_get_info(posed).lights > 0; // that are seen, and may turn
    d->scene = posed;
    gl_field_set(&d->light.field, d->light.field.field);
    int code = gl_scene_move(posed, &d->drawn);
    code = code == EXIT_DONE && suns ? update_background(d, context, lighting) : code;
    code = code == EXIT_DONE ? update_lights(d, lighting) : code;
    return code == EXIT_DONE ? update_volume(d, context) : code;
}

int drawing_move_object(drawing *d, alp_context *context, const float position[3])
{
    alp_render_object object = d->object.what;
    memcpy(object.position, position, sizeof object.position);
    const int code = place_object(context, &object, d);
    if (code == EXIT_DONE && d->shadows.program != 0) {
        draw_shadows(d);
    }
    return code;
}

static void draw_opaque(const drawing *d, const camera_view *view)
{
    const gl_scene *object = gl_object_drawn(&d->object);
    if (reads_pixels(d)) {
        pass_field_draw_opaque(&d->field, &d->light.field, &d->drawn, object, view, &d->targets);
    }
    pass_surfaces_draw_opaque(&d->surfaces, &d->drawn, &d->light, view, &d->targets);
    if (object != NULL) {
        mode_light own = d->light; // the same, read at other places
        own.field = d->object.field;
        pass_surfaces_add_object(&d->surfaces, object, &own, view, &d->targets);
    }
}

/// Draws one layer of panes. @return whether it shows anything
static bool draw_panes(const drawing *d, const camera_view *view, uint32_t layer)
{
    if (reads_pixels(d) &&
        !pass_field_draw_panes(&d->field, &d->light.field, &d->drawn, view, &d->targets, layer)) {
        return false;
    }
    return pass_surfaces_draw_panes(&d->surfaces, &d->drawn, &d->light, view, &d->targets, layer);
}

void drawing_light(drawing *d, const float eye[3], const float forward[3], const camera_view *view)
{
    if (d->light.lpv == NULL) {
        return;
    }
    const alp_lpv_options *o = &d->light.lpv->volume.options;
    const alp_scene_info info = alp_scene_get_info(d->scene);
    lpv_frame_scene in = {.scene = d->scene,
                          .drawn = &d->drawn,
                          .object = gl_object_drawn(&d->object),
                          .lights = &d->light.lights,
                          .camera = view,
                          .metals_black = d->surfaces.metals_black};
    for (int k = 0; k < 3; k++) {
        const float near = fmaxf(eye[k], info.bounds_min[k]);
        in.eye[k] = o->cascades > 1 ? (double)fminf(near, info.bounds_max[k]) : o->centre[k];
        in.forward[k] = o->cascades > 1 ? (double)forward[k] : 0.0;
    }
    lpv_frame_light(d->light.lpv, &in);
}

void drawing_draw(drawing *d, const alp_camera *camera)
{
    const alp_scene_info info = alp_scene_get_info(d->scene);
    const camera_view view = camera_view_of(camera, d->targets.width, d->targets.height, &info);
    drawing_light(d, view.origin, view.forward, &view);
    drawing_draw_view(d, &view);
}

/// Adds the mist before a layer, if there is mist.
/// @param layer its number; depths are of the layer before   @param end depth of the layer
/// @param step  of the sum   @return the next step
static uint32_t add_mist(const drawing *d, const camera_view *view, uint32_t layer, GLuint end,
                         uint32_t step)
{
    const gl_targets *t = &d->targets;
    const alp_scene_info info = alp_scene_get_info(d->scene);
    if (d->light.scattering <= 0.0f) {
        return step;
    }
    const mist m = {d->light.scattering, &d->light.lpv->volume, &d->light.lights, &info};
    const GLuint before = layer > 0 ? t->depths[1 - layer % 2] : 0;
    pass_air_draw(&d->air, &m, view, t, before, end, step);
    return step + 1;
}

void drawing_draw_view(drawing *d, const camera_view *view)
{
    const gl_targets *t = &d->targets;
    const bool panes = pass_surfaces_has_panes(&d->surfaces, &d->drawn);
    uint32_t layer = 0, step = 0;
    if (d->light.ssao != 0) {
        pass_ssao_draw(&d->ssao, &d->drawn, view, t);
    }
    pass_layers_clear(t);
    gl_object_update(&d->object, &d->light.field);
    gl_field_update(&d->light.field, d->scene);
    draw_opaque(d, view);
    while (panes && layer < LAYER_LIMIT && draw_panes(d, view, layer)) {
        step = add_mist(d, view, layer, t->depths[layer % 2], step);
        pass_layers_add(&d->layers, t, t->layer_light, t->layer_through, step++);
        layer++;
    }
    step = add_mist(d, view, layer, t->opaque_depth, step);
    pass_layers_add(&d->layers, t, t->opaque_light, t->opaque_through, step++);
    pass_background_draw(&d->background, view, t, t->lefts[step % 2]);
}

alp_result drawing_develop(const drawing *d, alp_context *context, alp_film_options *film,
                           alp_image **developed, alp_image **light)
{
    alp_film_numbers numbers;
    alp_image *own = NULL;
    *developed = NULL;
    alp_result result = picture_read_light(context, &d->targets, &own);
    if (result == ALP_OK) {
        result = alp_film_resolve(own, film, &numbers);
    }
    if (result == ALP_OK) {
        pass_film_draw(&d->film, film, &numbers, &d->targets);
        film->exposure = numbers.exposure;
        result = picture_read_developed(context, &d->targets, developed);
    }
    if (light != NULL) {
        *light = own;
    } else {
        alp_image_destroy(own);
    }
    return result;
}
