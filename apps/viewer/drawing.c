// SPDX-License-Identifier: MIT
#include "drawing.h"

#include "options/options.h"
#include "picture.h"

/// More panes than any eye sees through.
enum { LAYER_LIMIT = 4096 };

/// Draws the shadows of what does not move once.
static int add_lights(const alp_scene *scene, const drawing_options *o, drawing *d)
{
    int code = gl_lights_create(scene, o->lighting, &d->light.lights);
    code = code == EXIT_DONE ? pass_shadows_create(&d->shadows) : code;
    if (code == EXIT_DONE) {
        pass_shadows_draw(&d->shadows, &d->drawn, &d->light.lights);
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

int drawing_create(const alp_scene *scene, const drawing_options *o, drawing *d)
{
    const bool open = (o->mode->uses & USES_BACKGROUND) != 0;
    *d = (drawing){.scene = scene};
    int code = gl_targets_create(o->width, o->height, &d->targets);
    if (code == EXIT_DONE) {
        code = pass_surfaces_create(o->mode, o->metals_black, &d->surfaces);
    }
    if (code == EXIT_DONE) {
        code = pass_background_create(o->context, scene, open ? o->lighting : NULL, &d->background);
    }
    code = code == EXIT_DONE ? pass_layers_create(&d->layers) : code;
    code = code == EXIT_DONE ? pass_film_create(&d->film) : code;
    code = code == EXIT_DONE ? gl_scene_create(scene, o->level_zero, &d->drawn) : code;
    const bool lit = o->direct && (o->mode->uses & USES_DIRECT) != 0;
    code = code == EXIT_DONE && lit ? add_lights(scene, o, d) : code;
    const bool occluded = o->ssao_radius > 0.0f && (o->mode->uses & USES_SSAO) != 0;
    return code == EXIT_DONE && occluded ? add_ssao(o, d) : code;
}

void drawing_destroy(drawing *d)
{
    mode_light_destroy(&d->light);
    pass_ssao_destroy(&d->ssao);
    gl_scene_destroy(&d->drawn);
    pass_shadows_destroy(&d->shadows);
    pass_film_destroy(&d->film);
    pass_layers_destroy(&d->layers);
    pass_background_destroy(&d->background);
    pass_surfaces_destroy(&d->surfaces);
    gl_targets_destroy(&d->targets);
}

void drawing_draw(const drawing *d, const alp_camera *camera)
{
    const alp_scene_info info = alp_scene_get_info(d->scene);
    const camera_view view = camera_view_of(camera, d->targets.width, d->targets.height, &info);
    drawing_draw_view(d, &view);
}

void drawing_draw_view(const drawing *d, const camera_view *view)
{
    const gl_targets *t = &d->targets;
    const bool panes = pass_surfaces_has_panes(&d->surfaces, &d->drawn);
    uint32_t layer = 0;
    if (d->light.ssao != 0) {
        pass_ssao_draw(&d->ssao, &d->drawn, view, t);
    }
    pass_layers_clear(t);
    pass_surfaces_draw_opaque(&d->surfaces, &d->drawn, &d->light, view, t);
    while (panes && layer < LAYER_LIMIT &&
           pass_surfaces_draw_panes(&d->surfaces, &d->drawn, &d->light, view, t, layer)) {
        pass_layers_add(&d->layers, t, t->layer_light, t->layer_through, layer++);
    }
    pass_layers_add(&d->layers, t, t->opaque_light, t->opaque_through, layer++);
    pass_background_draw(&d->background, view, t, t->lefts[layer % 2]);
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
