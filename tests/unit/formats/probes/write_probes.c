// SPDX-License-Identifier: MIT
// write_probes FOLDER: writes volumes of probes there, and beside each, as NAME.expected.json, what
// a reader must find.
#include "test_volume.h"

#include "formats/formats.h"

#include <jansson.h>

#include <stdio.h>
#include <stdlib.h>

enum { DIRECTIONS = ALPI_PROBE_MOMENT_SIDE * ALPI_PROBE_MOMENT_SIDE };

static json_t *numbers(const float *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) {
        json_array_append_new(array, json_real((double)values[i]));
    }
    return array;
}

static json_t *describe_sets(const alpi_probe_volume *v, uint32_t probe)
{
    const size_t width = (size_t)3 * v->coefficient_count;
    json_t *sets = json_array();
    json_array_append_new(sets, numbers(v->coefficients + probe * width, width));
    for (uint32_t i = 0; i < v->layer_count; i++) {
        json_array_append_new(sets, numbers(v->layers[i].coefficients + probe * width, width));
    }
    for (size_t axis = 0; axis < 3 && v->gradients != NULL; axis++) {
        json_array_append_new(sets, numbers(v->gradients + (3 * probe + axis) * width, width));
    }
    return sets;
}

static json_t *describe_place(const alpi_probe_volume *v, uint32_t probe)
{
    if (v->is_list) {
        return numbers(v->places[probe], 3);
    }
    const uint32_t index[3] = {probe % v->size[0], probe / v->size[0] % v->size[1],
                               probe / v->size[0] / v->size[1]};
    json_t *place = json_array();
    for (int k = 0; k < 3; k++) {
        json_array_append_new(place,
                              json_real(v->origin[k] + (double)v->spacing[k] * (double)index[k]));
    }
    return place;
}

static json_t *describe_probe(const alpi_probe_volume *v, uint32_t probe)
{
    json_t *object = json_pack("{s:o,s:o,s:i,s:o}", "place", describe_place(v, probe), "move",
                               numbers(v->moves[probe], 3), "state", (int)v->states[probe], "sets",
                               describe_sets(v, probe));
    if (v->moments != NULL) {
        json_t *moments = json_array();
        for (size_t d = 0; d < DIRECTIONS; d++) {
            json_array_append_new(moments, numbers(v->moments[probe * DIRECTIONS + d], 2));
        }
        json_object_set_new(object, "moments", moments);
    }
    return object;
}

static void write_volume(alp_context *context, const char *folder, const char *name,
                         test_volume_options options)
{
    char file[64];
    alpi_probe_volume v = test_volume(context, options);
    json_t *layers = json_array(), *probes = json_array();
    for (uint32_t i = 0; i < v.layer_count; i++) {
        json_array_append_new(layers, json_string(v.layers[i].name));
    }
    for (uint32_t i = 0; i < v.count; i++) {
        json_array_append_new(probes, describe_probe(&v, i));
    }
    json_t *root = json_pack("{s:s,s:i,s:o,s:o}", "layout", v.is_list ? "list" : "grid", "count",
                             (int)v.count, "layers", layers, "probes", probes);
    snprintf(file, sizeof file, "%s.expected.json", name);
    if (root == NULL || json_dump_file(root, test_path(folder, file), 0) != 0) {
        fprintf(stderr, "%s: could not be written\n", file);
        exit(1);
    }
    snprintf(file, sizeof file, "%s.probes.json", name);
    if (alpi_probes_save(&v, test_path(folder, file), false) != ALP_OK) {
        fprintf(stderr, "%s\n", alp_context_message(context));
        exit(1);
    }
    json_decref(root);
    alpi_probe_volume_destroy(&v);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: write_probes FOLDER\n");
        return 2;
    }
    alp_context *context = test_context(1);
    write_volume(context, argv[1], "plain", (test_volume_options){.size = {3, 2, 4}});
    write_volume(
        context, argv[1], "all",
        (test_volume_options){.size = {2, 3, 4}, .layers = 2, .gradients = true, .moments = true});
    write_volume(context, argv[1], "cube",
                 (test_volume_options){.size = {4, 1, 3},
                                       .basis = ALPI_PROBE_AMBIENT_CUBE,
                                       .gradients = true,
                                       .times = 0x1p-20f});
    write_volume(context, argv[1], "strong",
                 (test_volume_options){.size = {2, 2, 2}, .layers = 1, .times = 0x1p20f});
    write_volume(context, argv[1], "list",
                 (test_volume_options){
                     .size = {300}, .is_list = true, .basis = ALPI_PROBE_SH4, .moments = true});
    write_volume(context, argv[1], "short",
                 (test_volume_options){.size = {7}, .is_list = true, .layers = 1});
    alp_context_destroy(context);
    return 0;
}
