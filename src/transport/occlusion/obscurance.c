// SPDX-License-Identifier: MIT
#include "transport/occlusion/obscurance.h"

#include "transport/occlusion/falloff.h"
#include "transport/occlusion/occlusion_aim.h"

/// The albedo of a hit on the side that its ray met: black behind a single-sided surface.
static vec3 albedo_of(const alp_scene *scene, const alpi_hits *hits, const alpi_rays *rays,
                      int lane)
{
    const uint32_t triangle = hits->triangle[lane];
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 normal = vec3_cross(vec3_sub(c[1], c[0]), vec3_sub(c[2], c[0]));
    const vec3 direction = {rays->direction_x[lane], rays->direction_y[lane],
                            rays->direction_z[lane]};
    if (vec3_dot(direction, normal) > 0.0f && !alpi_surface_is_double_sided(scene, triangle)) {
        return (vec3){0.0f, 0.0f, 0.0f};
    }
    return alpi_surface_albedo(scene, triangle, hits->b1[lane], hits->b2[lane]);
}

static void add_hits(const alpi_occlusion_setup *setup, const alpi_rays *rays,
                     const alpi_hits *hits, uint32_t active, alpi_occlusion_tally *tally,
                     double sum[3][ALPI_PACKET])
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        float color[3] = {1.0f, 1.0f, 1.0f};
        if ((active >> i & 1u) == 0) {
            continue;
        }
        if (hits->triangle[i] == ALPI_NONE) {
            tally->open[i]++;
        } else {
            const float t = fminf(hits->distance[i] / setup->distance, 1.0f);
            const float w = alpi_falloff_weight(setup->falloff, t);
            const vec3 albedo = albedo_of(setup->scene, hits, rays, i);
            color[0] = (1.0f - w) + w * albedo.x;
            color[1] = (1.0f - w) + w * albedo.y;
            color[2] = (1.0f - w) + w * albedo.z;
        }
        for (int k = 0; k < 3; k++) {
            sum[k][i] += (double)color[k];
        }
    }
}

/// The packets of one receiver, number r of the stand.
static void color_receiver(const alpi_occlusion_setup *setup, const alpi_sample_packet *packets,
                           const alpi_sample_chunk *chunk, alpi_occlusion_stand *stand, uint32_t r,
                           alpi_occlusion_tally *tally)
{
    alpi_occlusion_lanes *groups = stand->groups + r * (size_t)chunk->groups;
    alpi_rays *rays = &stand->rays[0];
    alpi_hits hits;
    double sum[3][ALPI_PACKET] = {{0}}; // floats would drift: a room of one colour adds it up
    for (uint32_t g = 0; g < chunk->groups; g++) {
        alpi_lanes_frames(&groups[g]);
    }
    for (uint32_t k = 0; k < chunk->packet_count; k++) {
        const alpi_occlusion_lanes *lanes = &groups[k / chunk->block];
        const uint32_t active =
            k + 1 < chunk->packet_count ? (1u << ALPI_PACKET) - 1u : chunk->last;
        const alpi_ray_lanes to = ALPI_RAY_LANES(rays, 0);
        alpi_lanes_start(lanes, &to);
        alpi_lanes_aim(setup, lanes, &packets[k], stand->shifts[r], &to);
        alpi_trace_nearest(setup->tracer, rays, active, setup->filter, &hits);
        add_hits(setup, rays, &hits, active, tally, sum);
    }
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            tally->sum[k][i] += (float)sum[k][i];
        }
    }
}

void alpi_obscurance_kernel(const alpi_occlusion_setup *setup, const alpi_sample_run *run,
                            const alpi_sample_chunk *chunk, alpi_occlusion_stand *stand,
                            alpi_occlusion_tally *tallies)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        stand->rays[0].maximum[i] = setup->distance;
    }
    for (uint32_t r = 0; r < stand->receivers; r++) {
        color_receiver(setup, run->packets + chunk->first_packet, chunk, stand, r, &tallies[r]);
    }
}

alp_result alpi_obscurance_gather(const alpi_occlusion_setup *setup,
                                  const alpi_receivers *receivers, const uint32_t *list,
                                  uint32_t list_count, uint32_t samples,
                                  const alpi_task_progress *progress, alpi_occlusion_sums *sums,
                                  float (*rgb)[3])
{
    alpi_occlusion_setup colored = *setup;
    colored.bent = false;
    colored.kernel = alpi_obscurance_kernel;
    ALP_TRY(alpi_occlusion_add(&colored, receivers, list, list_count, 0, samples, samples, progress,
                               sums));
    for (uint32_t i = 0; i < list_count; i++) {
        const uint32_t id = list != NULL ? list[i] : i;
        vec3_store(rgb[id], alpi_occlusion_mean_vector(sums, id));
    }
    return ALP_OK;
}
