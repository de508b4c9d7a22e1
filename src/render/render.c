// SPDX-License-Identifier: MIT
// Camera → hit → map or transport → picture. Pixels are averaged over a box of stratified camera
// rays.
#include <alpenglow/render.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "fields/field.h"
#include "maps/lightmap.h"
#include "maps/radiosity/solution.h"
#include "render/automatic_camera.h"
#include "render/camera_rays.h"
#include "render/field_light.h"
#include "render/hemicube_view.h"
#include "render/lightmap_pixel.h"
#include "render/object_pass.h"
#include "render/stored_light.h"
#include "scene/light_maps.h"
#include "scene/origin.h"
#include "scene/select.h"
#include "transport/examine.h"
#include "transport/occlusion/occlusion_run.h"
#include "transport/paths/hit.h"
#include "transport/paths/reference.h"

#include <math.h>
#include <string.h>

enum { SIDE_LIMIT = 16384, SAMPLE_LIMIT = 65536 };
// Work is cut so that one range takes a few milliseconds and cancelling stays prompt.
enum { RAYS_PER_RANGE = 1 << 14, PIXELS_PER_RANGE = 64 };
enum { STREAM_PIXEL = 1 }; // random numbers of camera rays, apart from those of occlusion

/// Hemicubes start so far above a point that may lie on a surface, of the scene's diagonal: digits
/// that somebody types are no nearer.
static const float HEMICUBE_START = 1e-5f;

typedef struct render_job {
    const alp_scene *scene;
    alp_render_options options;
    const alpi_tracer *tracer;
    alpi_tracer *occluders; // of the chosen ones, NULL = `tracer`
    alpi_occlusion_setup occlusion;
    alpi_sample_run occlusion_samples; // all of them
    alpi_lighting *lighting;           // of methods that light the scene, else NULL
    alpi_reference reference;
    alpi_solution *solution;  // of RADIOSITY, else NULL
    alpi_surface_light known; // of the solution
    alpi_shown shown;         // of LIGHTMAP and FIELD
    alpi_lighting *first;     // light without lamps, where surfaces in view get none of theirs
    alpi_field_light field;   // of FIELD
    alp_image *image, *error; // error: NULL unless asked for
    alpi_view view;
} render_job;

alp_render_options alp_render_options_default(void)
{
    alp_render_options options = {.struct_size = sizeof(alp_render_options),
                                  .width = 960,
                                  .height = 540,
                                  .samples = 16,
                                  .hemicube = 256,
                                  .bounces = ALP_BOUNCES_CONVERGE,
                                  .atlas = alp_atlas_options_default(),
                                  .lighting = alp_lighting_options_default(),
                                  .occlusion = alp_occlusion_options_default()};
    options.atlas.size = 512;
    return options;
}

static alp_result check_options(const alp_scene *scene, const alp_render_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(scene->context, code, "render options are not from _default()");
    }
    if (o->width < 1 || o->width > SIDE_LIMIT || o->height < 1 || o->height > SIDE_LIMIT) {
        return alpi_fail(scene->context, code, "render: %u x %u pixels, sides must be 1 to %d",
                         o->width, o->height, SIDE_LIMIT);
    }
    if (o->samples < 1 || o->samples > SAMPLE_LIMIT) {
        return alpi_fail(scene->context, code, "render: %u samples per pixel, need 1 to %d",
                         o->samples, SAMPLE_LIMIT);
    }
    if ((int)o->method < ALP_RENDER_AO || o->method > ALP_RENDER_FIELD) {
        return alpi_fail(scene->context, code, "render: unknown method %d", (int)o->method);
    }
    if (o->method == ALP_RENDER_HEMICUBE) {
        ALP_TRY(alpi_hemicube_view_check(scene->context, o));
    }
    if (o->lightmap != NULL && o->lightmap->scene != scene) {
        return alpi_fail(scene->context, code, "render: the maps belong to another scene");
    }
    const bool has_light = o->lightmap != NULL ? o->lightmap->irradiance_pages != NULL
                                               : alpi_scene_light_maps(scene) != NULL;
    if (o->method == ALP_RENDER_LIGHTMAP && !has_light) {
        return alpi_fail(scene->context, code,
                         "render: there is no map of light; bake with ALP_MAP_LIGHT, or read those "
                         "of the file (alp_scene_read_light_maps)");
    }
    if (o->method == ALP_RENDER_FIELD && o->field == NULL) {
        return alpi_fail(scene->context, code, "render: there is no field");
    }
    if (!(o->scattering >= 0.0f) || !isfinite(o->scattering)) {
        return alpi_fail(scene->context, code, "render: a medium of scattering %g, need >= 0",
                         (double)o->scattering);
    }
    if (o->method == ALP_RENDER_FIELD && (o->gloss || o->scattering > 0.0f) && o->lpv == NULL) {
        return alpi_fail(scene->context, code, "render: gloss and scattering need a volume, lpv");
    }
    const alp_render_object *object = &o->object;
    if (object->kind != ALP_OBJECT_NONE && !(object->radius > 0.0f && isfinite(object->radius) &&
                                             vec3_is_finite(vec3_load(object->position)))) {
        return alpi_fail(scene->context, code,
                         "render: the object needs a finite position and a "
                         "radius above 0");
    }
    return alpi_occlusion_check(scene, &o->occlusion);
}

/// Whether pixels come from a map or a field, through panes.
static bool goes_by_shown(const render_job *job)
{
    return job->options.method == ALP_RENDER_LIGHTMAP || job->options.method == ALP_RENDER_FIELD;
}

/// Whether pixels are means over paths, and have an error.
static bool goes_by_paths(const render_job *job)
{
    return job->options.method == ALP_RENDER_REFERENCE ||
           job->options.method == ALP_RENDER_RADIOSITY;
}

/// Refuses a picture that would be black because nothing lights the scene. A light map holds light
/// of its own.
static alp_result check_lit(const render_job *job)
{
    const alp_render_options *o = &job->options;
    const bool cube = o->method == ALP_RENDER_HEMICUBE && !alpi_hemicube_view_is_map(o);
    return goes_by_paths(job) || cube ? alpi_lighting_refuse_darkness(job->scene, &o->lighting)
                                      : ALP_OK;
}

alp_result alp_render_find_camera(const alp_scene *scene, const alp_render_options *options,
                                  alp_camera *camera)
{
    if (scene == NULL || camera == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const alp_render_options o = options ? *options : alp_render_options_default();
    if (o.camera.vertical_fov != 0.0f) {
        *camera = o.camera;
        return ALP_OK;
    }
    ALP_TRY(alpi_camera_choose(scene, o.camera_index, o.progress, o.progress_user, camera));
    if (o.camera_index >= scene->camera_count && o.width > 0 && o.height > 0) {
        alpi_camera_frame(scene, (float)o.width / (float)o.height, camera);
    }
    return ALP_OK;
}

/// The camera that was given, or that of the scene.
static alp_result place_camera(render_job *job)
{
    const alp_render_options *o = &job->options;
    alp_camera camera;
    ALP_TRY(alp_render_find_camera(job->scene, o, &camera));
    ALP_TRY(alpi_view_place(job->scene->context, &camera, o->width, o->height, &job->view));
    job->view.centred = o->samples == 1;
    if (o->method == ALP_RENDER_HEMICUBE) {
        const float size = vec3_length(vec3_sub(job->scene->bounds_max, job->scene->bounds_min));
        job->view.origin = vec3_mad(job->view.origin, HEMICUBE_START * size, job->view.forward);
    }
    return ALP_OK;
}

/// Says where a picture will be black because the camera stands in a wall: methods that light the
/// scene leave the backs of single-sided surfaces black.
static void warn_of_walls(const render_job *job, const alpi_tracer *tracer)
{
    enum { ACROSS = 8 };
    const alp_render_method method = job->options.method;
    const bool map = method == ALP_RENDER_HEMICUBE && alpi_hemicube_view_is_map(&job->options);
    const bool lights = method != ALP_RENDER_AO && method != ALP_RENDER_ALBEDO && !map;
    enum { COUNT = ACROSS * ACROSS };
    vec3 directions[COUNT];
    float x[COUNT], y[COUNT], d[3][COUNT] = {{0.0f}};
    for (int i = 0; i < COUNT; i++) {
        const int column = i % ACROSS, row = i / ACROSS;
        x[i] = ((float)column + 0.5f) * (float)job->options.width / ACROSS;
        y[i] = ((float)row + 0.5f) * (float)job->options.height / ACROSS;
    }
    job->view.loops->aim(&job->view, COUNT, x, y, (float *const[3]){d[0], d[1], d[2]});
    for (int i = 0; i < COUNT; i++) {
        directions[i] = (vec3){d[0][i], d[1][i], d[2][i]};
    }
    const alpi_trace_filter filter = {.one_sided = job->options.occlusion.one_sided};
    double at[3];
    alpi_origin_restore(job->scene, job->view.origin, at);
    if (lights &&
        alpi_examine_is_inside(tracer, filter, job->scene, job->view.origin, directions, COUNT)) {
        alpi_warn(job->scene->context, "camera-inside", job->scene->name,
                  "the camera, at %g %g %g m, is inside something or behind a wall: it sees the "
                  "backs of single-sided surfaces, which are black; move it (--camera)",
                  at[0], at[1], at[2]);
    }
}

/// The ambient light of two half skies, which is exact for what nothing covers.
static void shade_by_hemisphere(const render_job *job, const alpi_hits *hits, int lane,
                                vec3 direction, float rgb[3])
{
    const alp_sky_options *sky = &job->options.lighting.sky;
    const float *down = sky->kind == ALP_SKY_CONSTANT ? sky->up : sky->down;
    bool behind = false;
    const alpi_receiver_point p = alpi_hit_point(job->scene, hits, lane, direction, &behind);
    if (behind && !alpi_surface_is_double_sided(job->scene, hits->triangle[lane])) {
        rgb[0] = rgb[1] = rgb[2] = 0.0f; // as the reference has it
        return;
    }
    const vec3 albedo =
        alpi_surface_albedo(job->scene, hits->triangle[lane], hits->b1[lane], hits->b2[lane]);
    const float above = 0.5f * sky->strength * (1.0f + p.shading_normal.y);
    const float below = 0.5f * sky->strength * (1.0f - p.shading_normal.y);
    vec3_store(rgb, albedo);
    for (int k = 0; k < 3; k++) {
        rgb[k] *= above * sky->up[k] + below * down[k];
    }
}

/// What needs no rays. @return false: only rays can tell
static bool shade_by_lookup(const render_job *job, const alpi_hits *hits, int lane, vec3 direction,
                            float rgb[3])
{
    const uint32_t triangle = hits->triangle[lane];
    const float b1 = hits->b1[lane], b2 = hits->b2[lane];
    if (job->options.method == ALP_RENDER_ALBEDO) {
        vec3_store(rgb, alpi_surface_albedo(job->scene, triangle, b1, b2));
        return true;
    }
    if (job->options.method == ALP_RENDER_HEMISPHERE) {
        shade_by_hemisphere(job, hits, lane, direction, rgb);
        return true;
    }
    if (job->options.lightmap != NULL && alpi_lightmap_holds(job->options.lightmap, triangle)) {
        alpi_lightmap_sample(job->options.lightmap, triangle, b1, b2, rgb);
        return true;
    }
    float value = 1.0f;
    const bool known = alpi_surface_occlusion(job->scene, triangle, b1, b2, &value);
    rgb[0] = rgb[1] = rgb[2] = value;
    return known;
}

/// Shades the lanes of a packet that hit something: bit i of `lanes`.
static void shade(const render_job *job, uint64_t first_key, const alpi_rays *rays,
                  const alpi_hits *hits, uint32_t lanes, float rgb[ALPI_PACKET][3])
{
    alpi_receiver_point points[ALPI_PACKET];
    uint64_t keys[ALPI_PACKET];
    float values[ALPI_PACKET];
    int dark[ALPI_PACKET]; // lanes that need rays
    uint32_t count = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const vec3 d = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
        if ((lanes >> i & 1u) != 0 && !shade_by_lookup(job, hits, i, d, rgb[i])) {
            points[count] = alpi_hit_point(job->scene, hits, i, d, NULL);
            keys[count] = first_key + (uint64_t)i;
            dark[count++] = i;
        }
    }
    if (count == 0) {
        return;
    }
    alpi_occlusion_of_points(&job->occlusion, &job->occlusion_samples, points, keys, count, values);
    for (uint32_t k = 0; k < count; k++) {
        float *pixel = rgb[dark[k]];
        pixel[0] = pixel[1] = pixel[2] = values[k];
    }
}

/// Radiance over the whole pixel, the sky included; alpha: what shows something.
static void keep_reference(const render_job *job, uint32_t index, const alpi_reference_value *value,
                           float covered)
{
    float *pixel = (float *)job->image->pixels + 4 * (size_t)index;
    const float alpha = alpi_lighting_sky(job->lighting) != NULL ? 1.0f : covered;
    for (int k = 0; k < 3; k++) { // colour over what is covered, as of the other methods
        pixel[k] = alpha > 0.0f ? value->mean[k] / alpha : 0.0f;
    }
    pixel[3] = alpha;
    if (job->error != NULL) {
        float *error = (float *)job->error->pixels + 4 * (size_t)index;
        for (int k = 0; k < 3; k++) {
            error[k] = alpha > 0.0f ? sqrtf(value->variance[k]) / alpha : 0.0f;
        }
        error[3] = alpha > 0.0f ? 1.0f : 0.0f;
    }
}

/// Chunks [begin, end) of the picture: what is traced together must not hang on how the loop is
/// cut.
static alp_result render_chunks(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const render_job *job = user;
    const uint32_t pixels = job->options.width * job->options.height;
    alpi_reference_value values[PIXELS_PER_RANGE];
    float covered[PIXELS_PER_RANGE];
    for (uint32_t chunk = begin; chunk < end; chunk++) {
        const uint32_t first = chunk * PIXELS_PER_RANGE, left = pixels - first;
        const uint32_t count = left < PIXELS_PER_RANGE ? left : PIXELS_PER_RANGE;
        ALP_TRY(alpi_reference_pixels(&job->reference, alpi_view_rays, &job->view, first, count,
                                      values, covered));
        for (uint32_t i = 0; i < count; i++) {
            keep_reference(job, first + i, &values[i], covered[i]);
        }
    }
    return ALP_OK;
}

static void render_pixel(const render_job *job, uint32_t index, float pixel[4])
{
    uint32_t key = alpi_random_key(job->options.occlusion.seed, index, STREAM_PIXEL);
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    alpi_rays rays;
    alpi_hits hits;
    alpi_trace_filter filter = job->occlusion.filter;
    filter.one_sided |= job->options.method == ALP_RENDER_AO; // as viewers show them
    alpi_rays_clear(&rays);
    for (uint32_t first = 0; first < job->options.samples; first += ALPI_PACKET) {
        uint32_t rest = job->options.samples - first;
        uint32_t lanes = rest < ALPI_PACKET ? rest : ALPI_PACKET;
        job->view.loops->packet(&job->view, index, key, first, &rays);
        alpi_trace_nearest_coherent(job->tracer, &rays, (1u << lanes) - 1u, filter, &hits);
        uint32_t hit = 0;
        for (uint32_t i = 0; i < lanes; i++) {
            hit |= (hits.triangle[i] != ALPI_NONE ? 1u : 0u) << i;
        }
        float rgb[ALPI_PACKET][3];
        shade(job, (uint64_t)index * job->options.samples + first, &rays, &hits, hit, rgb);
        for (uint32_t i = 0; i < lanes; i++) {
            for (int k = 0; k < 3 && (hit >> i & 1u) != 0; k++) {
                sum[k] += (double)rgb[i][k];
            }
            sum[3] += (double)(hit >> i & 1u);
        }
    }
    for (int k = 0; k < 4; k++) { // colour over what is covered; alpha = covered share
        double share = k < 3 ? sum[3] : (double)job->options.samples;
        pixel[k] = share > 0.0 ? (float)(sum[k] / share) : 0.0f;
    }
}

static alp_result render_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const render_job *job = user;
    float *pixels = job->image->pixels;
    for (uint32_t i = begin; i < end; i++) {
        float *pixel = pixels + 4 * (size_t)i;
        if (goes_by_shown(job)) {
            const uint32_t key = alpi_random_key(job->options.occlusion.seed, i, STREAM_PIXEL);
            alpi_lightmap_pixel(&job->shown, &job->view, job->options.samples, key, i, pixel);
        } else {
            render_pixel(job, i, pixel);
        }
    }
    return ALP_OK;
}

/// The tracer of what occludes, where that is not everything.
static alp_result choose_occluders(render_job *job)
{
    const alp_render_options *o = &job->options;
    bool *surfaces = NULL;
    ALP_TRY(alpi_scene_select(job->scene, o->occluders, &surfaces));
    alp_result result = surfaces == NULL ? ALP_OK
                                         : alpi_tracer_create(job->scene, surfaces, o->progress,
                                                              o->progress_user, &job->occluders);
    alpi_release(job->scene->context, surfaces);
    return result;
}

/// What LIGHTMAP reads.
static void prepare_lightmap(render_job *job)
{
    const alp_lightmap *maps = job->options.lightmap;
    job->shown.surfaces = (alpi_gather_scene){.scene = job->scene,
                                              .tracer = job->tracer,
                                              .lighting = job->lighting,
                                              .filter = job->occlusion.filter,
                                              .light = maps != NULL ? alpi_lightmap_light(maps)
                                                                    : alpi_stored_light(job->scene),
                                              .emitters = true};
}

/// What FIELD reads.
static void prepare_field(render_job *job)
{
    const alp_field *field = job->options.field;
    const bool lamps = !job->options.without_direct && !field->direct;
    job->field = (alpi_field_light){.scene = job->scene,
                                    .tracer = job->tracer,
                                    .filter = job->occlusion.filter,
                                    .field = field,
                                    .lamps = lamps ? job->lighting : NULL,
                                    .gloss = job->options.gloss ? job->options.lpv : NULL};
    job->shown.surfaces = (alpi_gather_scene){.scene = job->scene,
                                              .tracer = job->tracer,
                                              .lighting = job->lighting,
                                              .filter = job->occlusion.filter,
                                              .light = alpi_field_light_surfaces(&job->field),
                                              .emitters = true};
    job->shown.air = (alpi_air){&job->field, job->options.lpv, job->options.scattering};
    if (job->options.scattering > 0.0f) {
        job->shown.surfaces.medium = alpi_air_medium(&job->shown.air);
    }
}

/// What the paths of RADIOSITY end with.
static alp_result prepare_solution(render_job *job)
{
    const alp_render_options *o = &job->options;
    if (o->method != ALP_RENDER_RADIOSITY || o->bounces == 0) {
        return ALP_OK;
    }
    const alpi_solution_options options = {.scene = job->scene,
                                           .tracer = job->tracer,
                                           .lighting = job->lighting,
                                           .atlas = o->atlas,
                                           .one_sided = o->occlusion.one_sided,
                                           .bounces = o->bounces,
                                           .tolerance = alpi_radiosity_tolerance(o->bounces),
                                           .seed = o->occlusion.seed};
    ALP_TRY(alpi_solution_create(&options, o->progress, o->progress_user, &job->solution));
    job->known = alpi_solution_light(job->solution);
    job->reference.known = &job->known;
    return ALP_OK;
}

static alp_result prepare_paths(render_job *job, alp_image_info info)
{
    const alp_render_options *o = &job->options;
    ALP_TRY(alpi_examine_light(job->tracer, job->occlusion.filter, job->scene, job->lighting,
                               o->progress, o->progress_user));
    const uint32_t limit = ALPI_REFERENCE_BOUNCE_LIMIT;
    if (o->without_direct) {
        ALP_TRY(alpi_lighting_create_without_lamps(job->scene, &o->lighting, &job->first));
    }
    job->reference = (alpi_reference){.context = job->scene->context,
                                      .scene = job->scene,
                                      .tracer = job->tracer,
                                      .lighting = job->lighting,
                                      .direct = job->first,
                                      .filter = job->occlusion.filter,
                                      .bounces = o->bounces < limit ? o->bounces : limit,
                                      .samples = o->samples,
                                      .next_event = !o->no_next_event,
                                      .seed = o->occlusion.seed};
    ALP_TRY(prepare_solution(job));
    return o->error != NULL ? alp_image_create(job->scene->context, info, &job->error) : ALP_OK;
}

/// What methods need that light the scene, or show its light.
static alp_result prepare_light(render_job *job, alp_image_info info)
{
    if (!goes_by_paths(job) && !goes_by_shown(job)) {
        return ALP_OK;
    }
    ALP_TRY(alpi_lighting_create(job->scene, &job->options.lighting, &job->lighting));
    if (goes_by_paths(job)) {
        return prepare_paths(job, info);
    }
    if (job->options.method == ALP_RENDER_FIELD) {
        prepare_field(job);
    } else {
        prepare_lightmap(job);
    }
    return ALP_OK;
}

/// Draws the object and the overlay over the picture.
static alp_result draw_objects(render_job *job)
{
    const alp_render_options *o = &job->options;
    alpi_object_pass pass = {.scene = job->scene,
                             .tracer = job->tracer,
                             .view = &job->view,
                             .options = o,
                             .field = &job->field,
                             .reference =
                                 o->method == ALP_RENDER_REFERENCE ? &job->reference : NULL};
    const bool lit = o->method == ALP_RENDER_REFERENCE || o->method == ALP_RENDER_FIELD;
    if (o->object.kind != ALP_OBJECT_NONE && lit) {
        ALP_TRY(alpi_object_pass_draw(&pass, job->image));
    }
    pass.probes = o->overlay;
    return o->overlay != NULL ? alpi_object_pass_draw(&pass, job->image) : ALP_OK;
}

static alp_result draw_hemicube(render_job *job)
{
    const alpi_hemicube_view view = {job->scene, &job->options, job->tracer, job->view.origin,
                                     job->view.forward};
    return alpi_hemicube_view_draw(&view, &job->image);
}

static alp_result run(render_job *job)
{
    const alp_render_options *o = &job->options;
    ALP_TRY(place_camera(job));
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(job->scene, o->progress, o->progress_user, &tracer, NULL));
    job->tracer = tracer;
    warn_of_walls(job, tracer);
    if (o->method == ALP_RENDER_HEMICUBE) {
        return draw_hemicube(job);
    }
    alp_occlusion_options occlusion = o->occlusion;
    occlusion.samples =
        o->occlusion.samples / o->samples + (o->occlusion.samples % o->samples != 0);
    ALP_TRY(choose_occluders(job));
    ALP_TRY(alpi_occlusion_prepare(job->scene, job->occluders ? job->occluders : tracer, &occlusion,
                                   &job->occlusion));
    const alpi_sample_range all = {.count = job->occlusion.samples,
                                   .total = job->occlusion.samples};
    ALP_TRY(alpi_sample_run_create(&job->occlusion, false, &all, &job->occlusion_samples));
    alp_image_info info = {o->width, o->height, 4, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(job->scene->context, info, &job->image));
    ALP_TRY(prepare_light(job, info));
    alpi_task_progress progress = {.callback = o->progress,
                                   .user = o->progress_user,
                                   .stage = "render",
                                   .units_per_item = (double)o->samples,
                                   .units_are_rays = true};
    const uint32_t pixels = o->width * o->height;
    if (goes_by_paths(job)) {
        progress.units_per_item *= PIXELS_PER_RANGE;
        ALP_TRY(alpi_parallel_for(job->scene->context,
                                  pixels / PIXELS_PER_RANGE + (pixels % PIXELS_PER_RANGE != 0), 1,
                                  render_chunks, job, &progress));
        return draw_objects(job);
    }
    uint64_t rays = o->samples; // of a pixel, at most
    rays *= o->method == ALP_RENDER_AO ? 1 + job->occlusion.samples : 1;
    uint32_t grain = rays < RAYS_PER_RANGE / PIXELS_PER_RANGE ? PIXELS_PER_RANGE
                                                              : (uint32_t)(RAYS_PER_RANGE / rays);
    ALP_TRY(alpi_parallel_for(job->scene->context, pixels, grain > 0 ? grain : 1, render_range, job,
                              &progress));
    return draw_objects(job);
}

alp_result alp_render(const alp_scene *scene, const alp_render_options *options, alp_image **image)
{
    if (scene == NULL || image == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *image = NULL;
    render_job job = {.scene = scene, .options = options ? *options : alp_render_options_default()};
    if (job.options.error != NULL) {
        *job.options.error = NULL;
    }
    ALP_TRY(check_options(scene, &job.options));
    ALP_TRY(check_lit(&job));
    alp_result result = run(&job);
    alpi_sample_run_destroy(&job.occlusion_samples);
    alpi_occlusion_release(&job.occlusion);
    alpi_tracer_destroy(job.occluders);
    alpi_solution_destroy(job.solution);
    alpi_lighting_destroy(scene->context, job.first);
    alpi_lighting_destroy(scene->context, job.lighting);
    if (result == ALP_OK && job.options.error != NULL) {
        *job.options.error = job.error;
    }
    if (result != ALP_OK) {
        alp_image_destroy(job.image);
        alp_image_destroy(job.error);
        return result;
    }
    *image = job.image;
    return ALP_OK;
}
