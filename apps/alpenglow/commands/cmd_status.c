// SPDX-License-Identifier: MIT
// alpenglow status: what the checkpoint of a bake says.
#include "commands/commands.h"
#include "output.h"
#include "printing/messages.h"
#include "scale/checkpoints.h"

#include <alpenglow/alpenglow.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/// "1 h 02 min", "3 min 20 s" or "12 s".
static void print_time(double seconds)
{
    const unsigned long whole = seconds > 0.0 ? (unsigned long)seconds : 0;
    if (whole >= 3600) {
        printf("%lu h %02lu min", whole / 3600, whole / 60 % 60);
    } else if (whole >= 60) {
        printf("%lu min %02lu s", whole / 60, whole % 60);
    } else {
        printf("%lu s", whole);
    }
}

static double share_of(const alp_checkpoint_process *p)
{
    return p->total > 0 ? 100.0 * (double)p->done / (double)p->total : 0.0;
}

static void print_process(const alp_checkpoint_process *p)
{
    const double age = difftime(time(NULL), (time_t)p->written);
    printf("%-10s %s", p->name, p->phase);
    if (p->shards > 0) {
        printf(", shard %u of %u", p->shard, p->shards);
    }
    if (strcmp(p->phase, "complete") != 0) {
        printf("; %s %.0f %%", p->stage[0] != '\0' ? p->stage : "beginning", share_of(p));
        if (isfinite(p->error)) {
            printf("; stated error so far %.2g %%", 100.0 * p->error);
        }
        if (p->seconds_left >= 0.0 && strcmp(p->phase, "running") == 0) {
            fputs("; about ", stdout);
            print_time(p->seconds_left);
            fputs(" left in this stage", stdout);
        }
    }
    fputs("; written ", stdout);
    print_time(age);
    fputs(" ago, after ", stdout);
    print_time(p->seconds);
    putchar('\n');
}

/// Prints how many shards are complete, and which are not.
static void print_shards(const alp_checkpoint_info *info)
{
    char missing[600];
    uint32_t count = 0, complete = 0;
    const alp_checkpoint_process *p = alp_checkpoint_processes(info, &count);
    for (uint32_t i = 0; i < count; i++) {
        complete += p[i].shards > 0 && strcmp(p[i].phase, "complete") == 0 ? 1 : 0;
    }
    if (p[0].shards > 0) {
        alp_checkpoint_missing(info, missing, sizeof missing);
        printf("shards     %u of %u complete%s%s\n", complete, p[0].shards,
               missing[0] != '\0' ? "; missing: --array=" : "", missing);
    }
}

static int write_json(const alp_checkpoint_process *p, uint32_t count, const command_line *a)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        json_array_append_new(
            list,
            json_pack("{s:s, s:s, s:s, s:I, s:I, s:f, s:o, s:o, s:I, s:i, s:i}", "name", p[i].name,
                      "phase", p[i].phase, "stage", p[i].stage, "done", (json_int_t)p[i].done,
                      "total", (json_int_t)p[i].total, "seconds", p[i].seconds, "seconds_left",
                      p[i].seconds_left >= 0.0 ? json_real(p[i].seconds_left) : json_null(),
                      "error", isfinite(p[i].error) ? json_real(p[i].error) : json_null(),
                      "written", (json_int_t)p[i].written, "shard", (int)p[i].shard, "shards",
                      (int)p[i].shards));
    }
    json_t *document = json_pack("{s:s, s:o}", "version", alp_version(), "processes", list);
    const int code = document == NULL ? failure("out of memory")
                                      : output_write_json(document, a->values[OPTION_JSON].text,
                                                          a->values[OPTION_FORCE].given);
    json_decref(document);
    return code;
}

static int print(const command_line *a, const alp_checkpoint_info *info)
{
    uint32_t count = 0;
    const alp_checkpoint_process *p = alp_checkpoint_processes(info, &count);
    if (a->values[OPTION_JSON].text != NULL) {
        const int code = write_json(p, count, a);
        if (code != EXIT_DONE || output_is_stdout(a->values[OPTION_JSON].text)) {
            return code;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        print_process(&p[i]);
    }
    print_shards(info);
    const uint32_t damaged = alp_checkpoint_damaged(info);
    if (damaged > 0) {
        printf("damaged    %u state%s; the bake goes on from what was written before\n", damaged,
               damaged == 1 ? "" : "s");
    }
    return EXIT_DONE;
}

int command_status(const command_line *a)
{
    return checkpoint_run(a, print);
}
