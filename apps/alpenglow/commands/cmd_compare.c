// SPDX-License-Identifier: MIT
// alpenglow compare: differences of two images, or of the maps of two baked assets.
#include "commands/commands.h"
#include "compare_assets.h"
#include "output.h"
#include "printing/messages.h"

#include <alpenglow/alpenglow.h>

typedef struct comparison {
    alp_context *context;
    alp_image *a, *b, *heatmap;
    alp_image_difference difference;
} comparison;

static json_t *make_document(const command_line *arguments, const alp_image_difference *d)
{
    return json_pack(
        "{s:s, s:o, s:o, s:o, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:[I, I]}",
        "version", alp_version(), "a", json_text(arguments->operands[0]), "b",
        json_text(arguments->operands[1]), "scale",
        json_number(arguments->values[OPTION_SCALE].real), "pixels", (json_int_t)d->pixels,
        "only_a", (json_int_t)d->only_first, "only_b", (json_int_t)d->only_second, "rmse",
        json_number(d->rmse), "relative_rmse", json_number(d->relative_rmse), "bias",
        json_number(d->bias), "mean_a", json_number(d->mean_first), "mean_b",
        json_number(d->mean_second), "p99", json_number(d->p99), "maximum", json_number(d->maximum),
        "maximum_at", (json_int_t)d->maximum_x, (json_int_t)d->maximum_y);
}

static void print_difference(const alp_image_difference *d)
{
    printf("pixels    %llu (only in A %llu, only in B %llu)\n", (unsigned long long)d->pixels,
           (unsigned long long)d->only_first, (unsigned long long)d->only_second);
    printf("rmse      %.6g\n", d->rmse);
    printf("relative  %.6g\n", d->relative_rmse);
    printf("bias      %.6g\n", d->bias);
    printf("p99       %.6g\n", d->p99);
    printf("maximum   %.6g at %u,%u\n", d->maximum, d->maximum_x, d->maximum_y);
    printf("means     %.6g and %.6g\n", d->mean_first, d->mean_second);
}

int compare_judge(const command_line *arguments, uint64_t compared, double rmse, const char *none)
{
    const option_value *limit = &arguments->values[OPTION_MAX_RMSE];
    char text[128];
    if (!limit->given) {
        return EXIT_DONE;
    }
    if (compared == 0) {
        return failure(none);
    }
    if (rmse <= limit->real) {
        return EXIT_DONE;
    }
    snprintf(text, sizeof text, "rmse %.6g is above --max-rmse %s", rmse, limit->text);
    return failure(text);
}

static alp_result compare_files(comparison *c, const command_line *arguments)
{
    const char *heatmap = arguments->values[OPTION_HEATMAP].text;
    alp_result result = alp_image_load(c->context, arguments->operands[0], &c->a);
    if (result == ALP_OK) {
        result = alp_image_load(c->context, arguments->operands[1], &c->b);
    }
    if (result == ALP_OK) {
        result = alp_image_compare(c->a, c->b, arguments->values[OPTION_SCALE].real, &c->difference,
                                   heatmap != NULL ? &c->heatmap : NULL);
    }
    if (result == ALP_OK && heatmap != NULL) {
        result = alp_image_save(c->heatmap, heatmap, arguments->values[OPTION_FORCE].given);
    }
    return result;
}

static int compare(comparison *c, const command_line *arguments)
{
    const char *json = arguments->values[OPTION_JSON].text;
    if (compare_files(c, arguments) != ALP_OK) {
        return failure(alp_context_message(c->context));
    }
    if (!output_is_stdout(json)) {
        print_difference(&c->difference);
    }
    if (json != NULL) {
        json_t *document = make_document(arguments, &c->difference);
        int code = document == NULL
                       ? failure("out of memory")
                       : output_write_json(document, json, arguments->values[OPTION_FORCE].given);
        json_decref(document);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    return compare_judge(arguments, c->difference.pixels, c->difference.rmse,
                         "no pixel is covered in both images");
}

static int check_outputs(const command_line *arguments)
{
    const char *heatmap = arguments->values[OPTION_HEATMAP].text;
    const char *json = arguments->values[OPTION_JSON].text;
    bool overwrite = arguments->values[OPTION_FORCE].given;
    if (heatmap != NULL && !path_ends(heatmap, ".png")) {
        return usage_error(COMMAND_COMPARE, "--heatmap %s: the name must end in .png", heatmap);
    }
    if (heatmap != NULL && json != NULL && output_is_same(heatmap, json)) {
        return usage_error(COMMAND_COMPARE, "--heatmap and --json name the same file: %s", json);
    }
    for (int i = 0; i < 2; i++) {
        const char *compared = arguments->operands[i];
        if ((heatmap != NULL && output_is_same(heatmap, compared)) ||
            (json != NULL && output_is_same(json, compared))) {
            return usage_error(COMMAND_COMPARE,
                               "%s is compared and would be overwritten; give the "
                               "output another name",
                               compared);
        }
    }
    int code = heatmap != NULL ? output_check(heatmap, overwrite) : EXIT_DONE;
    return code == EXIT_DONE && json != NULL ? output_check_json(json, overwrite) : code;
}

/// Refuses options of images for scenes, and the reverse.
static int check_kinds(const command_line *a)
{
    const bool scenes = compare_is_scene(a->operands[0]);
    static const struct {
        const char *name;
        option_id id;
        bool of_scenes;
    } options[] = {{"--map", OPTION_MAP, true},
                   {"--points", OPTION_POINTS, true},
                   {"--heatmap", OPTION_HEATMAP, false}};
    if (scenes != compare_is_scene(a->operands[1])) {
        return usage_error(COMMAND_COMPARE,
                           "%s is a scene and %s is not; give two scenes or two"
                           " images",
                           a->operands[scenes ? 0 : 1], a->operands[scenes ? 1 : 0]);
    }
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        if (a->values[options[i].id].given && options[i].of_scenes != scenes) {
            return usage_error(COMMAND_COMPARE, "%s: does not apply to two %s", options[i].name,
                               scenes ? "scenes" : "images");
        }
    }
    return EXIT_DONE;
}

static int run(comparison *c, const command_line *arguments)
{
    return compare_is_scene(arguments->operands[0]) ? compare_assets(c->context, arguments)
                                                    : compare(c, arguments);
}

int command_compare(const command_line *arguments)
{
    int code = check_kinds(arguments);
    if (code == EXIT_DONE) {
        code = check_outputs(arguments);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    message_log messages = {.quiet = arguments->values[OPTION_QUIET].given};
    comparison c = {0};
    alp_context_options options = alp_context_options_default();
    options.log = messages_log;
    options.log_user = &messages;
    code = alp_context_create(&options, &c.context) == ALP_OK ? run(&c, arguments)
                                                              : failure("out of memory");
    alp_image_destroy(c.a);
    alp_image_destroy(c.b);
    alp_image_destroy(c.heatmap);
    alp_context_destroy(c.context);
    messages_flush(&messages);
    messages_release(&messages);
    return code;
}
