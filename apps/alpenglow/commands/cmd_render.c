// SPDX-License-Identifier: MIT
// alpenglow render: a picture of a scene from one of its cameras.
#include "commands/commands.h"
#include "interrupt.h"
#include "output.h"
#include "picture_fields.h"
#include "session.h"
#include "setup/cameras.h"
#include "setup/film.h"
#include "setup/lighting.h"
#include "setup/lightmaps.h"
#include "setup/objects.h"
#include "views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Methods and fields of the choices of --with, in their order.
static const struct {
    alp_render_method method;
    picture_field field; // of FIELD
} methods[] = {{.method = ALP_RENDER_AO},
               {.method = ALP_RENDER_ALBEDO},
               {.method = ALP_RENDER_REFERENCE},
               {.method = ALP_RENDER_LIGHTMAP},
               {.method = ALP_RENDER_RADIOSITY},
               {.method = ALP_RENDER_HEMICUBE},
               {ALP_RENDER_FIELD, {FIELD_OTHER, ALP_AMBIENT_CONSTANT}},
               {ALP_RENDER_FIELD, {FIELD_OTHER, ALP_AMBIENT_HEMISPHERE}},
               {ALP_RENDER_FIELD, {FIELD_OTHER, ALP_AMBIENT_GROUND_MAP}},
               {ALP_RENDER_FIELD, {FIELD_OTHER, ALP_AMBIENT_CUBE}},
               {ALP_RENDER_FIELD, {FIELD_OTHER, ALP_AMBIENT_ENVIRONMENT}},
               {ALP_RENDER_FIELD, {.model = FIELD_PROBES}},
               {ALP_RENDER_FIELD, {.model = FIELD_AMBIENCE}},
               {ALP_RENDER_FIELD, {.model = FIELD_LPV}}};

static field_model model_of(const command_line *a)
{
    return methods[a->values[OPTION_WITH].choice].field.model;
}

enum { FIELD = 1 << ALP_RENDER_FIELD, AO = 1 << ALP_RENDER_AO };
enum { LIGHTMAP = 1 << ALP_RENDER_LIGHTMAP, HEMICUBE = 1 << ALP_RENDER_HEMICUBE };
enum { RADIOSITY = 1 << ALP_RENDER_RADIOSITY, REFERENCE = 1 << ALP_RENDER_REFERENCE };
enum { TEXELS = LIGHTMAP | RADIOSITY | HEMICUBE };
enum { LIT = REFERENCE | TEXELS | FIELD, PLAIN = ~HEMICUBE };
enum { ALBEDO = LIT | 1 << ALP_RENDER_ALBEDO };
enum { PROBES_ONLY = 1 << 30 };

/// Options that some methods use alone.
static const struct {
    option_id id;
    unsigned methods;
} read_by[] = {{OPTION_RESOLUTION, (unsigned)PLAIN},
               {OPTION_SAMPLES, (unsigned)PLAIN},
               {OPTION_SHOW, HEMICUBE},
               {OPTION_HEMICUBE, HEMICUBE},
               {OPTION_SIZE, TEXELS},
               {OPTION_ATLAS, LIGHTMAP},
               {OPTION_STITCH, LIGHTMAP},
               {OPTION_TEXEL_SAMPLES, LIGHTMAP},
               {OPTION_QUALITY, LIGHTMAP},
               {OPTION_ERROR, LIGHTMAP},
               {OPTION_GATHER, LIGHTMAP},
               {OPTION_BOUNCES, LIT},
               {OPTION_SUN, LIT},
               {OPTION_SUN_SIZE, LIT},
               {OPTION_LAMP, LIT},
               {OPTION_SPOT, LIT},
               {OPTION_METALS, ALBEDO},
               {OPTION_SKY_TURN, LIT},
               {OPTION_SKY, LIT},
               {OPTION_SKY_STRENGTH, LIT},
               {OPTION_DIRECT, REFERENCE | RADIOSITY | FIELD},
               {OPTION_OBJECT, REFERENCE | FIELD},
               {OPTION_PROBES, PROBES_ONLY},
               {OPTION_SPACING, PROBES_ONLY},
               {OPTION_BOUNDS, PROBES_ONLY},
               {OPTION_LOOKUP, PROBES_ONLY},
               {OPTION_OVERLAY, PROBES_ONLY},
               {OPTION_OCCLUDERS, AO},
               {OPTION_AO_SAMPLES, AO},
               {OPTION_AO_DISTANCE, AO},
               {OPTION_AO_FALLOFF, AO},
               {OPTION_AO_CONE, AO},
               {OPTION_AO_DISTRIBUTION, AO}};

/// Refuses options that a method does not use.
static int check_method(const command_line *a, const alp_render_options *o)
{
    const unsigned own =
        1u << o->method | (model_of(a) == FIELD_PROBES ? (unsigned)PROBES_ONLY : 0u);
    for (size_t i = 0; i < sizeof read_by / sizeof *read_by; i++) {
        if ((read_by[i].methods & own) == 0 && a->values[read_by[i].id].given) {
            return usage_error(COMMAND_RENDER, "%s: does not apply to --with %s",
                               option_name(COMMAND_RENDER, read_by[i].id),
                               a->values[OPTION_WITH].text);
        }
    }
    return EXIT_DONE;
}

/// --hemicube and --show.
static int read_hemicube(const command_line *a, alp_render_options *o)
{
    o->hemicube = (uint32_t)a->values[OPTION_HEMICUBE].whole;
    o->hemicube_show = (alp_hemicube_show)a->values[OPTION_SHOW].choice;
    if (o->method != ALP_RENDER_HEMICUBE) {
        return EXIT_DONE;
    }
    if (o->hemicube % 2 != 0) {
        return usage_error(COMMAND_RENDER, "--hemicube %u: give an even number", o->hemicube);
    }
    o->width = o->height = 2 * o->hemicube;
    return EXIT_DONE;
}

static int read_options(const command_line *a, alp_render_options *o, lamp_list *lamps)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    *o = alp_render_options_default();
    if (output == NULL) {
        return usage_error(COMMAND_RENDER, "no output; give -o IMAGE.png, -o IMAGE.exr or -o "
                                           "IMAGE.hdr");
    }
    bool linear = !path_ends(output, ".png");
    if (linear && !path_ends(output, ".exr") && !path_ends(output, ".hdr")) {
        return usage_error(COMMAND_RENDER, "-o %s: the name must end in .png, .exr or .hdr",
                           output);
    }
    if (!a->values[OPTION_WITH].given) {
        return usage_error(COMMAND_RENDER,
                           "no method; give --with reference, radiosity, "
                           "lightmap, probes, ambience, lpv, ao, albedo or another");
    }
    o->method = methods[a->values[OPTION_WITH].choice].method;
    o->without_direct = a->values[OPTION_DIRECT].choice == 0;
    o->samples = (uint32_t)a->values[OPTION_SAMPLES].whole;
    o->occluders = a->values[OPTION_OCCLUDERS].text;
    o->atlas.size = (uint32_t)a->values[OPTION_SIZE].whole;
    int code = linear ? film_refuse(a, output) : EXIT_DONE;
    if (code == EXIT_DONE) {
        code = resolution_read(a, &o->width, &o->height);
    }
    if (code == EXIT_DONE) {
        code = camera_read(a, (const double[3]){0.0, 0.0, 0.0}, o);
    }
    code = code == EXIT_DONE ? occlusion_read(a, &o->occlusion) : code;
    code = code == EXIT_DONE ? check_method(a, o) : code;
    code = code == EXIT_DONE ? lightmap_check(a) : code;
    code = code == EXIT_DONE ? field_check(a, 1u << model_of(a)) : code;
    code = code == EXIT_DONE ? object_read(a, (const double[3]){0.0, 0.0, 0.0}, &o->object) : code;
    code = code == EXIT_DONE ? read_hemicube(a, o) : code;
    o->bounces = lighting_bounces(a);
    return code == EXIT_DONE ? lighting_read(a, &o->lighting, lamps) : code;
}

/// Places the camera and the object in the scene that was loaded.
static int place(const session *s, const command_line *a, alp_render_options *o)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    const int code = camera_find(s, a, o);
    return code == EXIT_DONE ? object_read(a, info.origin, &o->object) : code;
}

/// @param film options of development; returns the exposure that was used
static alp_result save(const alp_image *linear, const char *path, bool overwrite,
                       alp_film_options *film)
{
    if (!path_ends(path, ".png")) {
        return alp_image_save(linear, path, overwrite);
    }
    alp_image *display = NULL;
    alp_result result = alp_film_develop(linear, film, &display, &film->exposure);
    if (result == ALP_OK) {
        result = alp_image_save(display, path, overwrite);
    }
    alp_image_destroy(display);
    return result;
}

/// Makes the field of --with.
static int make_field(session *s, const command_line *a, alp_render_options *o,
                      field_source *source)
{
    const int code =
        picture_field_make(s, a, methods[a->values[OPTION_WITH].choice].field, o, source);
    o->gloss = a->values[OPTION_GLOSS].given;
    o->scattering = (float)a->values[OPTION_MEDIA].real;
    o->overlay = a->values[OPTION_OVERLAY].given ? source->probes : NULL;
    return code;
}

static alp_result make_picture(session *s, const command_line *a, alp_render_options *o,
                               alp_image **image)
{
    alp_lightmap *lightmap = NULL;
    alp_result result = ALP_OK;
    *image = NULL;
    bool found = false;
    if (o->method == ALP_RENDER_LIGHTMAP) {
        result = lightmap_find(s, a, &found);
    }
    if (o->method == ALP_RENDER_LIGHTMAP && result == ALP_OK && !found) {
        result = lightmap_bake(s, a, o, ALP_MAP_LIGHT, lightmap_layout_of(a), &lightmap);
        o->lightmap = lightmap;
    }
    if (result == ALP_OK) {
        result = alp_render(s->scene, o, image);
    }
    o->lightmap = NULL;
    alp_lightmap_destroy(lightmap);
    return result;
}

static int render(session *s, const command_line *a, alp_render_options *o)
{
    const char *output = a->values[OPTION_OUTPUT].text;
    alp_film_options film = film_read(a, o->method);
    alp_image *image = NULL;
    double start = clock_seconds();
    o->progress = session_progress;
    o->progress_user = s;
    field_source source = {0};
    interrupt_defer();
    const int made = o->method == ALP_RENDER_FIELD ? make_field(s, a, o, &source) : EXIT_DONE;
    if (made != EXIT_DONE) {
        field_source_clear(&source);
        return made;
    }
    o->field = source.field;
    alp_result result = make_picture(s, a, o, &image);
    field_source_clear(&source);
    double seconds = clock_seconds() - start;
    if (result == ALP_OK) {
        result = save(image, output, a->values[OPTION_FORCE].given, &film);
    }
    alp_image_destroy(image);
    int code = session_end(s, result);
    if (code == EXIT_DONE && !a->values[OPTION_QUIET].given) {
        printf("wrote      %s, %u x %u, load %.2f s, render %.2f s\n", output, o->width, o->height,
               s->load_seconds, seconds);
        if (film.auto_exposure && path_ends(output, ".png")) {
            printf("exposure   %.2f EV\n", film.exposure);
        }
    }
    return code == EXIT_DONE ? session_judge_warnings(s) : code;
}

int command_render(const command_line *a)
{
    alp_render_options options;
    lamp_list lamps;
    int code = read_options(a, &options, &lamps);
    if (code == EXIT_DONE) {
        code = output_check(a->values[OPTION_OUTPUT].text, a->values[OPTION_FORCE].given);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    session s;
    alp_image *sky;
    code = lighting_open(&s, a, &options.lighting, &lamps, &sky);
    if (code == EXIT_DONE) {
        code = place(&s, a, &options);
    }
    if (code == EXIT_DONE) {
        code = render(&s, a, &options);
    }
    alp_image_destroy(sky);
    session_close(&s);
    return code;
}
