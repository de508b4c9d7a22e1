// SPDX-License-Identifier: MIT
// The page about a bake: one file of HTML that needs nothing else.
#include "report/report_parts.h"

#include "base/memory.h"

#include <alpenglow/doctor.h>
#include <alpenglow/report.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FINDING_LIMIT = 200, TEXT_LIMIT = 2000, WORD_LIMIT = 2000 };

alp_report_options alp_report_options_default(void)
{
    return (alp_report_options){.struct_size = sizeof(alp_report_options), .picture_samples = 8};
}

/// The parts of the page.
typedef struct report_job {
    const alp_scene *scene;
    const alp_lightmap *lightmap;
    const alp_bake_report *report;
    alp_report_options options;
    alpi_report_pictures pictures;
    bool at_vertices; // no pages, no pictures
} report_job;

/// Lines break between its words alone: an option cut at a hyphen is hard to read.
static void put_command(alpi_page *page, const char *command)
{
    char *words = alpi_copy_string(page->context, command);
    if (words == NULL) {
        page->result = ALP_ERROR_OUT_OF_MEMORY;
        return;
    }
    alpi_page_put(page, "<code class=\"command\">");
    for (char *word = words; word != NULL;) {
        char *rest = strchr(word, ' ');
        if (rest != NULL) {
            *rest++ = '\0';
        }
        alpi_page_put(page, "<span>");
        alpi_page_text(page, word, WORD_LIMIT);
        alpi_page_put(page, rest != NULL ? "</span> " : "</span>");
        word = rest;
    }
    alpi_page_put(page, "</code>\n");
    alpi_release(page->context, words);
}

static void put_head(alpi_page *page, const report_job *job)
{
    // The policy keeps a promise of the head: nothing is loaded, nothing runs.
    alpi_page_put(page, "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" "
                        "lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
                        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                        "'none'; style-src 'unsafe-inline'; img-src data:\"/>\n"
                        "<meta name=\"viewport\" content=\"width=device-width, "
                        "initial-scale=1\"/>\n"
                        "<meta name=\"generator\" content=\"alpenglow report\"/>\n<title>");
    alpi_page_text(page, job->scene->name, ALPI_REPORT_NAME);
    alpi_page_put(page, " – bake report</title>\n<style>\n");
    alpi_report_put_style(page);
    alpi_page_format(page,
                     "</style>\n</head>\n<body>\n<header>\n<p class=\"kicker\">Alpenglow %s · "
                     "bake report</p>\n<h1><bdi>",
                     alp_version());
    alpi_page_text(page, alpi_path_name(job->scene->name), ALPI_REPORT_NAME);
    alpi_page_put(page, "</bdi></h1>\n");
    if (job->options.command != NULL) {
        put_command(page, job->options.command);
    }
    // The command puts a link to the page of alpenglow web into this element.
    alpi_page_put(page, "<p id=\"web\"></p>\n");
    alpi_page_put(page, "</header>\n<main>\n");
}

// --- the first look ------------------------------------------------------------------------------

static void put_tile(alpi_page *page, const char *name, const char *value, const char *more)
{
    alpi_page_format(page, "<div><dt>%s</dt><dd>%s%s%s%s</dd></div>\n", name, value,
                     more[0] != '\0' ? "<small>" : "", more, more[0] != '\0' ? "</small>" : "");
}

/// The stated error that matters most: of light, where there is light.
static void put_error_tile(alpi_page *page, const report_job *job)
{
    const alp_bake_report *r = job->report;
    const bool is_light = (r->maps & ALP_MAP_LIGHT) != 0;
    const double error = is_light ? r->light_relative_error : r->ao_relative_error;
    if (!job->at_vertices) {
        put_tile(page, "Stated error", isfinite(error) ? alpi_percent(error).text : "unknown",
                 is_light ? "irradiance" : "occlusion");
    }
}

/// How many the page tells of.
static uint32_t count_findings(const report_job *job)
{
    const alp_diagnosis *d = job->options.diagnosis;
    return d != NULL ? alp_diagnosis_finding_count(d) : job->options.finding_count;
}

/// How many of them are worse than notes.
static uint32_t count_grave(const report_job *job)
{
    const alp_diagnosis *d = job->options.diagnosis;
    uint32_t count = d != NULL ? 0 : job->options.finding_count;
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(d); i++) {
        count += alp_diagnosis_get_finding(d, i).severity != ALP_SEVERITY_NOTE;
    }
    return count;
}

static void put_tiles(alpi_page *page, const report_job *job)
{
    const alp_bake_report *r = job->report;
    const uint32_t grave = count_grave(job), notes = count_findings(job) - grave;
    char more[32] = "";
    alpi_page_put(page, "<dl class=\"tiles\">\n");
    put_tile(page, "Triangles", alpi_grouped(r->scene.triangles).text, "");
    if (job->at_vertices) {
        put_tile(page, "Vertices", alpi_grouped(r->vertices).text, "");
    } else {
        put_tile(page, "Texels", alpi_grouped(r->atlas.texels).text, "");
    }
    put_error_tile(page, job);
    put_tile(page, "Time", alpi_duration(r->seconds_load + r->seconds_total).text,
             r->cut_off ? "cut off" : "");
    const bool has_paths =
        (r->maps & ALP_MAP_LIGHT) != 0 && !r->light_direct && r->light_passes == 0;
    put_tile(page, has_paths ? "Rays and paths" : "Rays",
             r->rays < 10000000u ? alpi_grouped(r->rays).text
                                 : alpi_significant((double)r->rays / 1e6, 3).text,
             r->rays < 10000000u ? "" : "million");
    put_tile(page, "Memory", alpi_bytes(r->peak_memory_bytes).text, "peak of our own");
    if (notes > 0) {
        snprintf(more, sizeof more, "<small>%u note%s</small>", notes, notes == 1 ? "" : "s");
    }
    alpi_page_format(page, "<div%s><dt>Findings</dt><dd>%u%s</dd></div>\n</dl>\n",
                     grave > 0 ? " class=\"alert\"" : "", grave, more);
}

// --- findings ------------------------------------------------------------------------------------

/// Messages say what is wrong; then, behind the last semicolon, what to do or what follows.
static void put_finding_text(alpi_page *page, const char *text)
{
    char fault[TEXT_LIMIT];
    const char *advice = NULL;
    for (const char *at = strstr(text, "; "); at != NULL; at = strstr(at + 2, "; ")) {
        advice = at;
    }
    const size_t length = advice != NULL ? (size_t)(advice - text) : strlen(text);
    snprintf(fault, sizeof fault, "%.*s", (int)(length < TEXT_LIMIT ? length : TEXT_LIMIT), text);
    alpi_page_put(page, "<p><bdi>");
    alpi_page_text(page, fault, TEXT_LIMIT);
    alpi_page_put(page, "</bdi></p>");
    if (advice != NULL) {
        alpi_page_put(page, "<p class=\"advice\"><bdi>");
        alpi_page_text(page, advice + 2, TEXT_LIMIT);
        alpi_page_put(page, "</bdi></p>");
    }
}

static void put_message(alpi_page *page, const alp_report_finding *f)
{
    alpi_page_put(page, "<li><code>");
    alpi_page_text(page, f->code != NULL ? f->code : "", ALPI_REPORT_NAME);
    alpi_page_put(page, "</code><b><bdi>");
    alpi_page_text(page, f->object != NULL ? f->object : "", ALPI_REPORT_NAME);
    alpi_page_put(page, "</bdi></b>");
    put_finding_text(page, f->text != NULL ? f->text : "");
    alpi_page_put(page, "</li>\n");
}

/// One paragraph, unless there is nothing to say.
static void put_words(alpi_page *page, const char *class, const char *text)
{
    if (text[0] != '\0') {
        alpi_page_format(page, "<p class=\"%s\"><bdi>", class);
        alpi_page_text(page, text, TEXT_LIMIT);
        alpi_page_put(page, "</bdi></p>");
    }
}

static void put_finding(alpi_page *page, const alp_finding *f)
{
    alpi_page_format(page, "<li class=\"%s\"><code>", alp_severity_name(f->severity));
    alpi_page_text(page, f->code, ALPI_REPORT_NAME);
    alpi_page_put(page, "</code><b><bdi>");
    alpi_page_text(page, f->place == ALP_PLACE_SCENE ? alpi_path_name(f->name) : f->name,
                   ALPI_REPORT_NAME);
    alpi_page_put(page, "</bdi></b>");
    put_words(page, "what", f->what);
    put_words(page, "seen", f->seen);
    put_words(page, "advice", f->todo);
    alpi_page_put(page, "</li>\n");
}

static void put_findings(alpi_page *page, const report_job *job)
{
    const alp_diagnosis *d = job->options.diagnosis;
    const uint32_t count = count_findings(job);
    if (count == 0) {
        return;
    }
    alpi_page_put(page, "<section id=\"findings\"><h2>Findings</h2>\n<ul class=\"findings\">\n");
    for (uint32_t i = 0; d != NULL && i < count && i < FINDING_LIMIT; i++) {
        const alp_finding f = alp_diagnosis_get_finding(d, i);
        put_finding(page, &f);
    }
    for (uint32_t i = 0; d == NULL && i < count && i < FINDING_LIMIT; i++) {
        put_message(page, &job->options.findings[i]);
    }
    alpi_page_put(page, "</ul>\n");
    if (count > FINDING_LIMIT) {
        alpi_page_format(page, "<p class=\"note\">The first %d of %u are shown.</p>\n",
                         FINDING_LIMIT, count);
    }
    alpi_page_put(page, "</section>\n");
}

// --- time ----------------------------------------------------------------------------------------

static void put_passes(alpi_page *page, const alp_bake_report *r)
{
    const uint32_t most = sizeof r->light_changes / sizeof *r->light_changes;
    const uint32_t count = r->light_passes < most ? r->light_passes : most;
    if (count == 0) {
        return;
    }
    alpi_page_format(page,
                     "<section id=\"passes\"><h2>Convergence</h2>\n<p class=\"note\">Mean change "
                     "of the light by each bounce, over its mean; bounce %u changed it by "
                     "%s.</p>\n",
                     count, alpi_percent((double)r->light_changes[count - 1]).text);
    alpi_plot_passes(page, r->light_changes, count);
    alpi_page_put(page, "</section>\n");
}

static void put_stages(alpi_page *page, const alp_bake_report *r)
{
    const double total = r->seconds_load + r->seconds_total;
    const double told = r->seconds_load + r->seconds_atlas + r->seconds_build + r->seconds_bake +
                        r->seconds_seams + r->seconds_write;
    const alpi_report_stage stages[] = {
        {"Load", r->seconds_load, "#8b93a7"},         {"Atlas", r->seconds_atlas, "#3d5a98"},
        {"Build", r->seconds_build, "#6b3f96"},       {"Rays", r->seconds_bake, "#cd446a"},
        {"Seams", r->seconds_seams, "#e8825d"},       {"Write", r->seconds_write, "#f69e54"},
        {"Other", fmax(total - told, 0.0), "#d8d2c4"}};
    alpi_page_put(page, "<section id=\"time\"><h2>Time</h2>\n");
    alpi_plot_stages(page, stages, sizeof stages / sizeof *stages, fmax(total, told));
    alpi_page_put(page, "</section>\n");
}

// --- all of it -----------------------------------------------------------------------------------

static void put_objects(alpi_page *page, const report_job *job)
{
    alpi_page_put(page, "<section id=\"objects\"><h2>Objects on the atlas</h2>\n");
    alpi_report_put_objects(page, &job->pictures);
    alpi_page_put(page, "</section>\n");
}

static alp_result put_all(alpi_page *page, const report_job *job)
{
    put_head(page, job);
    put_tiles(page, job);
    alpi_report_put_scene(page, job->scene, job->lightmap, job->options.picture_samples);
    put_findings(page, job);
    if (!job->at_vertices) {
        alpi_report_put_maps(page, job->report, &job->pictures);
    }
    put_passes(page, job->report);
    put_stages(page, job->report);
    if (!job->at_vertices) {
        put_objects(page, job);
    }
    alpi_report_put_facts(page, job->scene, job->report);
    alpi_page_format(page,
                     "</main>\n<footer><p>Written by Alpenglow %s. The page holds everything it "
                     "shows, loads nothing and runs no script.</p></footer>\n</body>\n</html>\n",
                     alp_version());
    return alpi_page_flush(page);
}

static alp_result write_page(const report_job *job, const char *path)
{
    alp_context *context = job->scene->context;
    alpi_file_writer writer;
    ALP_TRY(alpi_file_open(context, path, job->options.overwrite, &writer));
    alpi_page *page = ALPI_NEW(context, alpi_page, 1);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (page != NULL) {
        page->context = context;
        page->writer = &writer;
        result = put_all(page, job);
    }
    alpi_release(context, page);
    if (result == ALP_OK) {
        return alpi_file_commit(&writer);
    }
    alpi_file_abandon(&writer);
    return result;
}

alp_result alp_bake_write_report(const alp_scene *scene, const alp_lightmap *lightmap,
                                 const alp_bake_report *report, const alp_report_options *options,
                                 const char *path)
{
    if (scene == NULL || lightmap == NULL || report == NULL || path == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    report_job job = {.scene = scene,
                      .lightmap = lightmap,
                      .report = report,
                      .options = options != NULL ? *options : alp_report_options_default(),
                      .at_vertices = lightmap->atlas == NULL};
    const bool has_findings = job.options.finding_count == 0 || job.options.findings != NULL;
    if (job.options.struct_size != sizeof job.options || !has_findings) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "report options are not from _default(), or findings are NULL");
    }
    if (!job.at_vertices) {
        const uint32_t count = lightmap->page_count;
        job.pictures = (alpi_report_pictures){
            .scene = scene,
            .lightmap = lightmap,
            .page_count = count < ALPI_REPORT_PAGES ? count : ALPI_REPORT_PAGES};
        ALP_TRY(alpi_report_measure(report, &job.pictures));
    }
    return write_page(&job, path);
}
