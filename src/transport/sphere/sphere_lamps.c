// SPDX-License-Identifier: MIT
#include "transport/sphere/sphere_lamps.h"

#include "base/random.h"
#include "base/tasks.h"
#include "base/tiles/tiles.h"
#include "transport/paths/panes.h"

#include <math.h>

enum { STREAM_LAMPS = 13, DISK_SAMPLES = 16 };

/// Shadow rays on their way, and what each brings.
typedef struct lamp_packet {
    alpi_rays rays;
    vec3 directions[ALPI_PACKET], light[ALPI_PACKET];
    uint32_t count;
} lamp_packet;

static void add(vec3 direction, vec3 light, alpi_sh9 *sum)
{
    float basis[ALPI_SH9_COUNT];
    alpi_sh9_basis(direction, basis);
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        sum->c[i][0] += basis[i] * light.x;
        sum->c[i][1] += basis[i] * light.y;
        sum->c[i][2] += basis[i] * light.z;
    }
}

static void flush(const alpi_sphere_rays *r, lamp_packet *p, alpi_sh9 *sum)
{
    alpi_trace_filter filter = r->from.filter;
    filter.panes = alpi_tracer_has_panes(r->from.tracer);
    const uint32_t active =
        alpi_occluders_open(r->occluders, &p->rays, p->rays.maximum, (1u << p->count) - 1u);
    vec3 left[ALPI_PACKET];
    uint32_t open = 0;
    if (p->count == 0) {
        return;
    }
    alpi_trace_occluded(r->from.tracer, &p->rays, 1, active, filter, ALPI_RAYS_NEAR);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
        open |= (active >> i & 1u) != 0 && p->rays.maximum[i] >= 0.0f ? 1u << i : 0u;
    }
    if (filter.panes && open != 0) {
        alpi_panes_dim(r->from.scene, r->from.tracer, filter, open, &p->rays, left);
    }
    for (uint32_t i = 0; i < p->count; i++) {
        if ((open >> i & 1u) != 0) {
            const vec3 l = p->light[i], k = left[i];
            add(p->directions[i], (vec3){l.x * k.x, l.y * k.y, l.z * k.z}, sum);
        }
    }
    p->count = 0;
    alpi_rays_clear(&p->rays);
}

/// Sends the shadow rays of one light.
static void aim_at(const alpi_sphere_lamps *job, uint32_t light, vec3 point, uint32_t key,
                   lamp_packet *p, alpi_sh9 *sum)
{
    const bool disk = alpi_lighting_light(job->lighting, light)->size > 0.0f;
    const uint32_t samples = disk ? DISK_SAMPLES : 1;
    const float offset = alpi_receiver_offset(point, NULL);
    for (uint32_t i = 0; i < samples; i++) {
        alpi_light_sample s;
        if (!alpi_lighting_sample_light(job->lighting, light, point, alpi_sample_2d(key, i), &s)) {
            continue;
        }
        // A disk's radiance over its density is E⊥.
        const float scale = disk ? 1.0f / (s.density * (float)samples) : 1.0f;
        const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * offset;
        alpi_rays_set(&p->rays, (int)p->count, point, s.direction, fmaxf(reach, 0.0f));
        p->directions[p->count] = s.direction;
        p->light[p->count++] = vec3_scale(s.light, scale);
        if (p->count == ALPI_PACKET) {
            flush(job->rays, p, sum);
        }
    }
}

void alpi_sphere_lamps_at(const alpi_sphere_lamps *job, vec3 point, uint32_t number, alpi_sh9 *sum)
{
    const uint32_t lights = alpi_lighting_light_count(job->lighting);
    const uint32_t key = alpi_random_key(job->rays->seed, number, STREAM_LAMPS);
    const bool all = job->light == ALPI_NONE;
    lamp_packet packet = {.count = 0};
    alpi_rays_clear(&packet.rays);
    for (uint32_t k = all ? 0 : job->light; k < (all ? lights : job->light + 1); k++) {
        aim_at(job, k, point, alpi_hash32(key ^ alpi_hash32(k + 1u)), &packet, sum);
    }
    flush(job->rays, &packet, sum);
}

static alp_result light_points(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_sphere_lamps *job = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t index = job->list != NULL ? job->list[i] : i;
        const vec3 point = vec3_load(job->points[index]);
        alpi_sphere_lamps_at(job, point, index, &job->values[index].light);
        if (!alpi_loop_goes_on(job->rays->context)) {
            return ALP_ERROR_CANCELLED;
        }
    }
    return ALP_OK;
}

alp_result alpi_sphere_lamps_add(const alpi_sphere_lamps *job, const alpi_task_progress *progress)
{
    alpi_sphere_lamps own = *job;
    const alpi_tile_output values = {
        .data = job->values, .size = sizeof *job->values, .list = job->list, .count = job->count};
    return alpi_tile_loop_run(job->rays->context, &(alpi_tile_loop){.name = "sphere-lamps",
                                                                    .count = job->count,
                                                                    .grain = 16,
                                                                    .body = light_points,
                                                                    .user = &own,
                                                                    .progress = progress,
                                                                    .outputs = &values,
                                                                    .output_count = 1});
}
