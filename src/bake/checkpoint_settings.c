// SPDX-License-Identifier: MIT
#include "bake/checkpoint_settings.h"

#include "base/hash.h"
#include "base/tiles/tile_log.h"

#include <inttypes.h>
#include <string.h>

static void add_number(alpi_bytes *b, const char *name, double value)
{
    alpi_bytes_print(b, "%s ", name);
    if (value - value == 0.0) {
        alpi_bytes_number(b, value, 17);
    } else {
        alpi_bytes_print(b, "%s", value > 0.0 ? "inf" : "none");
    }
    alpi_bytes_print(b, "\n");
}

static void add_count(alpi_bytes *b, const char *name, uint64_t value)
{
    alpi_bytes_print(b, "%s %" PRIu64 "\n", name, value);
}

static void add_hash(alpi_bytes *b, const char *name, uint64_t hash)
{
    alpi_bytes_print(b, "%s %016" PRIx64 "\n", name, hash);
}

/// Text in one line: control characters become spaces.
static void add_text(alpi_bytes *b, const char *name, const char *text)
{
    alpi_bytes_print(b, "%s ", name);
    for (const char *c = text != NULL ? text : "none"; *c != '\0'; c++) {
        const char shown = (unsigned char)*c < ' ' ? ' ' : *c;
        alpi_bytes_add(b, &shown, 1);
    }
    alpi_bytes_print(b, "\n");
}

/// The word of a choice, as the command has it, or its number. @param words [count]
static void add_choice(alpi_bytes *b, const char *name, const char *const *words, size_t count,
                       int choice)
{
    if (choice >= 0 && (size_t)choice < count) {
        add_text(b, name, words[choice]);
    } else {
        add_number(b, name, (double)choice);
    }
}
#define ADD_CHOICE(b, name, words, choice)                                                         \
    add_choice(b, name, words, sizeof(words) / sizeof *(words), (int)(choice))

// --- the scene -----------------------------------------------------------------------------------

/// Fingerprint of the triangles, which a pose moves.
static uint64_t hash_shape(const alp_scene *scene)
{
    const uint64_t points = alpi_tile_checksum((const uint8_t *)scene->positions,
                                               scene->vertex_count * sizeof *scene->positions);
    return points ^ alpi_tile_checksum((const uint8_t *)scene->triangles,
                                       scene->triangle_count * sizeof *scene->triangles);
}

/// Fingerprint of the lights of the file. They have no padding in these fields.
static uint64_t hash_lights(const alp_scene *scene)
{
    uint64_t hash = ALPI_HASH_START;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const alpi_light *l = &scene->lights[i];
        const float values[] = {(float)l->kind, l->color.x,     l->color.y,     l->color.z,
                                l->intensity,   l->position.x,  l->position.y,  l->position.z,
                                l->direction.x, l->direction.y, l->direction.z, l->range,
                                l->inner_cone,  l->outer_cone,  l->size};
        hash = alpi_hash_bytes(hash, values, sizeof values);
    }
    return hash;
}

static uint64_t hash_image(const alp_image *image)
{
    const alp_image_info info = alp_image_get_info(image);
    const size_t size = info.component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1;
    const uint64_t pixels = alpi_tile_checksum(
        alp_image_pixels(image), (size_t)info.width * info.height * info.channels * size);
    const uint32_t shape[] = {info.width, info.height, info.channels, (uint32_t)size};
    return alpi_hash_bytes(pixels, shape, sizeof shape);
}

/// Fingerprint of the images that were read. The file's content does not hold them all.
static uint64_t hash_images(const alp_scene *scene)
{
    uint64_t hash = ALPI_HASH_START;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const uint64_t one = scene->images[i] != NULL ? hash_image(scene->images[i]) : 0;
        hash = alpi_hash_bytes(hash, &one, sizeof one);
    }
    return hash;
}

static void add_scene(const alpi_bake_job *job, alpi_bytes *b)
{
    const alp_scene *scene = job->scene;
    add_text(b, "alpenglow", alp_version());
    add_text(b, "instructions", alpi_context_isa(job->context));
    add_hash(b, "SCENE-content", scene->input_hash);
    add_hash(b, "triangles", hash_shape(scene));
    add_hash(b, "lights", hash_lights(scene));
    add_hash(b, "images", hash_images(scene));
    add_text(b, "--metals", scene->metals_black ? "black" : "diffuse");
}

// --- options -------------------------------------------------------------------------------------

static void add_maps(unsigned maps, alpi_bytes *b)
{
    static const char *const words[] = {
        "ao",      "bent", "light",     "ao-bleed", "direct",
        "bounced", "sh",   "direction", "probes"}; // bits of alp_map
    const char *separator = " ";
    alpi_bytes_print(b, "--maps");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if ((maps >> i & 1u) != 0) {
            alpi_bytes_print(b, "%s%s", separator, words[i]);
            separator = ",";
        }
    }
    alpi_bytes_print(b, "\n");
}

static void add_adaptive(float accuracy, alpi_bytes *b)
{
    if (accuracy == ALP_ADAPTIVE_AUTO || accuracy == ALP_ADAPTIVE_OFF) {
        add_text(b, "--adaptive", accuracy == ALP_ADAPTIVE_OFF ? "off" : "auto");
    } else {
        add_number(b, "--adaptive", (double)accuracy);
    }
}

static void add_atlas(const alp_atlas_options *o, alpi_bytes *b)
{
    static const char *const modes[] = {"auto", "keep", "charts", "vertex", "blend"};
    ADD_CHOICE(b, "--atlas", modes, o->mode);
    add_count(b, "--size", o->size);
    add_number(b, "--texels-per-metre", o->texels_per_metre);
    add_count(b, "--padding", o->padding);
    add_number(b, "max-angle", (double)o->max_angle);
    add_count(b, "--block", o->block);
    add_count(b, "--mips", o->mips);
    add_text(b, "--density", o->densities);
}

static void add_occlusion(const alp_bake_options *all, alpi_bytes *b)
{
    const alp_occlusion_options *o = &all->occlusion;
    add_count(b, "--ao-samples", o->samples);
    add_number(b, "--ao-distance", (double)o->distance);
    add_count(b, "--ao-falloff", (uint64_t)o->falloff);
    add_number(b, "--ao-cone", (double)o->cone);
    add_count(b, "--ao-distribution", (uint64_t)o->distribution);
    add_count(b, "--one-sided", o->one_sided);
    add_count(b, "--ao-self", all->ao_self);
    add_count(b, "--seed", o->seed);
    add_count(b, "--existing-ao", (uint64_t)all->existing_ao);
    add_count(b, "--ao-into", (uint64_t)all->ao_into);
}

static uint64_t hash_lamps(const alp_lighting_options *o)
{
    uint64_t hash = ALPI_HASH_START;
    for (uint32_t i = 0; i < o->lamp_count; i++) {
        const alp_lamp *l = &o->lamps[i];
        const float kind = (float)l->kind;
        hash = alpi_hash_bytes(hash, &kind, sizeof kind);
        hash = alpi_hash_bytes(hash, l->position, sizeof l->position);
        hash = alpi_hash_bytes(hash, l->direction, sizeof l->direction);
        hash = alpi_hash_bytes(hash, &l->intensity, sizeof l->intensity);
        hash = alpi_hash_bytes(hash, l->color, sizeof l->color);
        hash = alpi_hash_bytes(hash, &l->inner_cone, sizeof l->inner_cone);
        hash = alpi_hash_bytes(hash, &l->outer_cone, sizeof l->outer_cone);
    }
    return hash;
}

static void add_lighting(const alp_lighting_options *o, alpi_bytes *b)
{
    const alp_sky_options *sky = &o->sky;
    const alp_sun_options *sun = &o->sun;
    static const char *const kinds[] = {"none", "even", "up and down", "image", "clear"};
    ADD_CHOICE(b, "--sky", kinds, sky->kind);
    for (int k = 0; k < 3; k++) {
        add_number(b,
                   k == 0   ? "--sky-red"
                   : k == 1 ? "--sky-green"
                            : "--sky-blue",
                   (double)sky->up[k]);
        add_number(b,
                   k == 0   ? "--sky-red-down"
                   : k == 1 ? "--sky-green-down"
                            : "--sky-blue-down",
                   (double)sky->down[k]);
        add_number(b,
                   k == 0   ? "--sun-red"
                   : k == 1 ? "--sun-green"
                            : "--sun-blue",
                   (double)sun->color[k]);
    }
    if (sky->kind == ALP_SKY_IMAGE && sky->image != NULL) {
        add_hash(b, "--sky-image", hash_image(sky->image));
    }
    add_number(b, "--sky-turn", (double)sky->turn);
    add_number(b, "--sky-strength", (double)sky->strength);
    add_number(b, "turbidity", (double)sky->turbidity);
    add_number(b, "--sun-azimuth", (double)sun->azimuth);
    add_number(b, "--sun-elevation", (double)sun->elevation);
    add_number(b, "--sun-illuminance", (double)sun->illuminance);
    add_number(b, "--sun-size", (double)sun->size);
    add_number(b, "file-sun-size", (double)o->file_sun_size);
    add_count(b, "lamps", o->lamp_count);
    add_hash(b, "--lamp", hash_lamps(o));
}

static void add_light(const alp_bake_options *all, alpi_bytes *b)
{
    static const char *const gatherers[] = {"rays", "hemicube", "paths"};
    static const char *const direct[] = {"on", "off", "apart"};
    const alp_light_options *o = &all->light;
    add_lighting(&o->lighting, b);
    ADD_CHOICE(b, "--gather", gatherers, o->gather);
    ADD_CHOICE(b, "--direct", direct, o->direct);
    if (o->bounces == ALP_BOUNCES_CONVERGE) {
        add_text(b, "--bounces", "converge");
    } else {
        add_count(b, "--bounces", o->bounces);
    }
    add_number(b, "light-error", (double)o->error);
    add_count(b, "bounded", o->bounded);
    add_count(b, "--samples", o->samples);
    add_count(b, "--denoise", o->denoise);
    add_count(b, "--hemicube", o->hemicube);
    add_count(b, "--emitters", (uint64_t)o->emitters);
    add_count(b, "--layers", o->layers);
}

static void add_probes(const alp_probe_options *o, alpi_bytes *b)
{
    uint64_t hash = ALPI_HASH_START;
    if (o == NULL) {
        return;
    }
    if (o->positions != NULL) {
        hash = alpi_hash_bytes(hash, o->positions, o->position_count * sizeof *o->positions);
    }
    hash = alpi_hash_bytes(hash, o->bounds_min, sizeof o->bounds_min);
    hash = alpi_hash_bytes(hash, o->bounds_max, sizeof o->bounds_max);
    add_number(b, "--spacing", (double)o->spacing);
    add_hash(b, "probe-places", hash);
    add_count(b, "--basis", (uint64_t)o->basis);
    add_count(b, "--visibility", o->visibility);
    add_count(b, "--gradients", o->gradients);
    add_count(b, "probe-rays", o->rays);
    add_count(b, "probe-direct", o->direct);
    add_count(b, "probe-atlas", o->atlas_size);
}

alpi_bytes alpi_bake_settings(const alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    alpi_bytes b = alpi_bytes_create(job->context);
    add_scene(job, &b);
    add_maps(o->maps, &b);
    add_atlas(&o->atlas, &b);
    add_occlusion(o, &b);
    add_light(o, &b);
    add_probes(o->probes, &b);
    add_adaptive(o->sampling.accuracy, &b);
    add_number(&b, "--error", (double)o->sampling.error);
    add_count(&b, "--memory-limit", o->sampling.memory_limit);
    add_count(&b, "--stitch", o->stitch);
    add_text(&b, "--only", o->only);
    add_text(&b, "--occluders", o->occluders);
    add_count(&b, "shards", o->checkpoint.shards);
    return b;
}
