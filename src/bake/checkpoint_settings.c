// SPDX-License-Identifier: MIT
#include "bake/checkpoint_settings.h"

#include "base/hash.h"
#include "base/image.h"
#include "scene/lights/lighting_options.h"

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

static void add_scene(const alpi_bake_job *job, alpi_bytes *b)
{
    const alp_scene *scene = job->scene;
    add_text(b, "alpenglow", alp_version());
    add_text(b, "instructions", alpi_context_isa(job->context));
    add_hash(b, "SCENE-content", scene->input_hash);
    add_hash(b, "pose", alpi_scene_pose_hash(scene));
    add_hash(b, "images", alpi_scene_images_hash(scene));
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
        add_hash(b, "--sky-image", alpi_image_hash(ALPI_HASH_START, sky->image));
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
    add_hash(b, "--lamp", alpi_lamps_hash(ALPI_HASH_START, o));
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
