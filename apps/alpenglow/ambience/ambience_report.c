// SPDX-License-Identifier: MIT
#include "ambience/ambience_report.h"

#include "output.h"
#include "printing/report.h"

#include <math.h>

typedef struct totals {
    uint64_t samples, relit, rays;
    double sampling, clock; // seconds
    double error;           // mean of those that were measured; NAN = none
    uint64_t frames;
    double worst_ms;
} totals;

static totals add_up(const ambience_record *r)
{
    totals t = {.error = (double)NAN};
    double errors = 0.0;
    uint32_t measured = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        const ambience_second *s = &r->seconds[i];
        t.samples += s->samples;
        t.relit += s->relit;
        t.rays += s->rays;
        t.frames += s->frames;
        t.sampling += s->sampling;
        t.clock += 1e-3 * s->update_ms * (double)s->frames;
        t.worst_ms = fmax(t.worst_ms, s->worst_ms);
        if (isfinite(s->error)) {
            errors += s->error;
            measured++;
        }
    }
    t.error = measured > 0 ? errors / (double)measured : (double)NAN;
    return t;
}

static double rate(const totals *t)
{
    return t->sampling > 0.0 ? (double)t->samples / t->sampling : 0.0;
}

void ambience_print_csv_names(FILE *stream)
{
    fputs("second,anchors,samples,bytes,update_ms,error_percent\n", stream);
}

void ambience_print_csv(FILE *stream, const ambience_second *s)
{
    fprintf(stream, "%u,%u,%llu,%llu,%.4g,", s->number, s->info.anchors,
            (unsigned long long)s->samples, (unsigned long long)s->info.bytes, s->update_ms);
    if (isfinite(s->error)) {
        fprintf(stream, "%.4g", s->error);
    }
    fputc('\n', stream);
}

void ambience_print_names(void)
{
    puts("second  anchors  samples    relit        kB  update ms  error %");
}

void ambience_print_second(const ambience_second *s)
{
    printf("%6u %8u %8llu %8llu %9.0f %10.3g ", s->number, s->info.anchors,
           (unsigned long long)s->samples, (unsigned long long)s->relit,
           1e-3 * (double)s->info.bytes, s->update_ms);
    if (isfinite(s->error)) {
        printf("%8.3g\n", s->error);
    } else {
        puts("       -");
    }
}

void ambience_print_summary(const ambience_record *r)
{
    const totals t = add_up(r);
    const ambience_second *last = &r->seconds[r->count - 1];
    printf("sampled    %llu anchor%s, %.3g a second; relit %llu\n", (unsigned long long)t.samples,
           plural(t.samples), rate(&t), (unsigned long long)t.relit);
    printf("update     %.3g ms a frame in the mean, %.3g ms at worst\n",
           1e3 * t.clock / (double)t.frames, t.worst_ms);
    printf("memory     %.3g MB, %u anchor%s in %u level%s\n", 1e-6 * (double)last->info.bytes,
           last->info.anchors, plural(last->info.anchors), last->info.levels,
           plural(last->info.levels));
    if (isfinite(t.error)) {
        printf("error      %.3g %% in the mean\n", t.error);
    }
}

// --- JSON ----------------------------------------------------------------------------------------

static json_t *make_second(const ambience_second *s)
{
    return json_pack(
        "{s:I, s:o, s:[o, o, o], s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o}",
        "second", (json_int_t)s->number, "time", json_number(s->time), "position",
        json_number(s->position[0]), json_number(s->position[1]), json_number(s->position[2]),
        "anchors", (json_int_t)s->info.anchors, "solids", (json_int_t)s->info.solids, "levels",
        (json_int_t)s->info.levels, "samples", (json_int_t)s->samples, "relit",
        (json_int_t)s->relit, "rays", (json_int_t)s->rays, "bytes", (json_int_t)s->info.bytes,
        "bytes_visibility", (json_int_t)s->info.bytes_visibility, "bytes_hits",
        (json_int_t)s->info.bytes_hits, "cell", json_number(s->info.cell), "update_ms",
        json_number(s->update_ms), "worst_ms", json_number(s->worst_ms), "error_percent",
        json_number(s->error));
}

static json_t *make_seconds(const ambience_record *r)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < r->count; i++) {
        json_array_append_new(list, make_second(&r->seconds[i]));
    }
    return list;
}

static json_t *make_options(const flight_run *run)
{
    const alp_ambience_options *o = &run->options;
    const double cell = o->size / pow(3.0, (double)o->depth);
    const bool timed = run->budget_ms > 0.0;
    return json_pack("{s:o, s:o, s:o, s:o, s:I, s:I, s:o, s:o, s:b, s:b, s:o, s:s, s:s, s:o}",
                     "fps", json_number(run->fps), "budget",
                     timed ? json_null() : json_integer((json_int_t)run->budget), "budget_ms",
                     timed ? json_number(run->budget_ms) : json_null(), "cell", json_number(cell),
                     "depth", (json_int_t)o->depth, "anchors", (json_int_t)o->anchor_limit,
                     "lifetime", json_number(o->lifetime), "fade", json_number(o->fade), "flat",
                     (int)o->flat, "visibility", (int)o->visibility, "detail",
                     json_number(run->detail), "lookup",
                     o->lookup == ALP_AMBIENCE_OURS ? "ours" : "conformance", "prediction",
                     run->known != NULL ? "path" : "velocity", "day",
                     run->day > 0.0 ? json_number(run->day) : json_null());
}

static json_t *make_totals(const ambience_record *r)
{
    const totals t = add_up(r);
    const ambience_second *last = &r->seconds[r->count - 1];
    return json_pack("{s:I, s:I, s:I, s:I, s:o, s:o, s:I, s:I, s:o, s:o, s:o}", "frames",
                     (json_int_t)t.frames, "samples", (json_int_t)t.samples, "relit",
                     (json_int_t)t.relit, "rays", (json_int_t)t.rays, "seconds",
                     json_number(t.clock), "samples_per_second", json_number(rate(&t)), "anchors",
                     (json_int_t)last->info.anchors, "bytes", (json_int_t)last->info.bytes,
                     "update_ms", json_number(1e3 * t.clock / (double)t.frames), "worst_ms",
                     json_number(t.worst_ms), "mean_error_percent", json_number(t.error));
}

json_t *ambience_json(const flight_run *run, const command_line *a, const ambience_record *r)
{
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    return json_pack("{s:s, s:{s:I, s:I}, s:o, s:I, s:o, s:o, s:o}", "version", alp_version(),
                     "scene", "triangles", (json_int_t)info.triangles, "surfaces",
                     (json_int_t)info.surfaces, "options", make_options(run), "seed",
                     (json_int_t)a->values[OPTION_SEED].whole, "seconds", make_seconds(r), "totals",
                     make_totals(r), "warnings", report_warnings(&run->session->messages));
}
