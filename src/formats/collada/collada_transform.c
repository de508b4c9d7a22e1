// SPDX-License-Identifier: MIT
// Transforms of nodes, and the turn and scale from a document's axis and unit to metres with +Y up.
// Barnes, Finch. COLLADA – Digital Asset Schema Release 1.4.1, 2nd edition. Khronos, 2008:
// <lookat>, <matrix>, <rotate>, <scale>, <skew>, <translate>, <up_axis>, <unit>.
#include "formats/collada/collada_numbers.h"
#include "formats/collada/collada_read.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool make_unit(double *v)
{
    const double length = sqrt(dot3(v, v));
    for (int k = 0; k < 3 && length > 0.0; k++) {
        v[k] /= length;
    }
    return length > 0.0 && isfinite(length);
}

static void cross3(const double *a, const double *b, double *out)
{
    for (int k = 0; k < 3; k++) {
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        out[k] = a[u] * b[v] - a[v] * b[u];
    }
}

/// mat4 holds columns: entry (row, column) is m[4 * column + row].
static mat4 from_columns(const double *x, const double *y, const double *z, const double *t)
{
    return (mat4){{x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, //
                   z[0], z[1], z[2], 0, t[0], t[1], t[2], 1}};
}

/// The file writes rows.
static mat4 from_rows(const double n[16])
{
    mat4 m;
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++) {
            m.m[4 * column + row] = n[4 * row + column];
        }
    }
    return m;
}

/// Axis and degrees. Without an axis nothing turns.
static mat4 rotation(const double n[4])
{
    double a[3] = {n[0], n[1], n[2]};
    if (!make_unit(a)) {
        return mat4_identity();
    }
    // quarter turns are exact, so that boxes stay boxes
    const double quarter = n[3] / 90.0, radians = n[3] * ALPI_PI / 180.0;
    const bool exact = quarter == floor(quarter);
    const double c = exact ? round(cos(radians)) : cos(radians);
    const double s = exact ? round(sin(radians)) : sin(radians);
    double column[3][3];
    for (int i = 0; i < 3; i++) { // c 1 + (1 − c) a aᵀ + s [a]×
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        column[i][i] = c + (1.0 - c) * a[i] * a[i];
        column[i][j] = (1.0 - c) * a[i] * a[j] + s * a[k];
        column[i][k] = (1.0 - c) * a[i] * a[k] - s * a[j];
    }
    const double zero[3] = {0, 0, 0};
    return from_columns(column[0], column[1], column[2], zero);
}

/// Eye, point of interest, up: places what looks along −Z. False where they give no direction.
static bool look_at(const double n[9], mat4 *m)
{
    double back[3], right[3], up[3];
    for (int k = 0; k < 3; k++) {
        back[k] = n[k] - n[3 + k];
    }
    cross3(n + 6, back, right);
    if (!make_unit(back) || !make_unit(right)) {
        return false;
    }
    cross3(back, right, up);
    *m = from_columns(right, up, back, n);
    return true;
}

/// Angle in degrees, the axis that is turned, the axis along which it is moved.
static bool skew(const double n[7], mat4 *m)
{
    double turned[3] = {n[1], n[2], n[3]}, along[3] = {n[4], n[5], n[6]};
    const double slope = tan(n[0] * ALPI_PI / 180.0);
    if (!make_unit(turned) || !make_unit(along) || !isfinite(slope)) {
        return false;
    }
    *m = mat4_identity(); // p + slope (p · turned) along
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++) {
            m->m[4 * column + row] += slope * turned[column] * along[row];
        }
    }
    return true;
}

alp_result alpi_collada_read_transform(const alpi_collada_document *document,
                                       const xmlNode *element, mat4 *matrix, bool *known)
{
    static const struct {
        const char *name;
        size_t count;
    } kinds[] = {{"matrix", 16}, {"translate", 3}, {"rotate", 4},
                 {"scale", 3},   {"lookat", 9},    {"skew", 7}};
    int kind = 0;
    while (kind < 6 && !alpi_xml_is(element, kinds[kind].name)) {
        kind++;
    }
    *matrix = mat4_identity();
    *known = kind < 6;
    if (!*known) {
        return ALP_OK;
    }
    double n[16];
    bool usable = true;
    ALP_TRY(alpi_collada_doubles(document, element, kinds[kind].count, n));
    switch (kind) {
    case 0:
        *matrix = from_rows(n);
        break;
    case 1:
        memcpy(matrix->m + 12, n, 3 * sizeof *n);
        break;
    case 2:
        *matrix = rotation(n);
        break;
    case 3:
        for (int k = 0; k < 3; k++) {
            matrix->m[5 * k] = n[k];
        }
        break;
    case 4:
        usable = look_at(n, matrix);
        break;
    default:
        usable = skew(n, matrix);
    }
    return usable ? ALP_OK : alpi_collada_fail(document, element, "its numbers give no direction");
}

// --- the asset -----------------------------------------------------------------------------------

/// meter="0.01"; some exporters print by their locale: "0,010000".
static alp_result read_unit(alpi_collada_reader *reader, const xmlNode *unit)
{
    const char *text = alpi_xml_attribute(unit, "meter");
    reader->metres_per_unit = 1.0;
    if (text == NULL) {
        return ALP_OK;
    }
    char number[64];
    snprintf(number, sizeof number, "%s", text);
    char *comma = strchr(number, ',');
    if (comma != NULL) {
        *comma = '.';
        alpi_note(reader->context, "unit", reader->document->path,
                  "the unit meter=\"%.40s\" is read with a decimal comma", text);
    }
    const char *at = number + strspn(number, " \t\r\n");
    double value = 0.0;
    if (!alpi_text_number(&at, &value) || *at != '\0' || !(value > 0.0) || !isfinite(value)) {
        return alpi_collada_fail(reader->document, unit,
                                 "its meter=\"%.40s\" is no length; write the metres of one unit",
                                 text);
    }
    reader->metres_per_unit = value;
    return ALP_OK;
}

alp_result alpi_collada_read_asset(alpi_collada_reader *reader)
{
    const xmlNode *asset = alpi_xml_child(reader->document->root, "asset");
    const xmlNode *unit = alpi_xml_child(asset, "unit"), *axis = alpi_xml_child(asset, "up_axis");
    ALP_TRY(read_unit(reader, unit));
    const double u = reader->metres_per_unit;
    const char *text = alpi_xml_text(axis);
    text += strspn(text, " \t\r\n");
    reader->scene->unit_metres = u;
    reader->scene->unit_assumed = alpi_xml_attribute(unit, "meter") == NULL;
    reader->scene->up_axis = *text >= 'X' && *text <= 'Z' ? *text : '\0';
    // columns: where the file's x, y and z go
    static const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    static const double minus_x[3] = {-1, 0, 0}, minus_z[3] = {0, 0, -1}, zero[3] = {0, 0, 0};
    if (strncmp(text, "Z_UP", 4) == 0) {
        reader->root = from_columns(x, minus_z, y, zero);
    } else if (strncmp(text, "X_UP", 4) == 0) {
        reader->root = from_columns(y, minus_x, z, zero);
    } else {
        reader->root = from_columns(x, y, z, zero);
    }
    for (int k = 0; k < 12; k++) {
        reader->root.m[k] *= u;
    }
    return ALP_OK;
}
