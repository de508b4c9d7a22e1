// SPDX-License-Identifier: MIT
// The summary of alpenglow bake.
#include "bake_options.h"
#include "output.h"
#include "printing/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void print_atlas(const alp_atlas_info *atlas)
{
    printf("atlas      %s, %u page%s of %u x %u, %u chart%s, %llu texel%s, %.1f %% used, "
           "%.4g texels per metre\n",
           atlas_mode_name(atlas->mode), atlas->pages, plural(atlas->pages), atlas->width,
           atlas->height, atlas->charts, plural(atlas->charts), (unsigned long long)atlas->texels,
           plural(atlas->texels), 100.0 * atlas->utilisation, atlas->texels_per_metre);
    printf("stretch    mean %.3f, worst %.3f, density spread %.3f; %u triangle%s flipped, ",
           atlas->stretch_mean, atlas->stretch_worst, atlas->density_spread,
           atlas->flipped_triangles, plural(atlas->flipped_triangles));
    if (atlas->sliver_triangles > 0) {
        printf("%u sliver%s, ", atlas->sliver_triangles, plural(atlas->sliver_triangles));
    }
    printf("%llu texel%s\n", (unsigned long long)atlas->overlapping_texels,
           atlas->overlapping_texels == 1 ? " overlaps" : "s overlap");
}

/// Prints names of files, with the ending of the maps' format for .exr.
static void print_files(const alp_bake_options *o, const char *files)
{
    const char *ending = o->maps_format == ALP_MAPS_HDR    ? ".hdr"
                         : o->maps_format == ALP_MAPS_KTX2 ? ".ktx2"
                                                           : ".exr";
    for (const char *next; (next = strstr(files, ".exr")) != NULL; files = next + 4) {
        printf("%.*s%s", (int)(next - files), files, ending);
    }
    printf("%s", files);
}

static void print_maps(const alp_bake_options *o, unsigned maps, uint32_t pages)
{
    static const struct {
        alp_map map;
        const char *files;
    } of_maps[] = {{ALP_MAP_AO, "ao.exr, ao.png, ao.error.exr, ao.sampling.png"},
                   {ALP_MAP_BENT, "bent.exr, bent.png"},
                   {ALP_MAP_LIGHT, "irradiance.exr, irradiance.error.exr"},
                   {ALP_MAP_DIRECT, "irradiance.direct.exr"},
                   {ALP_MAP_BOUNCED, "irradiance.bounced.exr"},
                   {ALP_MAP_SH, "sh.0.exr to sh.3.exr"},
                   {ALP_MAP_DIRECTION, "direction.exr"},
                   {ALP_MAP_OBSCURANCE, "obscurance.exr, obscurance.png"}};
    const char *separator = "";
    printf("maps       %s/", o->maps_folder);
    for (size_t i = 0; i < sizeof of_maps / sizeof *of_maps; i++) {
        if ((maps & (unsigned)of_maps[i].map) != 0) {
            printf("%s", separator);
            print_files(o, of_maps[i].files);
            separator = ", ";
        }
    }
    printf("%s\n", pages > 1 ? " and further pages" : "");
}

static void print_vertices(const alp_bake_options *o, const alp_bake_report *r)
{
    printf("vertices   %u of different position or normal, %u triangle%s, values in %s\n",
           r->vertices, r->scene.usable_triangles, plural(r->scene.usable_triangles),
           o->vertex_attribute == ALP_VERTEX_COLOR ? "COLOR_0" : "_OCCLUSION");
}

/// Ends the line of a map. @param p99 bound for 99 % of the standard errors
/// @param of what the errors are relative to
static void print_stated_error(double relative, double p99, const char *of)
{
    if (isfinite(relative)) {
        printf("; stated error ");
        print_percent(stdout, relative);
        printf(" of %s, 99 %% of the texels within ", of);
        print_percent(stdout, p99);
        putchar('\n');
    } else {
        printf("; error unknown\n");
    }
}

static void print_occlusion(const command_line *a, const alp_bake_report *r)
{
    printf("occlusion  %u ray%s per %s, ", r->ao_samples, plural(r->ao_samples),
           r->atlas.mode == ALP_ATLAS_VERTEX ? "vertex" : "texel");
    if (isinf(r->ao_distance)) {
        printf("no distance limit");
    } else {
        const bool is_auto = a->values[OPTION_AO_DISTANCE].choice == 0;
        const bool is_self = a->values[OPTION_AO_SELF].given;
        printf("to %s%.4g m%s", is_auto && is_self ? "at most " : "", (double)r->ao_distance,
               !is_auto  ? ""
               : is_self ? " (auto: 20 % of each object's diagonal)"
                         : " (auto: 20 % of the scene's diagonal)");
    }
    printf("; mean accessibility %.4f\n", r->ao_mean);
    if (r->atlas.mode == ALP_ATLAS_VERTEX) {
        return; // no texels, no stated error
    }
    printf("sampling   %llu texel%s traced, %llu interpolated", (unsigned long long)r->traced,
           plural(r->traced), (unsigned long long)r->interpolated);
    if (r->dropped > 0) {
        printf(", %llu inside other objects filled", (unsigned long long)r->dropped);
    }
    if (r->unknown > 0) {
        printf(", %llu without a value filled", (unsigned long long)r->unknown);
    }
    print_stated_error(r->ao_relative_error, r->ao_p99_error, "the mean");
}

static void print_light(const alp_bake_options *o, const alp_bake_report *r)
{
    printf("light      %u %s%s%s per texel, ", r->light_samples,
           r->light_direct                       ? "sample"
           : o->light.gather == ALP_GATHER_PATHS ? "path"
                                                 : "ray",
           plural(r->light_samples), r->light_direct ? " of each light" : "");
    if (r->light_direct) {
        printf("no bounce");
    } else if (o->light.bounces == ALP_BOUNCES_CONVERGE) {
        printf("all bounces");
    } else {
        printf("%u bounce%s", o->light.bounces, plural(o->light.bounces));
    }
    if (r->light_interpolated > 0) {
        printf("; %.0f %% of the texels gathered, the rest interpolated",
               100.0 * (double)r->light_traced / (double)(r->light_traced + r->light_interpolated));
    }
    printf("; mean irradiance %.4g W/m2", r->light_mean);
    char scale[64] = "the mean";
    if (r->light_scale > r->light_mean) {
        snprintf(scale, sizeof scale, "%.3g W/m2, for the surfaces emit far more", r->light_scale);
    }
    print_stated_error(r->light_relative_error, r->light_p99_error, scale);
    const alp_light_energy *e = &r->light_energy;
    if (r->light_passes > 0 && e->known) {
        printf(
            "energy     emitted %.4g W; absorbed %.4g, escaped %.4g, behind surfaces %.4g, not yet "
            "reflected %.2g; %+.2g %% off\n",
            e->emitted, e->absorbed, e->escaped, e->behind, e->unshot,
            100.0 * (e->absorbed + e->escaped + e->behind + e->unshot - e->emitted) /
                (e->emitted > 0.0 ? e->emitted : 1.0));
    }
}

/// Prints the difference of one map across its seams.
/// @param noise the map's stated error, over its mean, for comparison; not finite: unknown
static void print_seam_error(const alp_seam_report *s, const char *map, const alp_seam_error *e,
                             double noise)
{
    if (isfinite(e->mean)) {
        printf("; %s ", map);
        print_percent(stdout, e->mean);
        printf(" of the mean, 99 %% within ");
        print_percent(stdout, e->p99);
    }
    if (isfinite(e->mean) && s->stitched) {
        printf(", stitched ");
        print_percent(stdout, e->stitched_mean);
        printf(", within ");
        print_percent(stdout, e->stitched_p99);
    }
    if (isfinite(e->mean) && isfinite(noise)) {
        printf(", noise ");
        print_percent(stdout, noise);
    }
}

static void print_seams(const alp_bake_report *r)
{
    const alp_seam_report *s = &r->seams;
    if (s->count == 0) {
        printf("seams      none\n");
        return;
    }
    printf("seams      %.4g m along %u edge%s", s->length, s->count, plural(s->count));
    if ((r->maps & ALP_MAP_AO) != 0) {
        print_seam_error(s, "occlusion", &s->ao, r->ao_relative_error);
    }
    if ((r->maps & ALP_MAP_OBSCURANCE) != 0) {
        print_seam_error(s, "obscurance", &s->obscurance, (double)NAN);
    }
    if ((r->maps & ALP_MAP_LIGHT) != 0) {
        print_seam_error(s, "light", &s->light, r->light_relative_error);
    }
    printf("\n");
}

static void print_layers(const alp_bake_options *o, const alp_lightmap *lightmap)
{
    const uint32_t count = alp_lightmap_layer_count(lightmap);
    for (uint32_t i = 0; i < count; i++) {
        printf("%sirradiance.%s", i == 0 ? "layers     " : ", ",
               alp_lightmap_layer_name(lightmap, i));
        print_files(o, i + 1 == count ? ".exr\n" : ".exr");
    }
}

void bake_summary_print(const session *s, const command_line *a, const alp_lightmap *lightmap,
                        const alp_bake_options *o, const alp_bake_report *r)
{
    if (o->output != NULL) {
        printf("wrote      %s\n", o->output);
    }
    if (o->maps_folder != NULL) {
        print_maps(o, r->maps, r->atlas.pages);
        print_layers(o, lightmap);
    }
    if (o->only != NULL) {
        printf("surfaces   %u of %u baked\n", r->surfaces_baked, r->scene.surfaces);
    }
    if (r->atlas.mode == ALP_ATLAS_VERTEX) {
        print_vertices(o, r);
    } else {
        print_atlas(&r->atlas);
    }
    if ((o->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0) {
        print_occlusion(a, r);
    }
    if ((o->maps & ALP_MAP_LIGHT) != 0) {
        print_light(o, r);
    }
    if (r->atlas.mode != ALP_ATLAS_VERTEX) {
        print_seams(r);
    }
    printf(
        "time       %.2f s: load %.2f, atlas %.2f, build %.2f, rays %.2f, seams %.2f, write %.2f",
        s->load_seconds + r->seconds_total, s->load_seconds, r->seconds_atlas, r->seconds_build,
        r->seconds_bake, r->seconds_seams, r->seconds_write);
    if (r->seconds_bake > 0.0 && (r->maps & ALP_MAP_LIGHT) == 0) { // paths are several rays each
        printf("; %.3g Mrays/s", 1e-6 * (double)r->rays / r->seconds_bake);
    }
    putchar('\n');
}
