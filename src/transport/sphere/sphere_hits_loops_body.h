// SPDX-License-Identifier: MIT
// The loops over hits, included once for each instruction set. No fused operations in either: the
// same bits.
#include "transport/sphere/sphere_relight.h"

#include "base/random.h"
#include "transport/lane_loop.h"

enum { LANES = ALPI_PACKET };

/// Normals of the triangles, double and unit, on the side that the ray came from; 0 without area.
static void find_normals(const alpi_sphere_packet *p, const alpi_sphere_met *m,
                         double normal[3][LANES])
{
    const float(*c)[3][LANES] = m->corners;
    ALPI_EACH_LANE
    {
        const double ux = (double)c[1][0][i] - (double)c[0][0][i];
        const double uy = (double)c[1][1][i] - (double)c[0][1][i];
        const double uz = (double)c[1][2][i] - (double)c[0][2][i];
        const double vx = (double)c[2][0][i] - (double)c[0][0][i];
        const double vy = (double)c[2][1][i] - (double)c[0][1][i];
        const double vz = (double)c[2][2][i] - (double)c[0][2][i];
        const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        const double along = x * (double)p->rays.direction_x[i] +
                             y * (double)p->rays.direction_y[i] +
                             z * (double)p->rays.direction_z[i];
        const double length = sqrt(x * x + y * y + z * z);
        const double inverse = length > 0.0 ? 1.0 / length : 0.0;
        const double scale = along > 0.0 ? -inverse : inverse;
        normal[0][i] = x * scale;
        normal[1][i] = y * scale;
        normal[2][i] = z * scale;
    }
}

/// Places on the planes of the triangles: a distance is right to float steps of itself, which may
/// be more than the offset.
static void find_places(const alpi_sphere_packet *p, const alpi_sphere_met *m,
                        const double normal[3][LANES], double place[3][LANES])
{
    const float(*c)[LANES] = m->corners[0];
    ALPI_EACH_LANE
    {
        const double d = (double)m->distance[i];
        const double x = (double)p->rays.origin_x[i] + d * (double)p->rays.direction_x[i];
        const double y = (double)p->rays.origin_y[i] + d * (double)p->rays.direction_y[i];
        const double z = (double)p->rays.origin_z[i] + d * (double)p->rays.direction_z[i];
        const double height = normal[0][i] * (x - (double)c[0][i]) +
                              normal[1][i] * (y - (double)c[1][i]) +
                              normal[2][i] * (z - (double)c[2][i]);
        place[0][i] = x - height * normal[0][i];
        place[1][i] = y - height * normal[1][i];
        place[2][i] = z - height * normal[2][i];
    }
}

/// alpi_receiver_offset of each lane.
static void find_offsets(alpi_sphere_met *m)
{
    float largest[LANES];
    ALPI_EACH_LANE
    {
        const float x = fabsf(m->position[0][i]), y = fabsf(m->position[1][i]);
        const float z = fabsf(m->position[2][i]), wider = x > y ? x : y;
        largest[i] = wider > z ? wider : z;
    }
    for (int k = 0; k < 9; k++) {
        const float *corner = m->corners[k / 3][k % 3], *position = m->position[k % 3];
        ALPI_EACH_LANE
        {
            const float apart = fabsf(corner[i] - position[i]);
            largest[i] = apart > largest[i] ? apart : largest[i];
        }
    }
    ALPI_EACH_LANE
    {
        m->offset[i] = 2.0f * 0x1p-23f * largest[i];
    }
}

static void place(const alpi_sphere_packet *p, alpi_sphere_met *m)
{
    double normal[3][LANES], at[3][LANES];
    find_normals(p, m, normal);
    find_places(p, m, (const double(*)[LANES])normal, at);
    for (int k = 0; k < 3; k++) {
        ALPI_EACH_LANE
        {
            m->normal[k][i] = (float)normal[k][i];
            m->position[k][i] = (float)at[k][i];
        }
    }
    find_offsets(m);
    for (int k = 0; k < 3; k++) {
        ALPI_EACH_LANE
        {
            m->position[k][i] += m->offset[i] * m->normal[k][i];
            m->irradiance[k][i] = 0.0f;
        }
    }
    const uint32_t key = m->key, first = m->first;
    ALPI_EACH_LANE
    {
        m->random[i] = alpi_hash32(key ^ alpi_hash32(first + (uint32_t)i));
    }
}

static uint32_t aim(const alpi_sphere_met *m, const alpi_sphere_lamp *lamp, alpi_rays *rays,
                    float cosines[LANES])
{
    static const _Alignas(32) uint32_t bits[LANES] = {1, 2, 4, 8, 16, 32, 64, 128};
    uint32_t facing = 0;
    for (int i = 0; i < LANES; i++) {
        const float *d = lamp->directions[m->random[i] & lamp->mask];
        rays->direction_x[i] = d[0];
        rays->direction_y[i] = d[1];
        rays->direction_z[i] = d[2];
    }
    ALPI_EACH_LANE
    {
        rays->origin_x[i] = m->position[0][i];
        rays->origin_y[i] = m->position[1][i];
        rays->origin_z[i] = m->position[2][i];
        rays->minimum[i] = rays->time[i] = 0.0f;
        rays->maximum[i] = INFINITY;
        rays->mask[i] = UINT32_MAX;
        rays->id[i] = rays->flags[i] = 0;
    }
    ALPI_EACH_LANE
    {
        const float cosine = m->normal[0][i] * rays->direction_x[i] +
                             m->normal[1][i] * rays->direction_y[i] +
                             m->normal[2][i] * rays->direction_z[i];
        cosines[i] = cosine;
        facing |= cosine > 0.0f ? bits[i] : 0u;
    }
    return facing;
}

static void add(const alpi_rays *rays, uint32_t active, const float cosines[LANES], vec3 light,
                alpi_sphere_met *m)
{
    static const _Alignas(32) uint32_t bits[LANES] = {1, 2, 4, 8, 16, 32, 64, 128};
    ALPI_EACH_LANE
    {
        const bool open = (active & bits[i]) != 0 && rays->maximum[i] >= 0.0f;
        const float cosine = open ? cosines[i] : 0.0f;
        m->irradiance[0][i] += cosine * light.x;
        m->irradiance[1][i] += cosine * light.y;
        m->irradiance[2][i] += cosine * light.z;
    }
}

static void reflect(const alpi_sphere_met *m, alpi_sphere_packet *p)
{
    const float scale = 1.0f / (255.0f * 255.0f * (float)ALPI_PI);
    for (int c = 0; c < 3; c++) {
        ALPI_EACH_LANE
        {
            p->light[c][i] = m->albedo[c][i] * m->albedo[c][i] * scale * m->irradiance[c][i];
        }
    }
}

const alpi_sphere_hits_loops ALPI_VARIANT(alpi_sphere_hits_loops) = {place, aim, add, reflect};
