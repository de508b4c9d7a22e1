// SPDX-License-Identifier: MIT
#include "lpv_frame.h"

#include "light_views.h"
#include "options/options.h"
#include "printing/messages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CAMERA_SIDE = 256, EMITTERS_MOST = 1 << 22 };
/// Radians: spot lights with wider cones have six faces.
static const float WIDEST_SPOT = 1.2f;

// --- surfels that stay ---------------------------------------------------------------------------

/// A square texture of surfels.
static GLuint upload(const float (*values)[3], const float *fourth, uint32_t count, uint32_t side)
{
    float(*texels)[4] = allocate_or_exit(NULL, (size_t)side * side * sizeof *texels);
    GLuint texture = 0;
    memset(texels, 0, (size_t)side * side * sizeof *texels);
    for (uint32_t i = 0; i < count; i++) {
        memcpy(texels[i], values[i], sizeof values[i]);
        texels[i][3] = fourth != NULL ? fourth[i] : 0.0f;
    }
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA32F, (GLsizei)side, (GLsizei)side);
    glTextureSubImage2D(texture, 0, 0, 0, (GLsizei)side, (GLsizei)side, GL_RGBA, GL_FLOAT, texels);
    free(texels);
    return texture;
}

static alp_result collect(const alp_scene *scene, alp_lpv_source source, uint32_t count,
                          uint64_t seed, gl_lpv_map *map, float flux[3])
{
    alp_lpv_collection *collection = NULL;
    const alp_result result = alp_lpv_collect(scene, source, count, seed, &collection);
    if (result != ALP_OK) {
        return result;
    }
    const alp_lpv_surfels s = alp_lpv_collection_surfels(collection);
    const uint32_t side = (uint32_t)ceil(sqrt((double)s.count));
    if (s.count > 0) {
        *map = (gl_lpv_map){.positions = upload(s.positions, s.radii, s.count, side),
                            .normals = upload(s.normals, s.areas, s.count, side),
                            .flux = upload(s.flux, NULL, s.count, side),
                            .albedos = upload(s.albedo, NULL, s.count, side),
                            .width = side,
                            .height = side,
                            .cascade = -1};
    }
    for (uint32_t i = 0; i < s.count; i++) {
        for (int k = 0; k < 3; k++) {
            flux[k] += s.flux[i][k];
        }
    }
    alp_lpv_collection_destroy(collection);
    return ALP_OK;
}

static bool emits(const alp_scene *scene)
{
    const uint32_t count = alp_scene_get_info(scene).surfaces;
    bool found = false;
    for (uint32_t i = 0; i < count && !found; i++) {
        const float *e = alp_scene_get_surface(scene, i).emission;
        found = e[0] + e[1] + e[2] > 0.0f;
    }
    return found;
}

static void destroy_map(gl_lpv_map *m)
{
    const GLuint textures[4] = {m->positions, m->normals, m->flux, m->albedos};
    if (m->width > 0) {
        glDeleteTextures(4, textures);
    }
    *m = (gl_lpv_map){0};
}

// --- life ----------------------------------------------------------------------------------------

alp_result lpv_frame_create(const alp_scene *scene, const alp_lpv_options *options,
                            const alp_lpv_scene_options *frame, int *code, lpv_frame *f)
{
    const uint32_t side = frame->map_size, half = side > 1 ? side / 2 : 1;
    *f = (lpv_frame){.views = frame->points == 0};
    *code = gl_lpv_create(options, &f->volume);
    *code = *code == EXIT_DONE ? pass_maps_create(side > CAMERA_SIDE ? side : CAMERA_SIDE, &f->maps)
                               : *code;
    *code = *code == EXIT_DONE ? pass_maps_create(half, &f->faces) : *code;
    if (*code != EXIT_DONE) {
        return ALP_OK;
    }
    f->side = side;
    f->point_count = frame->points;
    f->seed = frame->seed;
    return lpv_frame_collect(scene, f);
}

alp_result lpv_frame_collect(const alp_scene *scene, lpv_frame *f)
{
    float none[3] = {0.0f, 0.0f, 0.0f};
    alp_result result = ALP_OK;
    destroy_map(&f->emitters);
    destroy_map(&f->points);
    memset(f->emitted, 0, sizeof f->emitted);
    if (emits(scene)) {
        const uint32_t count = f->side < 1448 ? 2 * f->side * f->side : EMITTERS_MOST;
        result = collect(scene, ALP_LPV_EMITTERS, count, f->seed, &f->emitters, f->emitted);
    }
    const bool points = result == ALP_OK && f->volume.options.blockers && !f->views;
    return points ? collect(scene, ALP_LPV_POINTS, f->point_count, f->seed, &f->points, none)
                  : result;
}

void lpv_frame_destroy(lpv_frame *f)
{
    destroy_map(&f->emitters);
    destroy_map(&f->points);
    pass_maps_destroy(&f->faces);
    pass_maps_destroy(&f->maps);
    gl_lpv_destroy(&f->volume);
}

// --- a frame -------------------------------------------------------------------------------------

static bool blocks_by_views(const lpv_frame *f)
{
    return f->volume.options.blockers && f->views;
}

static bool is_narrow(const alp_light_info *l)
{
    return l->kind == ALP_LIGHT_SPOT && l->outer_cone < WIDEST_SPOT;
}

/// The map of a cascade's box.
static camera_view view_of_sun(const lpv_frame *f, const lpv_frame_scene *in, uint32_t cascade,
                               const alp_light_info *sun)
{
    const alp_scene_info info = alp_scene_get_info(in->scene);
    alp_lpv_placement at;
    double low[3], high[3];
    alp_lpv_place(&f->volume.options, cascade, in->eye, in->forward, &at);
    for (int k = 0; k < 3; k++) {
        low[k] = at.cell * (double)at.corner[k];
        high[k] = low[k] + at.cell * (double)f->volume.options.size[k];
    }
    return light_view_of_box(&info, sun->direction, low, high, f->side);
}

/// The most that a map can hold: I or E × what the view sees.
static void find_flux(const alp_light_info *l, double seen, float flux[3])
{
    for (int k = 0; k < 3; k++) {
        flux[k] = (float)(seen * (double)l->intensity * (double)l->color[k]);
    }
}

/// Area of a parallel view's rectangle.
static double area_of(const camera_view *v)
{
    double right = 0.0, up = 0.0;
    for (int k = 0; k < 3; k++) {
        right += (double)v->right[k] * (double)v->right[k];
        up += (double)v->up[k] * (double)v->up[k];
    }
    return 4.0 * sqrt(right * up);
}

static void draw(const pass_maps *maps, const lpv_frame_scene *in, uint32_t light,
                 const camera_view *view)
{
    pass_maps_draw(maps, in->drawn, in->object, in->lights, light, in->metals_black, view);
}

static void add_sun(lpv_frame *f, const lpv_frame_scene *in, uint32_t light)
{
    for (uint32_t c = 0; c < f->volume.options.cascades; c++) {
        const camera_view view = view_of_sun(f, in, c, &in->lights->infos[light]);
        draw(&f->maps, in, light, &view);
        float flux[3];
        f->maps.map.cascade = (int)c;
        find_flux(&in->lights->infos[light], area_of(&view), flux);
        gl_lpv_add_light(&f->volume, &f->maps.map, flux);
        if (blocks_by_views(f)) {
            gl_lpv_add_blockers(&f->volume, &f->maps.map, true);
            gl_lpv_end_view(&f->volume);
        }
    }
}

/// A spot light sees through its cone, a point light through six faces of half the size.
static void add_lamp(lpv_frame *f, const lpv_frame_scene *in, uint32_t light)
{
    const alp_scene_info info = alp_scene_get_info(in->scene);
    const alp_light_info *l = &in->lights->infos[light];
    const bool narrow = is_narrow(l);
    pass_maps *maps = narrow ? &f->maps : &f->faces;
    const uint32_t side = narrow ? f->side : f->faces.map.width;
    float flux[3];
    maps->map.cascade = -1;
    find_flux(l, 2.0 * M_PI * (1.0 - cos(light_cone_of(&info, l).outer)), flux);
    for (int face = 0; face < (narrow ? 1 : LIGHT_FACES); face++) {
        double way[3] = {0.0, 0.0, 0.0};
        way[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        for (int k = 0; k < 3 && narrow; k++) {
            way[k] = (double)l->direction[k];
        }
        const camera_view view = light_view_of_lamp(
            &info, l->position, way, narrow ? tan((double)l->outer_cone) : 1.0, side);
        draw(maps, in, light, &view);
        gl_lpv_add_light(&f->volume, &maps->map, flux);
        if (blocks_by_views(f)) {
            gl_lpv_add_blockers(&f->volume, &maps->map, false);
        }
    }
    if (blocks_by_views(f)) {
        gl_lpv_end_view(&f->volume);
    }
}

/// Blockers of the camera's picture, or the points that stay.
static void add_blockers(lpv_frame *f, const lpv_frame_scene *in)
{
    if (blocks_by_views(f) && in->camera != NULL) {
        camera_view view = *in->camera;
        view.width = view.height = CAMERA_SIDE;
        draw(&f->maps, in, MAP_NO_LIGHT, &view);
        f->maps.map.cascade = -1;
        gl_lpv_add_blockers(&f->volume, &f->maps.map, false);
        gl_lpv_end_view(&f->volume);
    } else if (f->points.width > 0) {
        gl_lpv_add_blockers(&f->volume, &f->points, false);
        gl_lpv_end_view(&f->volume);
    }
}

void lpv_frame_light(lpv_frame *f, const lpv_frame_scene *in)
{
    gl_lpv_follow(&f->volume, in->eye, in->forward);
    gl_lpv_begin(&f->volume);
    for (uint32_t i = 0; i < in->lights->count; i++) {
        if (in->lights->infos[i].kind == ALP_LIGHT_DIRECTIONAL) {
            add_sun(f, in, i);
        } else {
            add_lamp(f, in, i);
        }
    }
    if (f->emitters.width > 0) {
        gl_lpv_add_light(&f->volume, &f->emitters, f->emitted);
    }
    add_blockers(f, in);
    gl_lpv_propagate(&f->volume);
}
