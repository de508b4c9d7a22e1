// SPDX-License-Identifier: MIT
#include "transport/reference.h"

#include "base/random.h"
#include "base/warp.h"
#include "transport/hit.h"

#include <math.h>

// Uses of random numbers at one vertex of a path.
enum { USE_PLACE = 0, USE_PICK = 1, USE_LIGHT = 2, USE_RAY = 3, USE_ROULETTE = 4, USE_COUNT = 5 };
enum { STREAM_PATH = 5, CAMERA_DEPTH = -1 };
// Paths that bring less than this share of what they could at first play roulette. A larger one
// ends more paths and makes more noise.
static const float ROULETTE_SHARE = 0.1f;

/// One path. `throughput` multiplies the irradiance at its vertex.
typedef struct path {
    alpi_receiver_point at;
    float throughput[3], light[3];
    float first;       // throughput at the start, which roulette does not count
    float ray_density; // per steradian, of the ray that is traced next; < 0: light was not asked
    vec3 origin, direction;
    int depth; // bounces behind it; CAMERA_DEPTH: the ray comes from the eye
    bool alive;
    uint32_t sample; // of its replicate
    uint32_t key;    // of the replicate's random numbers
} path;

/// Eight paths side by side.
typedef struct path_packet {
    path paths[ALPI_PACKET];
    uint32_t covered; // bit i: the first ray of path i, if from the eye, met something
} path_packet;

static vec2 draw(const path *p, int use)
{
    const uint32_t vertex = (uint32_t)(p->depth + 1) * USE_COUNT + (uint32_t)use;
    return alpi_sample_2d(alpi_hash32(p->key ^ alpi_hash32(vertex + 1u)), p->sample);
}

// --- rays ----------------------------------------------------------------------------------------

static vec3 ray_start(const alpi_receiver_point *p)
{
    return vec3_mad(p->position, p->offset, p->geometric_normal);
}

// --- light that is asked for ---------------------------------------------------------------------

/// What a light sample gives through a path, before it is known whether anything is in between.
static bool weigh_sample(const path *p, const alpi_light_sample *s, float given[3])
{
    const float cosine = vec3_dot(s->direction, p->at.shading_normal);
    if (!(cosine > 0.0f)) {
        return false;
    }
    const bool hit_by_chance = s->kind != ALPI_LIGHT_CLASS_PUNCTUAL;
    const float other = hit_by_chance ? cosine * (float)(1.0 / ALPI_PI) : 0.0f;
    const float factor = cosine / (s->density + other); // balance heuristic × 1 / density
    given[0] = p->throughput[0] * s->light.x * factor;
    given[1] = p->throughput[1] * s->light.y * factor;
    given[2] = p->throughput[2] * s->light.z * factor;
    return isfinite(factor);
}

/// Asks one light from each vertex.
static void add_next_event(const alpi_reference *r, path_packet *packet)
{
    alpi_rays rays;
    float given[ALPI_PACKET][3];
    uint32_t active = 0;
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        path *p = &packet->paths[i];
        alpi_light_sample s;
        const vec3 origin = p->alive ? ray_start(&p->at) : (vec3){0.0f, 0.0f, 0.0f};
        if (!p->alive ||
            !alpi_lighting_sample(r->lighting, origin, p->at.shading_normal, draw(p, USE_PICK).x,
                                  draw(p, USE_LIGHT), &s) ||
            !weigh_sample(p, &s, given[i])) {
            continue;
        }
        // Short of the emitter, which would stop the ray itself.
        const float reach = s.distance * (1.0f - 1e-5f) - 2.0f * p->at.offset;
        if (reach > 0.0f) {
            alpi_rays_set(&rays, i, origin, s.direction, reach);
            active |= 1u << i;
        } else { // nothing fits in between
            for (int k = 0; k < 3; k++) {
                p->light[k] += given[i][k];
            }
        }
    }
    if (active != 0) {
        alpi_trace_occluded(r->tracer, &rays, 1, active, r->filter, false);
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        for (int k = 0; k < 3 && (active >> i & 1u) != 0 && rays.maximum[i] >= 0.0f; k++) {
            packet->paths[i].light[k] += given[i][k];
        }
    }
}

// --- light that is met ---------------------------------------------------------------------------

/// Sends each path on in a cosine-distributed direction.
static void aim(const alpi_reference *r, path_packet *packet)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        path *p = &packet->paths[i];
        if (!p->alive) {
            continue;
        }
        vec3 t, b;
        vec3_frame(p->at.shading_normal, &t, &b);
        const vec3 local = alpi_warp_cosine_cone(draw(p, USE_RAY), 1.0f);
        const vec3 d =
            vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, p->at.shading_normal);
        p->origin = ray_start(&p->at);
        p->direction = vec3_normalize_or(d, p->at.shading_normal);
        p->ray_density = r->next_event ? local.z * (float)(1.0 / ALPI_PI) : -1.0f;
        p->alive = local.z > 0.0f;
    }
}

/// Adds radiance that a ray met, π times for its density cosθ / π, with its share of what the light
/// sampler would have found too.
static void add_met(const alpi_reference *r, path *p, vec3 radiance, uint32_t triangle)
{
    if (radiance.x <= 0.0f && radiance.y <= 0.0f && radiance.z <= 0.0f) {
        return;
    }
    float weight = (float)ALPI_PI;
    if (p->ray_density >= 0.0f) {
        const float asked = alpi_lighting_density(r->lighting, p->origin, p->at.shading_normal,
                                                  p->direction, triangle);
        weight *= p->ray_density / (p->ray_density + asked);
    }
    p->light[0] += p->throughput[0] * weight * radiance.x;
    p->light[1] += p->throughput[1] * weight * radiance.y;
    p->light[2] += p->throughput[2] * weight * radiance.z;
}

/// Ends a weak path by chance; those that go on make up for it.
static void play_roulette(path *p)
{
    const float most = fmaxf(p->throughput[0], fmaxf(p->throughput[1], p->throughput[2]));
    const float survival = most / (ROULETTE_SHARE * p->first);
    if (survival >= 1.0f) {
        return;
    }
    p->alive = draw(p, USE_ROULETTE).x < survival;
    for (int k = 0; k < 3 && p->alive; k++) {
        p->throughput[k] /= survival;
    }
}

static void arrive(const alpi_reference *r, path *p, const alpi_hits *hits, int lane)
{
    const uint32_t triangle = hits->triangle[lane];
    const float b1 = hits->b1[lane], b2 = hits->b2[lane];
    bool behind = false;
    const alpi_receiver_point at = alpi_hit_point(r->scene, hits, lane, p->direction, &behind);
    const vec3 back = vec3_scale(p->direction, -1.0f);
    add_met(r, p, alpi_surface_emission(r->scene, triangle, b1, b2, back), triangle);
    if (p->depth >= (int)r->bounces ||
        (behind && !alpi_surface_is_double_sided(r->scene, triangle))) {
        p->alive = false; // a single-sided surface is black from behind
        return;
    }
    const vec3 albedo = alpi_surface_albedo(r->scene, triangle, b1, b2);
    p->throughput[0] *= albedo.x;
    p->throughput[1] *= albedo.y;
    p->throughput[2] *= albedo.z;
    p->at = at;
    p->depth++;
    play_roulette(p);
}

static void trace_packet(const alpi_reference *r, path_packet *packet)
{
    alpi_rays rays;
    alpi_hits hits;
    uint32_t active = 0;
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const path *p = &packet->paths[i];
        if (p->alive) {
            alpi_rays_set(&rays, i, p->origin, p->direction, INFINITY);
            active |= 1u << i;
        }
    }
    alpi_trace_nearest(r->tracer, &rays, active, r->filter, &hits);
    for (int i = 0; i < ALPI_PACKET; i++) {
        path *p = &packet->paths[i];
        if (!p->alive) {
            continue;
        }
        if (hits.triangle[i] == ALPI_NONE) {
            const vec3 sky = alpi_lighting_escaped(r->lighting, p->direction);
            const bool shows = sky.x > 0.0f || sky.y > 0.0f || sky.z > 0.0f; // a sun's disk too
            packet->covered |= p->depth == CAMERA_DEPTH && shows ? 1u << i : 0u;
            add_met(r, p, sky, ALPI_NONE);
            p->alive = false;
        } else {
            packet->covered |= p->depth == CAMERA_DEPTH ? 1u << i : 0u;
            arrive(r, p, &hits, i);
        }
    }
}

static bool any_alive(const path_packet *packet)
{
    bool alive = false;
    for (int i = 0; i < ALPI_PACKET; i++) {
        alive = alive || packet->paths[i].alive;
    }
    return alive;
}

/// From vertices to the ends of all paths.
static void run_paths(const alpi_reference *r, path_packet *packet)
{
    while (any_alive(packet)) {
        if (r->next_event) {
            add_next_event(r, packet);
        }
        aim(r, packet);
        trace_packet(r, packet);
    }
}

// --- means ---------------------------------------------------------------------------------------

typedef struct replicate_sums {
    double light[ALPI_REFERENCE_REPLICATES][3];
    double covered;
} replicate_sums;

/// How many paths each replicate has.
static uint32_t samples_each(const alpi_reference *r)
{
    const uint32_t n = r->samples / ALPI_REFERENCE_REPLICATES;
    return n + (n * ALPI_REFERENCE_REPLICATES < r->samples || n == 0 ? 1 : 0);
}

uint32_t alpi_reference_samples(const alpi_reference *reference)
{
    return samples_each(reference) * ALPI_REFERENCE_REPLICATES;
}

/// A fresh path of sample `index` of all: the replicates take turns.
static path start_path(const alpi_reference *r, uint64_t receiver, uint32_t index, float first,
                       int depth)
{
    const uint32_t replicate = index % ALPI_REFERENCE_REPLICATES;
    const uint32_t key = alpi_random_key(r->seed, receiver, STREAM_PATH);
    path p = {.first = first,
              .depth = depth,
              .ray_density = -1.0f,
              .sample = index / ALPI_REFERENCE_REPLICATES,
              .key = alpi_hash32(key ^ alpi_hash32(replicate + 1u)),
              .throughput = {first, first, first},
              .alive = true};
    return p;
}

static void add_paths(const path_packet *packet, uint32_t first, replicate_sums *sums)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        double *sum = sums->light[(first + i) % ALPI_REFERENCE_REPLICATES];
        for (int k = 0; k < 3; k++) {
            sum[k] += (double)packet->paths[i].light[k];
        }
        sums->covered += (double)(packet->covered >> i & 1u);
    }
}

/// Mean of the replicates' means, and its variance by their spread.
static void finish(const replicate_sums *sums, uint32_t each, alpi_reference_value *value)
{
    enum { R = ALPI_REFERENCE_REPLICATES };
    for (int k = 0; k < 3; k++) {
        double mean = 0.0, squares = 0.0;
        for (int r = 0; r < R; r++) {
            mean += sums->light[r][k] / ((double)each * R);
        }
        for (int r = 0; r < R; r++) {
            const double apart = sums->light[r][k] / each - mean;
            squares += apart * apart;
        }
        value->mean[k] = (float)mean;
        value->variance[k] = (float)(squares / (R * (R - 1)));
    }
}

// --- receivers -----------------------------------------------------------------------------------

typedef struct irradiance_job {
    const alpi_reference *reference;
    const alpi_receivers *receivers;
    const uint32_t *list;
    alpi_reference_value *values;
} irradiance_job;

static void gather_receiver(const irradiance_job *job, uint32_t receiver)
{
    const alpi_reference *r = job->reference;
    const uint32_t each = samples_each(r);
    replicate_sums sums = {{{0}}, 0.0};
    for (uint32_t first = 0; first < each * ALPI_REFERENCE_REPLICATES; first += ALPI_PACKET) {
        path_packet packet = {.covered = 0};
        alpi_receiver_point points[ALPI_PACKET];
        float square[ALPI_PACKET][2];
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            packet.paths[i] = start_path(r, receiver, first + i, 1.0f, 0);
            const vec2 u = draw(&packet.paths[i], USE_PLACE);
            square[i][0] = u.x;
            square[i][1] = u.y;
        }
        job->receivers->place(job->receivers->user, receiver, ALPI_PACKET,
                              (const float(*)[2])square, points);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            packet.paths[i].at = points[i];
        }
        run_paths(r, &packet);
        add_paths(&packet, first, &sums);
    }
    finish(&sums, each, &job->values[receiver]);
}

static alp_result gather_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const irradiance_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        gather_receiver(job, job->list != NULL ? job->list[i] : i);
    }
    return ALP_OK;
}

alp_result alpi_reference_irradiance(const alpi_reference *reference,
                                     const alpi_receivers *receivers, const uint32_t *list,
                                     uint32_t list_count, const alpi_task_progress *progress,
                                     alpi_reference_value *values)
{
    irradiance_job job = {
        .reference = reference, .receivers = receivers, .list = list, .values = values};
    const uint32_t count = list != NULL ? list_count : receivers->count;
    alpi_task_progress told = progress != NULL ? *progress : (alpi_task_progress){0};
    const uint32_t samples = alpi_reference_samples(reference);
    const uint32_t grain = samples < 512 ? 512 / samples : 1; // a few milliseconds
    told.units_per_item = (double)samples;
    return alpi_parallel_for(reference->context, count, grain, gather_range, &job, &told);
}

// --- pictures ------------------------------------------------------------------------------------

void alpi_reference_pixel(const alpi_reference *reference, alpi_camera_ray_fn *camera,
                          const void *camera_user, uint64_t pixel, alpi_reference_value *value,
                          float *covered)
{
    const float through = (float)(1.0 / ALPI_PI); // L = Le + ρ/π · E, and add_met counts π
    const uint32_t each = samples_each(reference);
    const uint32_t all = each * ALPI_REFERENCE_REPLICATES;
    replicate_sums sums = {{{0}}, 0.0};
    for (uint32_t first = 0; first < all; first += ALPI_PACKET) {
        path_packet packet = {.covered = 0};
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            path *p = &packet.paths[i];
            *p = start_path(reference, pixel, first + i, through, CAMERA_DEPTH);
            camera(camera_user, pixel, draw(p, USE_PLACE), &p->origin, &p->direction);
        }
        trace_packet(reference, &packet);
        run_paths(reference, &packet);
        add_paths(&packet, first, &sums);
    }
    finish(&sums, each, value);
    *covered = (float)(sums.covered / all);
}
