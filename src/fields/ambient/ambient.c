// SPDX-License-Identifier: MIT
// Classic models of ambient light. Each is a sum of a few functions of position and normal with a
// colour each, E = Σ colour_i f_i(p, n). The colours minimise the squared error over fit points.
#include "base/memory.h"
#include "fields/ambient/ground_map.h"
#include "fields/field.h"
#include "scene/lights/lighting.h"
#include "sh/sh9.h"

#include <math.h>
#include <string.h>

enum { TERM_LIMIT = ALP_AMBIENT_COLORS, POINT_LEAST = 16, POINT_LIMIT = 1000000 };
enum { GROUND_SAMPLES = 64 };

typedef struct ambient_field {
    alp_field field;
    alp_ambient_model model;
    uint32_t terms;
    float colors[TERM_LIMIT][3];
    alpi_ground_map *ground; // of GROUND_MAP, else NULL
} ambient_field;

alp_ambient_options alp_ambient_options_default(void)
{
    return (alp_ambient_options){.struct_size = sizeof(alp_ambient_options),
                                 .lighting = alp_lighting_options_default(),
                                 .bounces = ALP_BOUNCES_CONVERGE,
                                 .points = 1024,
                                 .samples = 256};
}

// --- the functions of each model -----------------------------------------------------------------

/// The functions at a point, by channel: the ground map differs by channel, the others do not.
static void list_terms(const ambient_field *f, const float position[3], const float normal[3],
                       float terms[3][TERM_LIMIT])
{
    const vec3 n = vec3_load(normal);
    const float up = 0.5f * (1.0f + n.y), down = 0.5f * (1.0f - n.y);
    float *t = terms[0], ground[3] = {0.0f, 0.0f, 0.0f};
    switch (f->model) {
    case ALP_AMBIENT_HEMISPHERE:
    case ALP_AMBIENT_GROUND_MAP:
        t[0] = up;
        t[1] = down;
        break;
    case ALP_AMBIENT_CUBE:
        alpi_ambient_cube_weights(n, t);
        break;
    case ALP_AMBIENT_ENVIRONMENT:
        alpi_sh9_irradiance_weights(n, t);
        break;
    default:
        t[0] = 1.0f;
    }
    memcpy(terms[1], t, f->terms * sizeof *t);
    memcpy(terms[2], t, f->terms * sizeof *t);
    if (f->ground != NULL) {
        alpi_ground_map_read(f->ground, position[0], position[2], ground);
        for (int k = 0; k < 3; k++) {
            terms[k][2] = down * ground[k];
        }
    }
}

static void evaluate(const alp_field *field, uint32_t count, const float (*positions)[3],
                     const float (*normals)[3], float (*irradiance)[3])
{
    const ambient_field *f = (const ambient_field *)field;
    float terms[3][TERM_LIMIT];
    for (uint32_t i = 0; i < count; i++) {
        list_terms(f, positions[i], normals[i], terms);
        for (int k = 0; k < 3; k++) {
            float sum = 0.0f;
            for (uint32_t t = 0; t < f->terms; t++) {
                sum += f->colors[t][k] * terms[k][t];
            }
            irradiance[i][k] = sum;
        }
    }
}

static void destroy(alp_field *field)
{
    ambient_field *f = (ambient_field *)field;
    alpi_release(field->context, f->ground);
    alpi_release(field->context, f);
}

static const alpi_field_kind kinds[ALP_AMBIENT_COUNT] = {
    [ALP_AMBIENT_CONSTANT] = {"constant", evaluate, NULL, destroy},
    [ALP_AMBIENT_HEMISPHERE] = {"hemisphere", evaluate, NULL, destroy},
    [ALP_AMBIENT_GROUND_MAP] = {"ground-map", evaluate, NULL, destroy},
    [ALP_AMBIENT_CUBE] = {"ambient-cube", evaluate, NULL, destroy},
    [ALP_AMBIENT_ENVIRONMENT] = {"environment", evaluate, NULL, destroy},
};
static const uint32_t term_counts[ALP_AMBIENT_COUNT] = {1, 2, 3, 6, ALPI_SH9_COUNT};

// --- least squares -------------------------------------------------------------------------------

/// Normal equations of one channel: matrix · colours = right side.
typedef struct normal_equations {
    double matrix[TERM_LIMIT][TERM_LIMIT], right[TERM_LIMIT];
} normal_equations;

/// Cholesky's L Lᵀ in place. A function that is 0 or depends on the others gets the colour 0.
static void solve(normal_equations *e, uint32_t n, double colors[TERM_LIMIT])
{
    double largest = 0.0;
    for (uint32_t i = 0; i < n; i++) {
        largest = fmax(largest, e->matrix[i][i]);
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j <= i; j++) {
            double sum = e->matrix[i][j];
            for (uint32_t k = 0; k < j; k++) {
                sum -= e->matrix[i][k] * e->matrix[j][k];
            }
            if (i == j) {
                e->matrix[i][i] = sum > 1e-9 * largest ? sqrt(sum) : HUGE_VAL;
            } else {
                e->matrix[i][j] = sum / e->matrix[j][j];
            }
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        double sum = e->right[i];
        for (uint32_t k = 0; k < i; k++) {
            sum -= e->matrix[i][k] * colors[k];
        }
        colors[i] = sum / e->matrix[i][i];
    }
    for (uint32_t i = n; i-- > 0;) {
        double sum = colors[i];
        for (uint32_t k = i + 1; k < n; k++) {
            sum -= e->matrix[k][i] * colors[k];
        }
        colors[i] = sum / e->matrix[i][i];
    }
}

static void fit_colors(ambient_field *f, uint32_t count, const float (*positions)[3],
                       const float (*normals)[3], const alpi_reference_value *values)
{
    normal_equations equations[3];
    memset(equations, 0, sizeof equations);
    for (uint32_t p = 0; p < count; p++) {
        float terms[3][TERM_LIMIT];
        list_terms(f, positions[p], normals[p], terms);
        for (int k = 0; k < 3; k++) {
            for (uint32_t i = 0; i < f->terms; i++) {
                for (uint32_t j = 0; j <= i; j++) {
                    equations[k].matrix[i][j] += (double)terms[k][i] * (double)terms[k][j];
                }
                equations[k].right[i] += (double)terms[k][i] * (double)values[p].mean[k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        double colors[TERM_LIMIT];
        solve(&equations[k], f->terms, colors);
        for (uint32_t i = 0; i < f->terms; i++) {
            f->colors[i][k] = (float)colors[i];
        }
    }
}

/// RMS residual of the fit, the noise of its points taken off, for points that took no part.
static float find_residual(const ambient_field *f, uint32_t count, const float (*positions)[3],
                           const float (*normals)[3], const alpi_reference_value *values)
{
    double squares = 0.0;
    for (uint32_t p = 0; p < count; p++) {
        float e[1][3];
        alp_field_irradiance(&f->field, 1, &positions[p], &normals[p], e); // none is below 0
        for (int k = 0; k < 3; k++) {
            const double apart = (double)e[0][k] - (double)values[p].mean[k];
            squares += apart * apart - (double)values[p].variance[k];
        }
    }
    const double free = count > f->terms ? count - f->terms : 1.0;
    return (float)sqrt(fmax(squares, 0.0) / (3.0 * free));
}

// --- making one ----------------------------------------------------------------------------------

typedef struct fit_points {
    float (*positions)[3], (*normals)[3];
    alpi_reference_value *values;
} fit_points;

static alp_result fit(const alp_scene *scene, const alp_ambient_options *o, fit_points *p,
                      ambient_field *f)
{
    alp_context *context = scene->context;
    alp_reference_options reference = {.struct_size = sizeof reference,
                                       .lighting = o->lighting,
                                       .bounces = o->bounces,
                                       .samples = o->samples,
                                       .direct = o->direct,
                                       .seed = o->seed,
                                       .progress = o->progress,
                                       .progress_user = o->progress_user};
    ALPI_TRY_NEW(context, p->positions, o->points);
    ALPI_TRY_NEW(context, p->normals, o->points);
    ALPI_TRY_NEW(context, p->values, o->points);
    ALP_TRY(alp_scene_free_points(scene, o->seed, o->points, p->positions, p->normals));
    ALP_TRY(alpi_truth_at_points(scene, &reference, o->points, (const float(*)[3])p->positions,
                                 (const float(*)[3])p->normals, "fit", p->values));
    if (o->model == ALP_AMBIENT_GROUND_MAP) {
        ALPI_TRY_NEW(context, f->ground, 1);
        reference.samples = GROUND_SAMPLES;
        ALP_TRY(alpi_ground_map_make(scene, &reference, f->ground));
    }
    fit_colors(f, o->points, (const float(*)[3])p->positions, (const float(*)[3])p->normals,
               p->values);
    f->field.error = find_residual(f, o->points, (const float(*)[3])p->positions,
                                   (const float(*)[3])p->normals, p->values);
    return ALP_OK;
}

static alp_result check(const alp_scene *scene, const alp_ambient_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(scene->context, code, "ambient options are not from _default()");
    }
    if ((int)o->model < 0 || o->model >= ALP_AMBIENT_COUNT) {
        return alpi_fail(scene->context, code, "ambient: unknown model %d", (int)o->model);
    }
    if (o->points < POINT_LEAST || o->points > POINT_LIMIT) {
        return alpi_fail(scene->context, code, "ambient: %u points to fit at, need %d to %d",
                         o->points, POINT_LEAST, POINT_LIMIT);
    }
    if (o->samples < 1 || o->samples > 65536) {
        return alpi_fail(scene->context, code, "ambient: %u samples per point, need 1 to 65536",
                         o->samples);
    }
    return alpi_lighting_refuse_darkness(scene, &o->lighting);
}

alp_result alp_field_create_ambient(const alp_scene *scene, const alp_ambient_options *options,
                                    alp_field **field)
{
    if (scene == NULL || field == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *field = NULL;
    const alp_ambient_options o = options ? *options : alp_ambient_options_default();
    ALP_TRY(check(scene, &o));
    alp_context *context = scene->context;
    ambient_field *f = ALPI_NEW(context, ambient_field, 1);
    if (f == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    f->field = (alp_field){.context = context, .kind = &kinds[o.model], .direct = o.direct};
    f->model = o.model;
    f->terms = term_counts[o.model];
    fit_points points = {NULL, NULL, NULL};
    const alp_result result = fit(scene, &o, &points, f);
    alpi_release(context, points.positions);
    alpi_release(context, points.normals);
    alpi_release(context, points.values);
    if (result != ALP_OK) {
        destroy(&f->field);
        return result;
    }
    *field = &f->field;
    return ALP_OK;
}

alp_ambient_info alp_field_get_ambient(const alp_field *field)
{
    alp_ambient_info info = {.model = ALP_AMBIENT_CONSTANT};
    if (field == NULL || field->kind->irradiance != evaluate) {
        return info;
    }
    const ambient_field *f = (const ambient_field *)field;
    info.model = f->model;
    info.color_count = f->terms;
    memcpy(info.colors, f->colors, sizeof info.colors);
    if (f->ground != NULL) {
        info.ground = (const float(*)[3])f->ground->texels;
        memcpy(info.ground_low, f->ground->low, sizeof info.ground_low);
        memcpy(info.ground_scale, f->ground->scale, sizeof info.ground_scale);
    }
    return info;
}
