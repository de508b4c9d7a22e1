// SPDX-License-Identifier: MIT
// The look-up of probes, included once for each instruction set. No fused operations in either:
// the same bits.
#include "fields/probes/probe_lookup.h"

#include "base/octahedral.h"

#include <math.h>
#include <string.h>

/// The cell of a point: its lowest corner, and the place in it by axis.
typedef struct probe_cell {
    uint32_t index, step[3]; // of the lowest probe, and to its neighbours (0 at the end of an axis)
    float part[3];
} probe_cell;

static inline probe_cell find_cell(const alpi_probe_field *f, vec3 p)
{
    const float at[3] = {p.x, p.y, p.z};
    uint32_t stride = 1;
    probe_cell cell = {.index = 0};
    for (int k = 0; k < 3; k++) {
        const float last = (float)(int32_t)(f->size[k] - 1);
        const float x = fminf(fmaxf((at[k] - f->origin[k]) * f->inverse_spacing[k], 0.0f), last);
        const uint32_t low = (uint32_t)(int32_t)x;
        const uint32_t lowest = low + 1 < f->size[k] ? low : f->size[k] > 1 ? f->size[k] - 2 : 0;
        cell.part[k] = x - (float)(int32_t)lowest;
        cell.step[k] = f->size[k] > 1 ? stride : 0;
        cell.index += lowest * stride;
        stride *= f->size[k];
    }
    return cell;
}

/// Share of the light of a probe that is not hidden at `distance` in a direction from it.
static inline float visible(float (*moments)[2], vec3 direction, float distance)
{
    const vec2 uv = alpi_octahedral_encode(direction);
    const float x = uv.x * ALPI_PROBE_MOMENT_SIDE + 0.5f, y = uv.y * ALPI_PROBE_MOMENT_SIDE + 0.5f;
    const int column = (int)x, row = (int)y;
    const float a = x - (float)column, b = y - (float)row;
    const float *m = moments[row * ALPI_LOOKUP_SIDE + column];
    float found[2];
    for (int k = 0; k < 2; k++) {
        const float *below = m + 2 * ALPI_LOOKUP_SIDE;
        const float near = m[k] + a * (m[2 + k] - m[k]);
        const float far = below[k] + a * (below[2 + k] - below[k]);
        found[k] = near + b * (far - near);
    }
    const float variance = fabsf(found[1] - found[0] * found[0]);
    const float beyond = fmaxf(distance - found[0], 0.0f);
    const float share = (variance + 1e-12f) / (variance + 1e-12f + beyond * beyond);
    return fmaxf(share * share * share, 0.05f);
}

static inline float weigh(const alpi_probe_field *f, uint32_t probe, vec3 p, vec3 n)
{
    const vec3 way = vec3_sub(vec3_load(f->places[probe]), p);
    const float distance = vec3_length(way);
    const vec3 unit = vec3_scale(way, 1.0f / fmaxf(distance, 1e-12f));
    const float half = 0.5f * (vec3_dot(n, unit) + 1.0f);
    float w = half * half + 0.2f;
    if (distance > 0.0f && distance < 1e18f) { // the square of a longer way overflows
        w *= visible(f->moments + (size_t)probe * ALPI_LOOKUP_MOMENTS, vec3_scale(unit, -1.0f),
                     distance);
    }
    return w < 0.2f ? w * w * w * 25.0f : w;
}

/// The nearest point of the lattice's outer cells: gradients do not reach beyond.
static inline vec3 within(const alpi_probe_field *f, vec3 p)
{
    float at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        const float low = f->origin[k] - 0.5f * f->spacing[k];
        const float high = low + (float)(int32_t)f->size[k] * f->spacing[k];
        at[k] = fminf(fmaxf(at[k], low), high);
    }
    return vec3_load(at);
}

static inline void add_light(const alpi_probe_field *f, uint32_t probe, float weight, vec3 p,
                             uint32_t stride, float *sums)
{
    const float *light = f->light + (size_t)probe * stride;
    for (uint32_t j = 0; j < stride; j++) {
        sums[j] += weight * light[j];
    }
    if (f->gradients != NULL) {
        const vec3 way = vec3_sub(within(f, p), vec3_load(f->places[probe]));
        const float along[3] = {way.x * weight, way.y * weight, way.z * weight};
        const float *g = f->gradients + (size_t)probe * 3 * stride;
        for (uint32_t j = 0; j < stride; j++) {
            sums[j] += along[0] * g[j] + along[1] * g[stride + j] + along[2] * g[2 * stride + j];
        }
    }
}

/// Adds the light of the probes round a point. @param filled those in solids too
/// @return sum of the weights
static inline float gather(const alpi_probe_field *f, const probe_cell *cell, vec3 p, vec3 n,
                           bool filled, uint32_t stride, float *sums)
{
    float total = 0.0f;
    for (int corner = 0; corner < 8; corner++) {
        uint32_t probe = cell->index;
        float weight = 1.0f;
        for (int k = 0; k < 3; k++) {
            const bool upper = (corner >> k & 1) != 0;
            weight *= upper ? cell->part[k] : 1.0f - cell->part[k];
            probe += upper ? cell->step[k] : 0;
        }
        const uint8_t state = f->states[probe];
        if (!(weight > 0.0f) || state > (filled ? ALPI_PROBE_FILLED : ALPI_PROBE_MOVED)) {
            continue;
        }
        if (f->moments != NULL && !filled) {
            weight *= weigh(f, probe, p, n);
        }
        add_light(f, probe, weight, p, stride, sums);
        total += weight;
    }
    return total;
}

static inline void read_one(const alpi_probe_field *f, const float *position, const float *normal,
                            uint32_t stride, float *irradiance)
{
    float sums[ALPI_LOOKUP_STRIDE_MOST] = {0.0f}, weights[ALPI_SH9_COUNT],
          e[3] = {0.0f, 0.0f, 0.0f};
    vec3 p = vec3_load(position);
    const vec3 n = vec3_load(normal);
    if (f->along_normal) {
        p.x += 0.5f * f->spacing[0] * n.x;
        p.y += 0.5f * f->spacing[1] * n.y;
        p.z += 0.5f * f->spacing[2] * n.z;
    }
    const probe_cell cell = find_cell(f, p);
    float total = gather(f, &cell, p, n, f->moments == NULL, stride, sums);
    if (!(total > 0.0f)) {
        total = gather(f, &cell, p, n, true, stride, sums);
    }
    alpi_probe_weights(f->basis, n, weights);
    for (uint32_t i = 0; i < f->coefficient_count; i++) {
        for (int k = 0; k < 3; k++) {
            e[k] += weights[i] * sums[3 * i + (uint32_t)k];
        }
    }
    const float scale = total > 0.0f ? 1.0f / total : 0.0f;
    for (int k = 0; k < 3; k++) {
        irradiance[k] = e[k] * scale;
    }
}

void ALPI_VARIANT(alpi_probe_lookup)(const alp_field *field, uint32_t count,
                                     const float (*positions)[3], const float (*normals)[3],
                                     float (*irradiance)[3])
{
    const alpi_probe_field *f = (const alpi_probe_field *)field;
    for (uint32_t i = 0; i < count; i++) { // strides that the compiler knows become vectors
        switch (f->stride) {
        case 28:
            read_one(f, positions[i], normals[i], 28, irradiance[i]);
            break;
        case 20:
            read_one(f, positions[i], normals[i], 20, irradiance[i]);
            break;
        default:
            read_one(f, positions[i], normals[i], 12, irradiance[i]);
        }
    }
}
