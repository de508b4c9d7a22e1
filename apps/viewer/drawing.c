// SPDX-License-Identifier: MIT
#include "drawing.h"

#include "options/options.h"
#include "picture.h"

/// More panes than any eye sees through.
enum { LAYER_LIMIT = 4096 };

/// Whether a field is read on the processor at every pixel.
static bool reads_pixels(const drawing *d)
{
    return (d->surfaces.mode->uses & USES_FIELD) != 0 && d->light.field.read == READ_PIXEL;
}

/// Draws the shadows of what does not move once.
static int add_lights(const alp_scene *scene, const alp_lighting_options *lighting, drawing *d)
{
    int code = gl_lights_create(scene, lighting, &d->light.lights);
    code = code == EXIT_DONE ? pass_shadows_create(&d->shadows) : code;
    if (code == EXIT_DONE) {
        pass_shadows_draw(&d->shadows, &d->drawn, &d->light.lights);
    }
    return code;
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
    const bool lit = o->direct && (o->mode->uses & USES_DIRECT) != 0;
    return code == EXIT_DONE && lit ? add_lights(scene, o->lighting, d) : code;
}

void drawing_destroy(drawing *d)
{
    mode_light_destroy(&d->light);
    gl_scene_destroy(&d->drawn);
    pass_shadows_destroy(&d->shadows);
    pass_film_destroy(&d->film);
    pass_layers_destroy(&d->layers);
    pass_background_destroy(&d->background);
    pass_field_destroy(&d->field);
    pass_surfaces_destroy(&d->surfaces);
    gl_targets_destroy(&d->targets);
}

int drawing_set_lighting(drawing *d, alp_context *context, const alp_lighting_options *lighting)
{
    const bool lit = d->shadows.program != 0;
    pass_background_destroy(&d->background);
    pass_shadows_destroy(&d->shadows);
    gl_lights_destroy(&d->light.lights);
    const int code = pass_background_create(context, d->scene, lighting, &d->background);
    return code == EXIT_DONE && lit ? add_lights(d->scene, lighting, d) : code;
}

static void draw_opaque(const drawing *d, const camera_view *view)
{
    if (reads_pixels(d)) {
        pass_field_draw_opaque(&d->field, &d->light.field, &d->drawn, view, &d->targets);
    }
    pass_surfaces_draw_opaque(&d->surfaces, &d->drawn, &d->light, view, &d->targets);
}

/// Draws one layer. @return whether it shows anything
static bool draw_panes(const drawing *d, const camera_view *view, uint32_t layer)
{
    const bool seen =
        !reads_pixels(d) ||
        pass_field_draw_panes(&d->field, &d->light.field, &d->drawn, view, &d->targets, layer);
    return seen &&
           pass_surfaces_draw_panes(&d->surfaces, &d->drawn, &d->light, view, &d->targets, layer);
}

void drawing_draw(drawing *d, const alp_camera *camera)
{
    const alp_scene_info info = alp_scene_get_info(d->scene);
    const gl_targets *t = &d->targets;
    const camera_view view = camera_view_of(camera, t->width, t->height, &info);
    const bool panes = pass_surfaces_has_panes(&d->surfaces, &d->drawn);
    uint32_t layer = 0;
    pass_layers_clear(t);
    gl_field_update(&d->light.field, d->scene);
    draw_opaque(d, &view);
    while (panes && layer < LAYER_LIMIT && draw_panes(d, &view, layer)) {
        pass_layers_add(&d->layers, t, t->layer_light, t->layer_through, layer++);
    }
    pass_layers_add(&d->layers, t, t->opaque_light, t->opaque_through, layer++);
    pass_background_draw(&d->background, &view, t, t->lefts[layer % 2]);
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
