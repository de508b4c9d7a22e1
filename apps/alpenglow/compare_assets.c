// SPDX-License-Identifier: MIT
#include "compare_assets.h"

#include "output.h"
#include "printing/messages.h"

#include <string.h>

typedef struct assets {
    alp_scene *a, *b;
    alp_map_difference difference;
} assets;

bool compare_is_scene(const char *operand)
{
    static const char *const endings[] = {".glb", ".gltf", ".obj", ".dae", ".zae"};
    bool scene = strncmp(operand, "builtin:", strlen("builtin:")) == 0;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        scene = scene || path_ends(operand, endings[i]);
    }
    return scene;
}

static const char *map_name(const alp_map_difference *d)
{
    return d->map == ALP_MAP_AO ? "ao" : "light";
}

/// Name of the object with the largest difference; "" without any point.
static const char *object_name(const assets *s)
{
    return alp_scene_get_surface(s->a, s->difference.maximum_surface).name;
}

/// Place of the largest difference in the world of the file.
static void find_maximum(const assets *s, double at[3])
{
    const alp_scene_info info = alp_scene_get_info(s->a);
    for (int k = 0; k < 3; k++) {
        at[k] = info.origin[k] + (double)s->difference.maximum_position[k];
    }
}

static json_t *make_document(const command_line *arguments, const assets *s)
{
    const alp_map_difference *d = &s->difference;
    double at[3];
    find_maximum(s, at);
    return json_pack(
        "{s:s, s:o, s:o, s:s, s:[b, b], s:o, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, "
        "s:[o, o, o], s:o}",
        "version", alp_version(), "a", json_text(arguments->operands[0]), "b",
        json_text(arguments->operands[1]), "map", map_name(d), "blended", d->blended_first,
        d->blended_second, "scale", json_number(arguments->values[OPTION_SCALE].real), "points",
        (json_int_t)d->points, "only_a", (json_int_t)d->only_first, "only_b",
        (json_int_t)d->only_second, "rmse", json_number(d->rmse), "relative_rmse",
        json_number(d->relative_rmse), "bias", json_number(d->bias), "mean_a",
        json_number(d->mean_first), "mean_b", json_number(d->mean_second), "p99",
        json_number(d->p99), "maximum", json_number(d->maximum), "maximum_at", json_number(at[0]),
        json_number(at[1]), json_number(at[2]), "maximum_object", json_text(object_name(s)));
}

static void print_difference(const assets *s)
{
    const alp_map_difference *d = &s->difference;
    double at[3];
    find_maximum(s, at);
    printf("map       %s, A %s, B %s\n", map_name(d), d->blended_first ? "blended" : "of one set",
           d->blended_second ? "blended" : "of one set");
    printf("points    %llu (only in A %llu, only in B %llu)\n", (unsigned long long)d->points,
           (unsigned long long)d->only_first, (unsigned long long)d->only_second);
    printf("rmse      %.6g\n", d->rmse);
    printf("relative  %.6g\n", d->relative_rmse);
    printf("bias      %.6g\n", d->bias);
    printf("p99       %.6g\n", d->p99);
    printf("maximum   %.6g", d->maximum);
    if (d->points > 0) {
        printf(" at %.4g %.4g %.4g m on ", at[0], at[1], at[2]);
        print_clean(stdout, object_name(s));
    }
    printf("\nmeans     %.6g and %.6g\n", d->mean_first, d->mean_second);
}

static alp_result compare_files(alp_context *context, const command_line *arguments, assets *s)
{
    const option_value *map = &arguments->values[OPTION_MAP];
    alp_map_compare_options options = alp_map_compare_options_default();
    options.points = (uint32_t)arguments->values[OPTION_POINTS].whole;
    options.scale = arguments->values[OPTION_SCALE].real;
    if (map->given) {
        options.map = map->choice == 0 ? ALP_MAP_AO : ALP_MAP_LIGHT;
    }
    alp_result result = alp_scene_load(context, arguments->operands[0], &s->a);
    if (result == ALP_OK) {
        result = alp_scene_load(context, arguments->operands[1], &s->b);
    }
    return result == ALP_OK ? alp_scene_compare_maps(s->a, s->b, &options, &s->difference) : result;
}

static int tell(const command_line *arguments, const assets *s)
{
    const char *json = arguments->values[OPTION_JSON].text;
    if (!output_is_stdout(json)) {
        print_difference(s);
    }
    if (json == NULL) {
        return compare_judge(arguments, s->difference.points, s->difference.rmse,
                             "no point has the map in both scenes");
    }
    json_t *document = make_document(arguments, s);
    const int code = document == NULL
                         ? failure("out of memory")
                         : output_write_json(document, json, arguments->values[OPTION_FORCE].given);
    json_decref(document);
    return code == EXIT_DONE ? compare_judge(arguments, s->difference.points, s->difference.rmse,
                                             "no point has the map in both scenes")
                             : code;
}

int compare_assets(alp_context *context, const command_line *arguments)
{
    assets s = {0};
    const int code = compare_files(context, arguments, &s) == ALP_OK
                         ? tell(arguments, &s)
                         : failure(alp_context_message(context));
    alp_scene_destroy(s.a);
    alp_scene_destroy(s.b);
    return code;
}
