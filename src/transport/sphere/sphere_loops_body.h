// SPDX-License-Identifier: MIT
// The loops over the rays of a cube's pixels, included once for each instruction set. No fused
// operations in either: the same bits.
#include "transport/sphere/sphere_rays.h"

#include "base/octahedral.h"
#include "base/random.h"
#include "transport/lane_loop.h"

#include <string.h>

/// tan(πs/4) on [−1, 1] as a quotient of polynomials (Padé 5/4), error below 2e-8.
static inline float quarter_tangent(float s)
{
    const float q = s * s;
    return s * (0.78539816f + q * (-0.053830341f + q * 0.00031624058f)) /
           (1.0f + q * (-0.27415568f + q * 0.0060397502f));
}

static void aim(const alpi_sphere_place *place, alpi_sphere_packet *p)
{
    const float step = 2.0f / (float)place->face_side;
    const float sign = place->face % 2 == 0 ? 1.0f : -1.0f;
    const float scale = step * step * 0.61685028f; // (π/4)²
    const uint32_t axis = place->face / 2;
    float *directions[3] = {p->rays.direction_x, p->rays.direction_y, p->rays.direction_z};
    float *forward = directions[axis], *right = directions[(axis + 1) % 3];
    float *up = directions[(axis + 2) % 3];
    alpi_rays_start(&p->rays, place->point);
    const uint32_t first =
        (place->face * place->face_side + place->row) * place->face_side + place->column;
    ALPI_EACH_LANE
    {
        const uint32_t column = (uint32_t)i % 4, row = (uint32_t)i / 4;
        const uint32_t random =
            alpi_hash32(place->key ^ alpi_hash32(first + row * place->face_side + column));
        const float u = (float)(int32_t)(random >> 16) * 0x1p-16f + 0x1p-17f;
        const float v = (float)(int32_t)(random & 0xffffu) * 0x1p-16f + 0x1p-17f;
        const float s = ((float)(int32_t)(place->column + column) + u) * step - 1.0f;
        const float t = ((float)(int32_t)(place->row + row) + v) * step - 1.0f;
        const float x = quarter_tangent(s), y = quarter_tangent(t);
        const float square = 1.0f + x * x + y * y, inverse = 1.0f / sqrtf(square);
        forward[i] = sign * inverse;
        right[i] = x * inverse;
        up[i] = y * inverse;
        p->weight[i] = scale * (1.0f + x * x) * (1.0f + y * y) * inverse / square;
    }
}

static uint32_t find_met(const alpi_hits *hits)
{
    static const _Alignas(32) uint32_t bits[ALPI_PACKET] = {1, 2, 4, 8, 16, 32, 64, 128};
    uint32_t met = 0;
    ALPI_EACH_LANE
    {
        met |= hits->triangle[i] != ALPI_NONE ? bits[i] : 0u;
    }
    return met;
}

static void find_nearest(const alpi_hits *hits, float nearest[ALPI_PACKET])
{
    ALPI_EACH_LANE
    {
        nearest[i] = hits->distance[i] < nearest[i] ? hits->distance[i] : nearest[i];
    }
}

static void light(const float (*cells)[4], const uint32_t of[ALPI_PACKET], alpi_sphere_packet *p)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float *cell = cells[of[i]];
        p->light[0][i] = cell[0];
        p->light[1][i] = cell[1];
        p->light[2][i] = cell[2];
    }
}

static void add(const alpi_sphere_packet *packets, uint32_t count, alpi_sphere_tallies *tallies)
{
    for (uint32_t k = 0; k < count; k++) {
        const alpi_sphere_packet *p = &packets[k];
        float basis[ALPI_SH9_COUNT][ALPI_PACKET];
        ALPI_EACH_LANE
        {
            const float x = p->rays.direction_x[i], y = p->rays.direction_y[i];
            const float z = p->rays.direction_z[i], w = p->weight[i];
            basis[0][i] = w * 0.28209479f;
            basis[1][i] = w * 0.48860251f * y;
            basis[2][i] = w * 0.48860251f * z;
            basis[3][i] = w * 0.48860251f * x;
            basis[4][i] = w * 1.0925484f * x * y;
            basis[5][i] = w * 1.0925484f * y * z;
            basis[6][i] = w * 0.31539157f * (3.0f * z * z - 1.0f);
            basis[7][i] = w * 1.0925484f * x * z;
            basis[8][i] = w * 0.54627422f * (x * x - y * y);
        }
        for (int b = 0; b < ALPI_SH9_COUNT; b++) {
            for (int c = 0; c < 3; c++) {
                float *sum = tallies->light[3 * b + c];
                const float *light = p->light[c];
                ALPI_EACH_LANE
                {
                    sum[i] += basis[b][i] * light[i];
                }
            }
        }
        ALPI_EACH_LANE
        {
            tallies->weight[i] += p->weight[i];
        }
    }
}

static void find_slots(const alpi_sphere_packet *p, const alpi_hits *hits, float reach,
                       float distance[ALPI_PACKET], int32_t slot[ALPI_PACKET])
{
    enum { SIDE = ALPI_SPHERE_MOMENT_SIDE, BINS = ALPI_MOMENT_BINS };
    enum { BIN_BITS = 21, LAST = 0x3f800000 >> BIN_BITS }; // exponent, two bits of the mantissa
    const float scale = 1.0f / reach;
    ALPI_EACH_LANE
    {
        const vec2 uv = alpi_octahedral_encode(
            (vec3){p->rays.direction_x[i], p->rays.direction_y[i], p->rays.direction_z[i]});
        const int column = (int)(uv.x * SIDE), row = (int)(uv.y * SIDE);
        const float far = hits->distance[i], met = far < reach ? far : reach, share = met * scale;
        int32_t bits;
        memcpy(&bits, &share, sizeof bits);
        const int bin = (bits >> BIN_BITS) - LAST + BINS - 1;
        const int low = bin > 0 ? bin : 0;
        distance[i] = met;
        slot[i] =
            ((row < SIDE ? row : SIDE - 1) * SIDE + (column < SIDE ? column : SIDE - 1)) * BINS +
            (low < BINS ? low : BINS - 1);
    }
}

const alpi_sphere_loops ALPI_VARIANT(alpi_sphere_loops) = {aim,   find_met, find_nearest,
                                                           light, add,      find_slots};
