// SPDX-License-Identifier: MIT
// write_grid FOLDER: writes probes for three.js there, and what pixels of a white sphere in their
// light must be: E/π by the field that render --lookup three reads.
#include "test_volume.h"

#include "base/half.h"
#include "fields/probes/probes.h"
#include "formats/formats.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 128 };

/// The camera looks along -z.
typedef struct view {
    vec3 center, eye;
    float radius, fov;
} view;

/// Coefficients that give bright light everywhere, and differ much from probe to probe.
static alpi_probe_volume make_volume(alp_context *context, const uint32_t size[3])
{
    alpi_probe_volume v =
        test_volume(context, (test_volume_options){.size = {size[0], size[1], size[2]}});
    for (uint32_t i = 0; i < v.count; i++) {
        v.states[i] = ALPI_PROBE_VALID;
        for (uint32_t k = 0; k < 27; k++) {
            const float value = test_volume_value(i, 0, k) / 8.0f; // in (-1, 1)
            const float light = k < 3 ? 2.2f + 1.1f * value : 0.35f * value;
            v.coefficients[27 * i + k] = alpi_half_to_float(alpi_half_from_float(light));
        }
    }
    for (int k = 0; k < 3; k++) {
        v.origin[k] = -0.7 + 0.3 * k;
    }
    return v;
}

/// The normal of the sphere where the ray of a pixel meets it, not near its outline.
static bool meet(const view *w, int x, int y, vec3 *normal)
{
    const float slope = tanf(w->fov / 2);
    const vec3 d = vec3_normalize_or((vec3){slope * (((float)x + 0.5f) * 2 / SIDE - 1),
                                            slope * (1 - ((float)y + 0.5f) * 2 / SIDE), -1.0f},
                                     (vec3){0.0f, 0.0f, -1.0f});
    const vec3 o = vec3_sub(w->eye, w->center);
    const float b = vec3_dot(o, d);
    const float root = b * b - vec3_dot(o, o) + w->radius * w->radius;
    if (!(root > 0.0f)) {
        return false;
    }
    *normal = vec3_scale(vec3_mad(o, -b - sqrtf(root), d), 1.0f / w->radius);
    return vec3_dot(*normal, d) < -0.3f;
}

/// E/π at the sphere, by the field that render --lookup three reads.
/// @param offset cells by which probes would be elsewhere
static void value_at(const alp_field *field, const alpi_probe_volume *v, const view *w, vec3 normal,
                     float offset, double value[3])
{
    const vec3 at = vec3_mad(w->center, w->radius, normal);
    const float n[1][3] = {{normal.x, normal.y, normal.z}};
    const float p[1][3] = {{at.x + offset * v->spacing[0], at.y + offset * v->spacing[1],
                            at.z + offset * v->spacing[2]}};
    float e[1][3];
    alp_field_irradiance(field, 1, p, n, e);
    for (int k = 0; k < 3; k++) {
        value[k] = (double)e[0][k] / ALPI_PI;
    }
}

static json_t *describe_pixels(const alpi_probe_volume *v, const view *w, double *half)
{
    json_t *pixels = json_array();
    alp_field *field = NULL;
    if (alpi_probe_field_create(v, ALP_LOOKUP_THREE, NULL, NULL, &field) != ALP_OK) {
        exit(1);
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec3 normal;
        double value[3], moved[3];
        if (!meet(w, i % SIDE, i / SIDE, &normal)) {
            continue;
        }
        value_at(field, v, w, normal, 0.0f, value);
        value_at(field, v, w, normal, 0.5f, moved);
        for (int k = 0; k < 3; k++) {
            *half = fmax(*half, fabs(moved[k] - value[k]));
        }
        json_array_append_new(pixels, json_pack("{s:i,s:i,s:[f,f,f]}", "x", i % SIDE, "y", i / SIDE,
                                                "value", value[0], value[1], value[2]));
    }
    alp_field_destroy(field);
    return pixels;
}

static void write_grid(alp_context *context, const char *folder, const char *name,
                       const uint32_t size[3], float radius)
{
    char file[64];
    alpi_probe_volume v = make_volume(context, size);
    float c[3];
    double half = 0.0;
    for (int k = 0; k < 3; k++) { // near the middle, between probes
        c[k] = (float)(v.origin[k] + (double)v.spacing[k] * (v.size[k] - 1) * 0.47);
    }
    const view w = {{c[0], c[1], c[2]}, {c[0], c[1], c[2] + 4 * radius}, radius, 0.55f};
    json_t *pixels = describe_pixels(&v, &w, &half);
    json_t *root = json_pack("{s:i,s:f,s:{s:f,s:[f,f,f],s:[f,f,f],s:[f,f,f,f]},s:o}", "side", SIDE,
                             "half", half, "camera", "fov", (double)w.fov, "position",
                             (double)w.eye.x, (double)w.eye.y, (double)w.eye.z, "target",
                             (double)c[0], (double)c[1], (double)c[2], "sphere", (double)c[0],
                             (double)c[1], (double)c[2], (double)radius, "pixels", pixels);
    snprintf(file, sizeof file, "%s.json", name);
    if (root == NULL || json_dump_file(root, test_path(folder, file), 0) != 0) {
        fprintf(stderr, "%s: could not be written\n", file);
        exit(1);
    }
    snprintf(file, sizeof file, "%s.mjs", name);
    if (alpi_probes_export_three(&v, test_path(folder, file), 1.0, false) != ALP_OK) {
        fprintf(stderr, "%s\n", alp_context_message(context));
        exit(1);
    }
    json_decref(root);
    alpi_probe_volume_destroy(&v);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: write_grid FOLDER\n");
        return 2;
    }
    alp_context *context = test_context(1);
    write_grid(context, argv[1], "grid", (uint32_t[3]){5, 4, 3}, 0.4f);
    write_grid(context, argv[1], "thin", (uint32_t[3]){6, 1, 3}, 0.2f);
    alp_context_destroy(context);
    return 0;
}
