// SPDX-License-Identifier: MIT
// The look-up of probes, included once for each instruction set. No fused operations in either:
// the same bits.
//
// Most of the time goes into waiting for memory. So points are read in groups, in steps: a step
// fetches what the next one reads. The eight probes round a point are the lanes of its vectors.
#include "fields/probes/probe_lookup.h"

#include "base/octahedral.h"
#include "transport/lane_loop.h"

#include <math.h>
#include <string.h>

enum { GROUP = 8, LINE = 16 /* floats of a line of the cache */ };
typedef float four __attribute__((vector_size(16)));
_Static_assert(ALPI_PACKET == 8, "a lane for each probe round a point");

/// A point and the eight probes round it, lane by lane. Bit k of a lane: the upper one on axis k.
typedef struct probe_point {
    vec3 p, n;
    float low[3]; // where the lowest of them has its place
    _Alignas(32) uint32_t probe[ALPI_PACKET];
    _Alignas(32) float trilinear[ALPI_PACKET], weight[ALPI_PACKET];
    _Alignas(32) float facing[ALPI_PACKET], distance[ALPI_PACKET]; // with visibility alone
    _Alignas(32) float a[ALPI_PACKET], b[ALPI_PACKET];             // place between four texels
    _Alignas(32) uint32_t texel[ALPI_PACKET];                      // the first of them
} probe_point;

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline void fetch(const float *from, uint32_t floats)
{
    for (uint32_t i = 0; i < floats; i += LINE) {
        __builtin_prefetch(from + i);
    }
}

/// Finds the probes round a point, and their trilinear weights.
static inline void find_probes(const alpi_probe_field *f, uint32_t stride, probe_point *at)
{
    const float position[3] = {at->p.x, at->p.y, at->p.z};
    uint32_t index = 0, pitch = 1, step[3];
    float part[3];
    for (int k = 0; k < 3; k++) {
        const float last = (float)(int32_t)(f->size[k] - 1);
        const float cells = larger((position[k] - f->origin[k]) * f->inverse_spacing[k], 0.0f);
        const float x = cells < last ? cells : last;
        const uint32_t low = (uint32_t)(int32_t)x;
        const uint32_t lowest = low + 1 < f->size[k] ? low : f->size[k] > 1 ? f->size[k] - 2 : 0;
        part[k] = x - (float)(int32_t)lowest;
        at->low[k] = f->origin[k] + f->spacing[k] * (float)(int32_t)lowest;
        step[k] = f->size[k] > 1 ? pitch : 0;
        index += lowest * pitch;
        pitch *= f->size[k];
    }
    ALPI_EACH_LANE
    {
        const uint32_t x = (uint32_t)i & 1u, y = (uint32_t)i >> 1 & 1u, z = (uint32_t)i >> 2;
        at->probe[i] = index + x * step[0] + y * step[1] + z * step[2];
        at->trilinear[i] = (x != 0 ? part[0] : 1.0f - part[0]) *
                           (y != 0 ? part[1] : 1.0f - part[1]) *
                           (z != 0 ? part[2] : 1.0f - part[2]);
    }
    for (int i = 0; i < ALPI_PACKET; i += 2) { // neighbours on x lie side by side
        fetch(f->light + (size_t)at->probe[i] * stride, 2 * stride);
    }
}

/// A coordinate whose square is a float.
static inline float bounded(float x)
{
    const float most = 1e15f;
    return x < -most ? -most : x > most ? most : x;
}

/// Ways from a point to where its probes were sampled.
static inline void find_ways(const alpi_probe_field *f, const probe_point *at,
                             float way[3][ALPI_PACKET])
{
    uint32_t moved = 0;
    ALPI_EACH_LANE
    {
        const float x = (float)(i & 1), y = (float)(i >> 1 & 1), z = (float)(i >> 2);
        way[0][i] = at->low[0] + x * f->spacing[0] - at->p.x;
        way[1][i] = at->low[1] + y * f->spacing[1] - at->p.y;
        way[2][i] = at->low[2] + z * f->spacing[2] - at->p.z;
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        moved |= f->states[at->probe[i]] == ALPI_PROBE_MOVED ? 1u << i : 0u;
    }
    for (; moved != 0; moved &= moved - 1) {
        const int i = __builtin_ctz(moved);
        const vec3 to = vec3_sub(vec3_load(f->places[at->probe[i]]), at->p);
        way[0][i] = to.x;
        way[1][i] = to.y;
        way[2][i] = to.z;
    }
}

/// Finds how each probe faces the normal, and the texels of its distances towards the point.
static inline void find_texels(const alpi_probe_field *f, probe_point *at)
{
    _Alignas(32) float way[3][ALPI_PACKET];
    find_ways(f, at, way);
    ALPI_EACH_LANE
    {
        const float x = bounded(way[0][i]), y = bounded(way[1][i]), z = bounded(way[2][i]);
        const float distance = sqrtf(x * x + y * y + z * z);
        const float inverse = 1.0f / larger(distance, 1e-12f);
        const float cosine = (at->n.x * x + at->n.y * y + at->n.z * z) * inverse;
        const float half = 0.5f * (cosine + 1.0f);
        // At the probe itself any direction will do.
        const vec3 back = {-x, -y, distance > 0.0f ? -z : 1.0f};
        const vec2 uv = alpi_octahedral_encode(back);
        const float u = uv.x * ALPI_PROBE_MOMENT_SIDE + 0.5f;
        const float v = uv.y * ALPI_PROBE_MOMENT_SIDE + 0.5f;
        const int column = (int)u, row = (int)v;
        at->facing[i] = half * half + 0.2f;
        at->distance[i] = distance;
        at->a[i] = u - (float)column;
        at->b[i] = v - (float)row;
        at->texel[i] =
            at->probe[i] * ALPI_LOOKUP_MOMENTS + (uint32_t)(row * ALPI_LOOKUP_SIDE + column);
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float *texel = f->moments[at->texel[i]];
        __builtin_prefetch(texel);
        __builtin_prefetch(texel + 2 * ALPI_LOOKUP_SIDE);
    }
}

/// Weighs probes by what they see of the point, and by how they face its normal.
static inline void weigh_seen(const alpi_probe_field *f, probe_point *at)
{
    _Alignas(32) float mean[ALPI_PACKET], square[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float *upper = f->moments[at->texel[i]], *lower = upper + 2 * ALPI_LOOKUP_SIDE;
        const float a = at->a[i], b = at->b[i];
        four above, below; // moments left and right of the point
        memcpy(&above, upper, sizeof above);
        memcpy(&below, lower, sizeof below);
        const four between = above + b * (below - above);
        mean[i] = between[0] + a * (between[2] - between[0]);
        square[i] = between[1] + a * (between[3] - between[1]);
    }
    ALPI_EACH_LANE
    {
        const float variance = fabsf(square[i] - mean[i] * mean[i]) + 1e-12f;
        const float beyond = larger(at->distance[i] - mean[i], 0.0f);
        const float share = variance / (variance + beyond * beyond);
        const float w = at->facing[i] * larger(share * share * share, 0.05f);
        at->weight[i] = at->trilinear[i] * (w < 0.2f ? w * w * w * 25.0f : w);
    }
}

/// Sets weights to 0 whose probes do not count. @param most the last state that counts
/// @return sum of the weights
static inline float keep_states(const alpi_probe_field *f, uint8_t most, probe_point *at)
{
    float sum = 0.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        at->weight[i] = f->states[at->probe[i]] <= most ? at->weight[i] : 0.0f;
        sum += at->weight[i];
    }
    return sum;
}

/// Sums of weight · light, four floats at a time: they stay in a register.
static inline void add_light(const alpi_probe_field *f, const probe_point *at, uint32_t stride,
                             float *restrict sums)
{
    for (uint32_t j = 0; j < stride; j += 4) {
        four sum = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int i = 0; i < ALPI_PACKET; i++) {
            four light;
            memcpy(&light, f->light + (size_t)at->probe[i] * stride + j, sizeof light);
            sum += at->weight[i] * light;
        }
        memcpy(sums + j, &sum, sizeof sum);
    }
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

static inline void add_gradients(const alpi_probe_field *f, const probe_point *at, int lane,
                                 uint32_t stride, float *sums)
{
    const uint32_t probe = at->probe[lane];
    const vec3 way =
        vec3_scale(vec3_sub(within(f, at->p), vec3_load(f->places[probe])), at->weight[lane]);
    const float *g = f->gradients + (size_t)probe * 3 * stride;
    for (uint32_t j = 0; j < stride; j++) {
        sums[j] += way.x * g[j] + way.y * g[stride + j] + way.z * g[2 * stride + j];
    }
}

/// Irradiance by weighed probes. @param total sum of their weights
static inline void read_light(const alpi_probe_field *f, const probe_point *at, float total,
                              uint32_t stride, float *irradiance)
{
    float sums[ALPI_LOOKUP_STRIDE_MOST] = {0.0f}, weights[ALPI_SH9_COUNT],
          e[3] = {0.0f, 0.0f, 0.0f};
    add_light(f, at, stride, sums);
    for (int i = 0; i < ALPI_PACKET && f->gradients != NULL; i++) {
        add_gradients(f, at, i, stride, sums);
    }
    alpi_probe_weights(f->basis, at->n, weights);
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

/// At most GROUP points.
static inline void read_group(const alpi_probe_field *f, uint32_t count,
                              const float (*positions)[3], const float (*normals)[3],
                              uint32_t stride, float (*irradiance)[3])
{
    probe_point points[GROUP];
    for (uint32_t i = 0; i < count; i++) {
        probe_point *at = &points[i];
        at->p = vec3_load(positions[i]);
        at->n = vec3_load(normals[i]);
        if (f->along_normal) {
            at->p.x += 0.5f * f->spacing[0] * at->n.x;
            at->p.y += 0.5f * f->spacing[1] * at->n.y;
            at->p.z += 0.5f * f->spacing[2] * at->n.z;
        }
        find_probes(f, stride, at);
    }
    for (uint32_t i = 0; i < count && f->moments != NULL; i++) {
        find_texels(f, &points[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        probe_point *at = &points[i];
        if (f->moments != NULL) {
            weigh_seen(f, at);
        } else {
            memcpy(at->weight, at->trilinear, sizeof at->weight);
        }
        float total = keep_states(f, f->moments != NULL ? ALPI_PROBE_MOVED : ALPI_PROBE_FILLED, at);
        if (!(total > 0.0f)) { // probes in solids, for want of others
            memcpy(at->weight, at->trilinear, sizeof at->weight);
            total = keep_states(f, ALPI_PROBE_FILLED, at);
        }
        read_light(f, at, total, stride, irradiance[i]);
    }
}

void ALPI_VARIANT(alpi_probe_lookup)(const alp_field *field, uint32_t count,
                                     const float (*positions)[3], const float (*normals)[3],
                                     float (*irradiance)[3])
{
    const alpi_probe_field *f = (const alpi_probe_field *)field;
    for (uint32_t i = 0; i < count; i += GROUP) { // strides that the compiler knows become vectors
        const uint32_t some = count - i < GROUP ? count - i : GROUP;
        switch (f->stride) {
        case 28:
            read_group(f, some, positions + i, normals + i, 28, irradiance + i);
            break;
        case 20:
            read_group(f, some, positions + i, normals + i, 20, irradiance + i);
            break;
        default:
            read_group(f, some, positions + i, normals + i, 12, irradiance + i);
        }
    }
}
