// SPDX-License-Identifier: MIT
// Every figure of a bake's report, by name, for its page.
#include "report/report_parts.h"

#include <math.h>
#include <stdio.h>

static void put_fact(alpi_page *page, const char *name, const char *value)
{
    alpi_page_format(page, "<dt>%s</dt><dd>%s</dd>\n", name, value);
}

static void put_count(alpi_page *page, const char *name, uint64_t count)
{
    put_fact(page, name, alpi_grouped(count).text);
}

/// @param of what the errors are relative to
static void put_error(alpi_page *page, const char *name, double relative, double p99,
                      const char *of)
{
    if (!isfinite(relative)) {
        put_fact(page, name, "unknown");
        return;
    }
    alpi_page_format(page, "<dt>%s</dt><dd>%s of %s; 99\u00A0%% of the texels within %s</dd>\n",
                     name, alpi_percent(relative).text, of, alpi_percent(p99).text);
}

static void put_scene(alpi_page *page, const alp_scene *scene, const alp_bake_report *r)
{
    alpi_page_put(page, "<dt>Scene</dt><dd><bdi>");
    alpi_page_text(page, scene->name, 1000);
    alpi_page_put(page, "</bdi></dd>\n");
    put_count(page, "Triangles", r->scene.triangles);
    if (r->scene.usable_triangles < r->scene.triangles) {
        put_count(page, "of them usable", r->scene.usable_triangles);
    }
    alpi_page_format(page, "<dt>Surfaces baked</dt><dd>%s of %s</dd>\n",
                     alpi_grouped(r->surfaces_baked).text, alpi_grouped(r->scene.surfaces).text);
    alpi_page_format(page, "<dt>Area</dt><dd>%s m²</dd>\n",
                     alpi_significant(r->scene.area, 4).text);
}

static void put_atlas(alpi_page *page, const alp_bake_report *r)
{
    const alp_atlas_info *a = &r->atlas;
    if (a->mode == ALP_ATLAS_VERTEX) {
        put_count(page, "Vertices of different position or normal", r->vertices);
        return;
    }
    alpi_page_format(page, "<dt>Atlas</dt><dd>%s; %u page%s of %u × %u</dd>\n",
                     a->mode == ALP_ATLAS_KEEP    ? "the scene’s own coordinates"
                     : a->mode == ALP_ATLAS_BLEND ? "charts of three axes, blended"
                                                  : "charts",
                     a->pages, a->pages == 1 ? "" : "s", a->width, a->height);
    put_count(page, "Charts", a->charts);
    alpi_page_format(page, "<dt>Texels</dt><dd>%s, %s of the pages used</dd>\n",
                     alpi_grouped(a->texels).text, alpi_percent(a->utilisation).text);
    put_fact(page, "Texels per metre", alpi_significant(a->texels_per_metre, 4).text);
    alpi_page_format(page, "<dt>Stretch</dt><dd>mean %s, worst %s; density spread %s</dd>\n",
                     alpi_significant(a->stretch_mean, 3).text,
                     alpi_significant(a->stretch_worst, 3).text,
                     alpi_significant(a->density_spread, 3).text);
    alpi_page_format(
        page, "<dt>Flipped triangles</dt><dd>%s; slivers: %s; overlapping texels: %s</dd>\n",
        alpi_grouped(a->flipped_triangles).text, alpi_grouped(a->sliver_triangles).text,
        alpi_grouped(a->overlapping_texels).text);
}

static void put_occlusion(alpi_page *page, const alp_bake_report *r)
{
    const bool at_vertices = r->atlas.mode == ALP_ATLAS_VERTEX;
    put_count(page, at_vertices ? "Occlusion: rays a vertex" : "Occlusion: rays a texel",
              r->ao_samples);
    if (isfinite(r->ao_distance)) {
        alpi_page_format(page, "<dt>Occlusion: distance limit</dt><dd>%s m</dd>\n",
                         alpi_significant((double)r->ao_distance, 4).text);
    } else {
        put_fact(page, "Occlusion: distance limit", "none");
    }
    put_fact(page, "Mean accessibility", alpi_fixed(r->ao_mean, 4).text);
    if (at_vertices) {
        return; // no error is stated
    }
    put_error(page, "Stated error of occlusion", r->ao_relative_error, r->ao_p99_error, "the mean");
    alpi_page_format(page, "<dt>Texels traced</dt><dd>%s, and %s interpolated</dd>\n",
                     alpi_grouped(r->traced).text, alpi_grouped(r->interpolated).text);
}

static void put_light(alpi_page *page, const alp_bake_report *r)
{
    put_count(page,
              r->light_direct       ? "Light: samples of each light"
              : r->light_passes > 0 ? "Light: rays a texel"
                                    : "Light: paths a texel",
              r->light_samples);
    alpi_page_format(page, "<dt>Mean irradiance</dt><dd>%s W/m²</dd>\n",
                     alpi_significant(r->light_mean, 4).text);
    char scale[64] = "the mean";
    if (r->light_scale > r->light_mean) {
        snprintf(scale, sizeof scale, "%.3g W/m², for the surfaces emit far more", r->light_scale);
    }
    put_error(page, "Stated error of irradiance", r->light_relative_error, r->light_p99_error,
              scale);
}

/// Where the light goes, in watts.
static void put_energy(alpi_page *page, const alp_light_energy *e)
{
    if (!e->known) {
        return;
    }
    alpi_page_format(page, "<dt>Light emitted</dt><dd>%s W: absorbed %s, ",
                     alpi_significant(e->emitted, 4).text, alpi_significant(e->absorbed, 4).text);
    alpi_page_format(page, "escaped %s, into black backs %s, not followed further %s</dd>\n",
                     alpi_significant(e->escaped, 3).text, alpi_significant(e->behind, 3).text,
                     alpi_significant(e->unshot, 2).text);
}

/// @param noise the map's stated error, over its mean, for comparison; not finite: unknown
static void put_seam_error(alpi_page *page, const char *name, bool stitched,
                           const alp_seam_error *e, double noise)
{
    if (!isfinite(e->mean)) {
        return;
    }
    alpi_page_format(page, "<dt>%s</dt><dd>%s of the mean; 99\u00A0%% of their length within %s",
                     name, alpi_percent(e->mean).text, alpi_percent(e->p99).text);
    if (stitched) {
        alpi_page_format(page, "; stitched %s and %s", alpi_percent(e->stitched_mean).text,
                         alpi_percent(e->stitched_p99).text);
    }
    if (isfinite(noise)) {
        alpi_page_format(page, "; the map's noise is %s", alpi_percent(noise).text);
    }
    alpi_page_put(page, "</dd>\n");
}

/// How far the sides of seams are apart.
static void put_seams(alpi_page *page, const alp_bake_report *r)
{
    const alp_seam_report *s = &r->seams;
    if (r->atlas.mode == ALP_ATLAS_VERTEX) {
        return;
    }
    alpi_page_format(page, "<dt>Seams</dt><dd>%s m, along %s edges</dd>\n",
                     alpi_significant(s->length, 4).text, alpi_grouped(s->count).text);
    if (s->count > 0 && (r->maps & ALP_MAP_AO) != 0) {
        put_seam_error(page, "Steps of occlusion at seams", s->stitched, &s->ao,
                       r->ao_relative_error);
    }
    if (s->count > 0 && (r->maps & ALP_MAP_OBSCURANCE) != 0) {
        put_seam_error(page, "Steps of obscurance at seams", s->stitched, &s->obscurance,
                       (double)NAN);
    }
    if (s->count > 0 && (r->maps & ALP_MAP_LIGHT) != 0) {
        put_seam_error(page, "Steps of irradiance at seams", s->stitched, &s->light,
                       r->light_relative_error);
    }
}

/// What happened to texels that are not like the others, as far as there are any.
static void put_odd_texels(alpi_page *page, const alp_bake_report *r)
{
    if (r->moved > 0) {
        put_count(page, "Texels partly inside other objects", r->moved);
    }
    if (r->dropped > 0) {
        put_count(page, "Texels inside other objects, filled from beside", r->dropped);
    }
    if (r->unknown > 0) {
        put_count(page, "Texels without a value of their own", r->unknown);
    }
}

void alpi_report_put_facts(alpi_page *page, const alp_scene *scene, const alp_bake_report *r)
{
    char hash[24];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)r->input_hash);
    alpi_page_put(page, "<section id=\"facts\"><h2>What was baked</h2>\n<dl class=\"facts\">\n");
    put_scene(page, scene, r);
    put_atlas(page, r);
    if ((r->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0) {
        put_occlusion(page, r);
    }
    if ((r->maps & ALP_MAP_LIGHT) != 0) {
        put_light(page, r);
        put_energy(page, &r->light_energy);
    }
    put_seams(page, r);
    put_odd_texels(page, r);
    put_count(page,
              r->light_samples > 0 && !r->light_direct && r->light_passes == 0 ? "Rays and paths"
                                                                               : "Rays",
              r->rays);
    put_fact(page, "Peak of our memory", alpi_bytes(r->peak_memory_bytes).text);
    put_count(page, "Threads", r->threads);
    put_count(page, "Seed", r->seed);
    put_fact(page, "Input hash", hash);
    put_fact(page, "Reproducible", r->cut_off ? "no: sampling was cut off" : "yes, to the bit");
    alpi_page_put(page, "</dl></section>\n");
}
