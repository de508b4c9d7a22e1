// SPDX-License-Identifier: MIT
#include "transport/gather/gather.h"

#include "base/hash.h"
#include "base/tasks.h"
#include "transport/gather/near_rays.h"
#include "transport/paths/panes.h"

#include <string.h>

/// Points that rays of a packet have met, and whose they are.
typedef struct met_points {
    uint32_t left_scene; // bit i: lane i met nothing
    uint32_t count;
    int lanes[ALPI_PACKET];
    alpi_surface_point points[ALPI_PACKET];
} met_points;

static void add_light(vec3 *sum, vec3 light, vec3 left)
{
    sum->x += light.x * left.x;
    sum->y += light.y * left.y;
    sum->z += light.z * left.z;
}

/// NULL: it does not count.
static const alpi_sky *sky_of(const alpi_gather_scene *from)
{
    return from->sky && from->lighting != NULL ? alpi_lighting_sky(from->lighting) : NULL;
}

static vec3 direction_of(const alpi_rays *rays, int lane)
{
    return (vec3){rays->direction_x[lane], rays->direction_y[lane], rays->direction_z[lane]};
}

/// Lists what is not black, and adds sky to the rays that leave.
static void sort_hits(const alpi_gather_scene *from, const alpi_rays *rays, const alpi_hits *hits,
                      uint32_t active, met_points *met, const vec3 *left, vec3 *radiance)
{
    const alpi_sky *sky = sky_of(from);
    met->count = met->left_scene = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) == 0) {
            continue;
        }
        const vec3 direction = direction_of(rays, i);
        const uint32_t triangle = hits->triangle[i];
        if (triangle == ALPI_NONE) {
            met->left_scene |= 1u << i;
            if (sky != NULL) {
                add_light(&radiance[i], alpi_sky_radiance(sky, direction), left[i]);
            }
            continue;
        }
        const bool behind = (hits->behind >> i & 1u) != 0;
        if (!behind || alpi_surface_is_double_sided(from->scene, triangle)) {
            met->lanes[met->count] = i;
            met->points[met->count++] = (alpi_surface_point){triangle, hits->b1[i], hits->b2[i],
                                                             vec3_scale(direction, -1.0f), behind};
        }
    }
}

static void add_surfaces(const alpi_gather_scene *from, const met_points *met, const vec3 *left,
                         vec3 *radiance)
{
    vec3 reflected[ALPI_PACKET];
    if (from->light.reflected != NULL && met->count > 0) {
        from->light.reflected(from->light.user, met->points, met->count, reflected);
    }
    for (uint32_t k = 0; k < met->count; k++) {
        const alpi_surface_point *p = &met->points[k];
        const int i = met->lanes[k];
        if (from->light.reflected != NULL) {
            add_light(&radiance[i], reflected[k], left[i]);
        }
        if (from->emitters) {
            const vec3 emitted =
                alpi_surface_emission(from->scene, p->triangle, p->b1, p->b2, p->toward);
            add_light(&radiance[i], emitted, left[i]);
        }
    }
}

void alpi_gather_trace(const alpi_gather_scene *from, alpi_rays *rays, uint32_t active,
                       bool coherent, vec3 radiance[ALPI_PACKET], vec3 open[ALPI_PACKET])
{
    const vec3 black = {0.0f, 0.0f, 0.0f};
    alpi_trace_filter filter = from->filter;
    filter.panes = alpi_tracer_has_panes(from->tracer);
    vec3 left[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        radiance[i] = black;
        left[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    for (int i = 0; i < ALPI_PACKET && open != NULL; i++) {
        open[i] = black;
    }
    for (int passed = 0; active != 0 && passed < ALPI_PANE_LIMIT; passed++) {
        alpi_hits hits;
        met_points met;
        if (coherent) {
            alpi_trace_nearest_coherent(from->tracer, rays, active, filter, &hits);
        } else {
            alpi_trace_nearest(from->tracer, rays, active, filter, &hits);
        }
        if (from->medium.dim != NULL) {
            from->medium.dim(from->medium.user, rays, &hits, active, left);
        }
        sort_hits(from, rays, &hits, active, &met, left, radiance);
        add_surfaces(from, &met, left, radiance);
        for (int i = 0; i < ALPI_PACKET && open != NULL; i++) {
            open[i] = (met.left_scene >> i & 1u) != 0 ? left[i] : open[i];
        }
        active = filter.panes ? alpi_panes_go_on(from->scene, &hits, active, rays, left) : 0;
    }
}

// --- sums ----------------------------------------------------------------------------------------

static double weight_of(const alpi_gatherer *g, uint32_t packet, int lane)
{
    return g->weights != NULL ? (double)g->weights[packet][lane]
                              : 1.0 / ((double)g->packet_count * ALPI_PACKET);
}

void alpi_gather_add(const alpi_gatherer *gatherer, uint32_t packet,
                     const vec3 radiance[ALPI_PACKET], alpi_gather_sums *sums)
{
    double *sum = sums->light[alpi_gather_replicate(gatherer, packet)];
    for (int i = 0; i < ALPI_PACKET; i++) {
        const double weight = weight_of(gatherer, packet, i);
        sum[0] += weight * (double)radiance[i].x;
        sum[1] += weight * (double)radiance[i].y;
        sum[2] += weight * (double)radiance[i].z;
    }
}

/// Σ weight over the lanes that hold a cell.
static float weigh_cells(const float weights[ALPI_PACKET], const uint32_t cells[ALPI_PACKET],
                         uint32_t cell)
{
    float sum = 0.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        sum += cells[i] == cell ? weights[i] : 0.0f;
    }
    return sum;
}

void alpi_gather_add_cells(const alpi_gatherer *gatherer, uint32_t packet,
                           const uint32_t cells[ALPI_PACKET], const float (*light)[4],
                           alpi_gather_sums *sums)
{
    static const float ones[ALPI_PACKET] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    double *sum = sums->light[alpi_gather_replicate(gatherer, packet)];
    const bool even = gatherer->weights == NULL;
    const float *weights = even ? ones : gatherer->weights[packet];
    float parts[4] = {0.0f}; // the last, of sides, is not used: four floats make a vector
    bool none = false;       // of the cells is one of those that are none
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float *l = light[cells[i]];
        for (int k = 0; k < 4; k++) {
            parts[k] += weights[i] * l[k];
        }
        none |= cells[i] < ALPI_CELL_FIRST;
    }
    const double scale = even ? weight_of(gatherer, packet, 0) : 1.0;
    for (int k = 0; k < 3; k++) {
        sum[k] += scale * (double)parts[k];
    }
    if (none) {
        sums->lost[0] += scale * (double)weigh_cells(weights, cells, ALPI_CELL_ESCAPED);
        sums->lost[1] += scale * (double)weigh_cells(weights, cells, ALPI_CELL_BLACK);
    }
}

void alpi_gather_find_skies(const alpi_gather_scene *from, const alpi_gather_packet *packets,
                            uint32_t count, const uint32_t (*cells)[ALPI_PACKET],
                            vec3 (*skies)[ALPI_PACKET])
{
    vec3 directions[ALPI_GATHER_BATCH * ALPI_PACKET], radiances[ALPI_GATHER_BATCH * ALPI_PACKET];
    uint32_t escaped = 0, next = 0;
    const alpi_sky *sky = sky_of(from);
    for (uint32_t k = 0; k < count && sky != NULL; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            directions[escaped] = direction_of(&packets[k].rays, i);
            escaped += cells[k][i] == ALPI_CELL_ESCAPED ? 1 : 0;
        }
    }
    memset(skies, 0, count * sizeof *skies);
    if (escaped == 0) {
        return;
    }
    alpi_sky_radiances(sky, directions, escaped, radiances);
    for (uint32_t k = 0; k < count; k++) {
        for (int i = 0; i < ALPI_PACKET; i++) {
            if (cells[k][i] == ALPI_CELL_ESCAPED) {
                skies[k][i] = radiances[next++];
            }
        }
    }
}

void alpi_gather_add_sky(const alpi_gatherer *gatherer, uint32_t packet,
                         const uint32_t cells[ALPI_PACKET], const vec3 skies[ALPI_PACKET],
                         alpi_gather_sums *sums)
{
    double *sum = sums->light[alpi_gather_replicate(gatherer, packet)];
    const double even = weight_of(gatherer, packet, 0);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if (cells[i] == ALPI_CELL_ESCAPED) {
            const double weight = gatherer->weights != NULL ? weight_of(gatherer, packet, i) : even;
            const double added[3] = {weight * (double)skies[i].x, weight * (double)skies[i].y,
                                     weight * (double)skies[i].z};
            for (int k = 0; k < 3; k++) {
                sum[k] += added[k];
                sums->sky[k] += added[k];
            }
        }
    }
}

void alpi_gather_add_directional(const alpi_gatherer *gatherer, uint32_t packet,
                                 const alpi_gather_packet *aimed, const alpi_gather_ways *ways,
                                 const vec3 radiance[ALPI_PACKET], alpi_gather_sums *sums)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        const double weight = ALPI_PI * weight_of(gatherer, packet, i);
        const alpi_directional_way way = {
            .direction = {aimed->rays.direction_x[i], aimed->rays.direction_y[i],
                          aimed->rays.direction_z[i]},
            .normal = ways->normals[i],
            .cosine = ways->cosines[i],
            .horizon =
                gatherer->weights == NULL && (double)ways->cosines[i] < sums->directional.width,
        };
        if ((aimed->active >> i & 1u) == 0 || !(way.cosine > 0.0f)) {
            continue;
        }
        if (way.horizon) {
            alpi_directional_count(&sums->directional, weight, (double)way.cosine);
        }
        const double irradiance[3] = {weight * (double)radiance[i].x,
                                      weight * (double)radiance[i].y,
                                      weight * (double)radiance[i].z};
        alpi_directional_add(&sums->directional, irradiance, &way);
    }
}

void alpi_gather_finish(const alpi_gatherer *gatherer, const alpi_gather_sums *sums,
                        alpi_reference_value *value)
{
    const uint32_t n = gatherer->replicates;
    for (int k = 0; k < 3; k++) {
        double mean = 0.0, squares = 0.0;
        for (uint32_t r = 0; r < n; r++) {
            mean += sums->light[r][k];
        }
        for (uint32_t r = 0; r < n; r++) {
            const double apart = sums->light[r][k] * n - mean;
            squares += apart * apart;
        }
        value->mean[k] = (float)(ALPI_PI * mean);
        value->variance[k] =
            n > 1 ? (float)(ALPI_PI * ALPI_PI * squares / ((double)n * (n - 1))) : 0.0f;
    }
}

// --- cells ---------------------------------------------------------------------------------------

bool alpi_gather_meets_cells(const alpi_gather_scene *from)
{
    return from->light.find != NULL && !from->emitters && !alpi_tracer_has_panes(from->tracer);
}

/// Lanes of a packet that met what is not black of itself, and the cells of the others.
static uint32_t list_surfaces(const alpi_gather_scene *from, uint32_t active, const alpi_hits *hits,
                              uint32_t cells[ALPI_PACKET])
{
    uint32_t met = 0, behind = active & hits->behind;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const bool escaped = hits->triangle[i] == ALPI_NONE && (active >> i & 1u) != 0;
        met |= hits->triangle[i] != ALPI_NONE ? 1u << i : 0u;
        cells[i] = escaped ? ALPI_CELL_ESCAPED : ALPI_CELL_BLACK;
    }
    for (; behind != 0; behind &= behind - 1) {
        const int i = __builtin_ctz(behind);
        if (!alpi_surface_is_double_sided(from->scene, hits->triangle[i])) {
            met &= ~(1u << i);
        }
    }
    return met & active;
}

/// Cells that the rays of a batch meet.
static void meet_cells(const alpi_gather_scene *from, const alpi_gather_packet *packets,
                       uint32_t count, bool coherent, alpi_hits *hits,
                       uint32_t (*cells)[ALPI_PACKET])
{
    const alpi_rays *rays[ALPI_GATHER_BATCH];
    uint32_t active[ALPI_GATHER_BATCH], met[ALPI_GATHER_BATCH];
    for (uint32_t k = 0; k < count; k++) {
        rays[k] = &packets[k].rays;
        active[k] = packets[k].active;
    }
    if (coherent) {
        alpi_trace_nearest_coherent_many(from->tracer, rays, active, count, from->filter, hits);
    }
    for (uint32_t k = 0; k < count; k++) {
        if (!coherent) {
            alpi_trace_nearest(from->tracer, rays[k], active[k], from->filter, &hits[k]);
        }
        met[k] = list_surfaces(from, active[k], &hits[k], cells[k]);
    }
    from->light.find(from->light.user, hits, met, count, cells);
}

void alpi_gather_cells(const alpi_gather_scene *from, const alpi_gather_packet *packets,
                       uint32_t count, bool coherent, uint32_t (*cells)[ALPI_PACKET])
{
    alpi_hits hits[ALPI_GATHER_BATCH];
    meet_cells(from, packets, count, coherent, hits, cells);
}

void alpi_gather_write(const alpi_gather_job *job, uint32_t receiver, const alpi_gather_sums *sums)
{
    alpi_gather_finish(job->gatherer, sums, &job->values[receiver]);
    for (int k = 0; k < 3 && job->skies != NULL; k++) {
        job->skies[receiver][k] = (float)(ALPI_PI * sums->sky[k]);
    }
    for (int k = 0; k < 2 && job->lost != NULL; k++) {
        job->lost[receiver][k] = (float)sums->lost[k];
    }
    if (job->directional != NULL) {
        alpi_directional_finish(&sums->directional, 1.0, &job->directional[receiver]);
    }
}

// --- receivers -----------------------------------------------------------------------------------

/// Light of cells, of rays that went on, and of the sky, by its direction.
/// @param skies, near radiance of the sky, and of what went on; NULL: there is none
static void add_cells_directional(const alpi_gather_job *job, uint32_t packet,
                                  const alpi_gather_packet *aimed, const alpi_gather_ways *ways,
                                  const uint32_t cells[ALPI_PACKET], const vec3 *skies,
                                  const vec3 *near, alpi_gather_sums *sums)
{
    vec3 radiance[ALPI_PACKET];
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float *l = job->from->light.cells[cells[i]];
        radiance[i] = (vec3){l[0], l[1], l[2]};
        if (skies != NULL) { // 0 but where the ray left; near: but where its cell was made black
            radiance[i] = vec3_add(radiance[i], skies[i]);
        }
        if (near != NULL) {
            radiance[i] = vec3_add(radiance[i], near[i]);
        }
    }
    alpi_gather_add_directional(job->gatherer, packet, aimed, ways, radiance, sums);
}

/// A batch of packets that meet cells.
static void gather_met_cells(const alpi_gather_job *job, uint32_t receiver, uint32_t first,
                             uint32_t count, const alpi_gather_packet *packets,
                             const alpi_gather_ways *ways, alpi_gather_sums *sums)
{
    const alpi_gatherer *g = job->gatherer;
    const bool goes_on = job->from->near != NULL, sky = job->from->sky;
    vec3 skies[ALPI_GATHER_BATCH][ALPI_PACKET];
    uint32_t met[ALPI_GATHER_BATCH][ALPI_PACKET];
    alpi_hits hits[ALPI_GATHER_BATCH];
    alpi_near_rays near;
    alpi_near_rays_start(job, receiver, first, &near);
    meet_cells(job->from, packets, count, g->coherent, hits, met);
    for (uint32_t k = 0; k < count && goes_on; k++) {
        alpi_near_rays_take(&near, k, &packets[k], &hits[k], met[k]);
    }
    alpi_near_rays_go_on(&near);
    if (sky) {
        alpi_gather_find_skies(job->from, packets, count, (const uint32_t(*)[ALPI_PACKET])met,
                               skies);
    }
    for (uint32_t k = 0; k < count; k++) {
        alpi_gather_add_cells(g, first + k, met[k], job->from->light.cells, sums);
        if (goes_on) {
            alpi_gather_add(g, first + k, near.radiance[k], sums);
        }
        if (sky) {
            alpi_gather_add_sky(g, first + k, met[k], skies[k], sums);
        }
        if (job->directional != NULL) {
            add_cells_directional(job, first + k, &packets[k], &ways[k], met[k],
                                  sky && !job->directional_without_sky ? skies[k] : NULL,
                                  goes_on ? near.radiance[k] : NULL, sums);
        }
    }
}

/// Traces a batch of packets in any scene, with panes and light outside cells.
static void trace_batch(const alpi_gather_job *job, uint32_t first, uint32_t count,
                        alpi_gather_packet *packets, const alpi_gather_ways *ways,
                        alpi_gather_sums *sums)
{
    const alpi_gatherer *g = job->gatherer;
    for (uint32_t k = 0; k < count; k++) {
        vec3 radiance[ALPI_PACKET];
        alpi_gather_trace(job->from, &packets[k].rays, packets[k].active, g->coherent, radiance,
                          NULL);
        alpi_gather_add(g, first + k, radiance, sums);
        if (job->directional != NULL) { // panes move where rays start, not where they go
            alpi_gather_add_directional(g, first + k, &packets[k], &ways[k], radiance, sums);
        }
    }
}

/// Packets [first, first + count) of one receiver.
static void gather_batch(const alpi_gather_job *job, uint32_t receiver, uint32_t first,
                         uint32_t count, bool cells, alpi_gather_sums *sums)
{
    const alpi_gatherer *g = job->gatherer;
    alpi_gather_packet packets[ALPI_GATHER_BATCH];
    alpi_gather_ways ways[ALPI_GATHER_BATCH];
    g->aim(g->user, job->receivers, receiver, first, count, packets,
           job->directional != NULL ? ways : NULL);
    if (cells) {
        gather_met_cells(job, receiver, first, count, packets, ways, sums);
    } else {
        trace_batch(job, first, count, packets, ways, sums);
    }
}

static alp_result gather_receivers(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_gather_job *job = user;
    const bool cells = alpi_gather_meets_cells(job->from);
    const uint32_t packets = job->gatherer->packet_count;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t receiver = job->list != NULL ? job->list[i] : i;
        alpi_gather_sums sums = {.lost = {0.0}};
        sums.directional.width = alpi_horizon_width(packets * ALPI_PACKET);
        for (uint32_t first = 0; first < packets; first += ALPI_GATHER_BATCH) {
            const uint32_t left = packets - first;
            gather_batch(job, receiver, first, left < ALPI_GATHER_BATCH ? left : ALPI_GATHER_BATCH,
                         cells, &sums);
            if (!alpi_loop_goes_on(job->context)) {
                return ALP_ERROR_CANCELLED;
            }
        }
        alpi_gather_write(job, receiver, &sums);
    }
    return ALP_OK;
}

void alpi_gather_outputs(const alpi_gather_job *job, alpi_tile_output outputs[ALPI_GATHER_OUTPUTS])
{
    const alpi_tile_output each = {.list = job->list, .count = job->count};
    void *const data[] = {job->values, job->skies, job->lost, job->directional};
    const size_t sizes[] = {sizeof *job->values, sizeof *job->skies, sizeof *job->lost,
                            sizeof *job->directional};
    for (int i = 0; i < ALPI_GATHER_OUTPUTS; i++) {
        outputs[i] = each;
        outputs[i].data = data[i];
        outputs[i].size = sizes[i];
    }
}

uint64_t alpi_gather_key(const alpi_gather_job *job)
{
    const alpi_gatherer *g = job->gatherer;
    const uint64_t parts[] = {
        g->seed,        g->packet_count,     g->replicates,          g->coherent,
        job->from->sky, job->from->emitters, job->from->near != NULL};
    return alpi_hash_bytes(ALPI_HASH_START, parts, sizeof parts);
}

alp_result alpi_gather_irradiance(const alpi_gather_job *job, const alpi_task_progress *progress)
{
    enum { RAYS_PER_RANGE = 1024 }; // about a tenth of a millisecond
    alpi_gather_job own = *job;
    const uint32_t rays = job->gatherer->packet_count * ALPI_PACKET;
    alpi_gather_check(job->gatherer);
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    told.units_per_item = (double)rays;
    told.units_are_rays = true;
    alpi_tile_output outputs[ALPI_GATHER_OUTPUTS];
    alpi_gather_outputs(job, outputs);
    return alpi_tile_loop_run(
        job->context, &(alpi_tile_loop){.name = "gather",
                                        .key = alpi_gather_key(job),
                                        .count = job->count,
                                        .grain = rays < RAYS_PER_RANGE ? RAYS_PER_RANGE / rays : 1,
                                        .body = gather_receivers,
                                        .user = &own,
                                        .progress = &told,
                                        .outputs = outputs,
                                        .output_count = ALPI_GATHER_OUTPUTS,
                                        .marks = job->marks,
                                        .mark_count = job->mark_count});
}
