// SPDX-License-Identifier: MIT
#include "maps/denoise.h"

#include "base/memory.h"
#include "maps/neighbours.h"

#include <string.h>

enum {
    ESTIMATES = 5, // a texel's own mean, then fits, the smallest radius first
    PAIRS = ESTIMATES * (ESTIMATES - 1) / 2,
    NEIGHBOUR_LIMIT = 384, // 201 lie within the largest radius on one plane
    SITES_PER_RANGE = 64,
    CHANNELS = 3
};

// In sides of a texel.
static const float RADIUS[ESTIMATES] = {0.0f, 1.6f, 2.7f, 4.6f, 8.0f};
// Within which the excess of each over smaller ones is averaged.
static const float CHOICE_RADIUS[ESTIMATES] = {3.0f, 3.0f, 3.0f, 3.0f, 4.6f};
static const float LIFT = 0.25f;
// Added to the spread of the neighbours, in squares of the radius, so that those on one line give
// no gradient across it: takes off .15 % of a gradient at a straight border.
static const double RIDGE = 1e-4;
static const float LEAST_COSINE = 0.7f; // between normals
static const float ALBEDO_RANGE = 0.1f;

/// A texel's light, in the order of sites: so that outputs may be inputs.
typedef struct light {
    float mean[CHANNELS], variance[CHANNELS];
    bool known; // else the rest means nothing
} light;

/// What is found of a texel in the first pass.
typedef struct estimates {
    float means[ESTIMATES][CHANNELS], variances[ESTIMATES][CHANNELS];
    float excess[PAIRS];   // squared difference of two beyond their noise, over all channels:
                           // (bias − bias)²
    bool known[ESTIMATES]; // whether there is such an estimate
} estimates;

typedef struct denoise_job {
    const alpi_tracer *tracer;
    const alpi_denoise_texels *texels;
    const alpi_neighbours *neighbours;
    light *lights;        // [sites]
    float *lifts;         // [sites] metres
    estimates *estimates; // [sites]
    float (*means)[CHANNELS], (*variances)[CHANNELS];
} denoise_job;

/// Index in `excess` of estimates a < b.
static int pair(int a, int b)
{
    return b * (b - 1) / 2 + a;
}

// --- what there is -------------------------------------------------------------------------------

static light load_light(const alpi_denoise_texels *t, uint32_t texel)
{
    light l = {.known = true};
    for (int n = 0; n < CHANNELS; n++) {
        l.mean[n] = t->means[texel][n];
        l.variance[n] = t->variances[texel][n];
        l.known =
            l.known && isfinite(l.mean[n]) && isfinite(l.variance[n]) && l.variance[n] >= 0.0f;
    }
    return l;
}

/// Also, how high sight lines may begin: half way to what is above the texel at most.
static alp_result load_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const denoise_job *job = user;
    for (uint32_t i = begin; i < end; i += ALPI_PACKET) {
        const uint32_t count = end - i < ALPI_PACKET ? end - i : ALPI_PACKET;
        alpi_rays rays;
        alpi_hits hits = {.distance = {0.0f}};
        alpi_rays_clear(&rays);
        for (uint32_t k = 0; k < count; k++) {
            const alpi_site *s = &job->neighbours->sites[i + k];
            const float start = 1e-3f * s->side; // off the texel's own triangle
            alpi_rays_set(&rays, (int)k, vec3_mad(s->position, start, s->normal), s->normal,
                          2.0f * LIFT * s->side);
        }
        if (job->tracer != NULL) {
            alpi_trace_nearest(job->tracer, &rays, (1u << count) - 1, (alpi_trace_filter){0},
                               &hits);
        }
        for (uint32_t k = 0; k < count; k++) {
            job->lights[i + k] = load_light(job->texels, job->neighbours->sites[i + k].texel);
            const float most = LIFT * job->neighbours->sites[i + k].side;
            const bool low = job->tracer != NULL && 0.5f * hits.distance[k] < most;
            job->lifts[i + k] = low ? 0.5f * hits.distance[k] : most;
        }
    }
    return ALP_OK;
}

// --- neighbours ----------------------------------------------------------------------------------

/// Neighbours of one site.
typedef struct circle {
    uint32_t count;
    uint32_t sites[NEIGHBOUR_LIMIT + 1];
    float weights[NEIGHBOUR_LIMIT];               // for all radii
    float distances[NEIGHBOUR_LIMIT];             // squared, in sides
    float u[NEIGHBOUR_LIMIT], v[NEIGHBOUR_LIMIT]; // in the tangent plane, in sides
} circle;

/// How much a neighbour is like the centre, but for its distance; 0 = not at all.
static float find_likeness(const denoise_job *job, const alpi_site *centre, const alpi_site *site)
{
    const float cosine = vec3_dot(centre->normal, site->normal);
    const vec3 away = vec3_sub(site->position, centre->position);
    const float height =
        fmaxf(fabsf(vec3_dot(away, centre->normal)), fabsf(vec3_dot(away, site->normal))) /
        centre->side;
    if (!(cosine > LEAST_COSINE) || !(height < 1.0f)) {
        return 0.0f;
    }
    const float turn = fminf((cosine - LEAST_COSINE) / (1.0f - LEAST_COSINE), 1.0f);
    float likeness = turn * (1.0f - height * height);
    if (job->texels->albedos != NULL) {
        const vec3 d = vec3_sub(vec3_load(job->texels->albedos[site->texel]),
                                vec3_load(job->texels->albedos[centre->texel]));
        likeness *= expf(-vec3_dot(d, d) / (2.0f * ALBEDO_RANGE * ALBEDO_RANGE));
    }
    return likeness;
}

/// All that are like the centre within `radius` sides; within less where those are too many. The
/// centre itself counts as a neighbour.
static void find_circle(const denoise_job *job, const alpi_site *centre, float radius, circle *c)
{
    uint32_t found = 0;
    do {
        found = alpi_neighbours_around(job->neighbours, centre, radius * centre->side,
                                       NEIGHBOUR_LIMIT, c->sites);
        radius *= 0.7f;
    } while (found > NEIGHBOUR_LIMIT && radius > 1.0f);
    found = found > NEIGHBOUR_LIMIT ? NEIGHBOUR_LIMIT : found;
    vec3 t, b;
    vec3_frame(centre->normal, &t, &b);
    c->count = 0;
    for (uint32_t i = 0; i < found; i++) {
        const alpi_site *site = &job->neighbours->sites[c->sites[i]];
        const vec3 away =
            vec3_scale(vec3_sub(site->position, centre->position), 1.0f / centre->side);
        const float likeness = find_likeness(job, centre, site);
        if (likeness > 0.0f && job->lights[c->sites[i]].known) {
            c->sites[c->count] = c->sites[i];
            c->weights[c->count] = likeness;
            c->distances[c->count] = vec3_dot(away, away);
            c->u[c->count] = vec3_dot(away, t);
            c->v[c->count] = vec3_dot(away, b);
            c->count++;
        }
    }
}

/// Takes the weight from those that are out of sight.
static void look(const denoise_job *job, uint32_t centre, circle *c)
{
    alpi_rays packets[(NEIGHBOUR_LIMIT + ALPI_PACKET - 1) / ALPI_PACKET];
    const alpi_site *sites = job->neighbours->sites;
    const uint32_t packet_count = (c->count + ALPI_PACKET - 1) / ALPI_PACKET;
    const vec3 start = vec3_mad(sites[centre].position, job->lifts[centre], sites[centre].normal);
    for (uint32_t k = 0; k < packet_count; k++) {
        alpi_rays_clear(&packets[k]);
    }
    for (uint32_t i = 0; i < c->count; i++) {
        const alpi_site *site = &sites[c->sites[i]];
        const vec3 end = vec3_mad(site->position, job->lifts[c->sites[i]], site->normal);
        const vec3 way = vec3_sub(end, start);
        alpi_rays_set(&packets[i / ALPI_PACKET], (int)(i % ALPI_PACKET), start,
                      vec3_normalize_or(way, sites[centre].normal), vec3_length(way));
    }
    if (packet_count > 0) {
        alpi_trace_occluded(job->tracer, packets, packet_count, UINT32_MAX >> (32 - ALPI_PACKET),
                            (alpi_trace_filter){0}, ALPI_RAYS_NEAR);
    }
    for (uint32_t i = 0; i < c->count; i++) {
        if (packets[i / ALPI_PACKET].maximum[i % ALPI_PACKET] < 0.0f && c->sites[i] != centre) {
            c->weights[i] = 0.0f;
        }
    }
}

// --- fits ----------------------------------------------------------------------------------------

/// Estimate k is Σ weights · means of the circle.
typedef struct kernels {
    double weights[ESTIMATES][NEIGHBOUR_LIMIT];
} kernels;

/// The value at the centre of the plane that fits best, as weights of the neighbours' values: of
/// least squares weighted by 1 − distance², with the moments about the neighbours' own middle.
/// (V. A. Epanechnikov 1969: this kernel has the least error.)
static bool find_kernel(const circle *c, float radius, double *weights)
{
    const double scale = 1.0 / (double)radius;
    double sum = 0.0, mu = 0.0, mv = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
    for (uint32_t i = 0; i < c->count; i++) {
        const double fall = 1.0 - (double)c->distances[i] * scale * scale;
        const double w = fall > 0.0 ? fall * (double)c->weights[i] : 0.0;
        const double u = (double)c->u[i] * scale, v = (double)c->v[i] * scale;
        weights[i] = w;
        sum += w;
        mu += w * u;
        mv += w * v;
        uu += w * u * u;
        uv += w * u * v;
        vv += w * v * v;
    }
    if (!(sum > 0.0)) {
        return false;
    }
    mu /= sum;
    mv /= sum;
    uu = fmax(uu / sum - mu * mu, 0.0) + RIDGE;
    vv = fmax(vv / sum - mv * mv, 0.0) + RIDGE;
    uv = uv / sum - mu * mv;
    const double determinant = uu * vv - uv * uv; // RIDGE² at least, but for rounding
    const double gu = (uv * mv - vv * mu) / determinant;
    const double gv = (uv * mu - uu * mv) / determinant;
    for (uint32_t i = 0; i < c->count; i++) {
        const double u = (double)c->u[i] * scale - mu, v = (double)c->v[i] * scale - mv;
        weights[i] *= (1.0 + gu * u + gv * v) / sum;
    }
    return true;
}

/// The texel's own mean.
static bool find_own(const circle *c, uint32_t centre, double *weights)
{
    bool any = false;
    for (uint32_t i = 0; i < c->count; i++) {
        weights[i] = c->sites[i] == centre ? 1.0 : 0.0;
        any = any || c->sites[i] == centre;
    }
    return any;
}

static void sum_up(const denoise_job *job, const circle *c, const double *weights, float *mean,
                   float *variance)
{
    double means[CHANNELS] = {0.0}, variances[CHANNELS] = {0.0};
    for (uint32_t i = 0; i < c->count; i++) {
        const light *l = &job->lights[c->sites[i]];
        for (int n = 0; n < CHANNELS; n++) {
            means[n] += weights[i] * (double)l->mean[n];
            variances[n] += weights[i] * weights[i] * (double)l->variance[n];
        }
    }
    for (int n = 0; n < CHANNELS; n++) {
        mean[n] = (float)means[n];
        variance[n] = (float)variances[n];
    }
}

static double sum_channels(const float values[CHANNELS])
{
    return (double)values[0] + (double)values[1] + (double)values[2];
}

static double square_distance(const float a[CHANNELS], const float b[CHANNELS])
{
    double sum = 0.0;
    for (int n = 0; n < CHANNELS; n++) {
        sum += ((double)a[n] - (double)b[n]) * ((double)a[n] - (double)b[n]);
    }
    return sum;
}

/// Squared differences of estimates, less what their noise gives in the mean.
static void find_excess(const denoise_job *job, const circle *c, const kernels *k, estimates *e)
{
    double noise[PAIRS] = {0.0};
    for (uint32_t i = 0; i < c->count; i++) {
        const double variance = sum_channels(job->lights[c->sites[i]].variance);
        for (int b = 1; b < ESTIMATES; b++) {
            for (int a = 0; a < b; a++) {
                const double d = k->weights[b][i] - k->weights[a][i];
                noise[pair(a, b)] += d * d * variance;
            }
        }
    }
    for (int b = 1; b < ESTIMATES; b++) {
        for (int a = 0; a < b; a++) {
            if (e->known[a] && e->known[b]) {
                e->excess[pair(a, b)] =
                    (float)(square_distance(e->means[b], e->means[a]) - noise[pair(a, b)]);
            }
        }
    }
}

static alp_result estimate_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const denoise_job *job = user;
    circle c;
    kernels k;
    for (uint32_t i = begin; i < end; i++) {
        estimates *e = &job->estimates[i];
        find_circle(job, &job->neighbours->sites[i], RADIUS[ESTIMATES - 1], &c);
        if (job->tracer != NULL) {
            look(job, i, &c);
        }
        for (int r = 0; r < ESTIMATES; r++) {
            e->known[r] =
                r == 0 ? find_own(&c, i, k.weights[r]) : find_kernel(&c, RADIUS[r], k.weights[r]);
            if (e->known[r]) {
                sum_up(job, &c, k.weights[r], e->means[r], e->variances[r]);
            }
        }
        find_excess(job, &c, &k, e);
    }
    return ALP_OK;
}

// --- choice --------------------------------------------------------------------------------------

/// What the estimates of one texel are worth.
typedef struct verdict {
    double errors[ESTIMATES]; // squared, over all channels: bias² + variance
    double bias[ESTIMATES];   // squared, over all channels
} verdict;

/// The excesses of a texel, alone too uncertain, with those of its neighbours; and the variance of
/// its own mean likewise.
static void smooth_excess(const denoise_job *job, const circle *c, double smooth[PAIRS],
                          double *variance)
{
    double weights[ESTIMATES] = {0.0};
    memset(smooth, 0, PAIRS * sizeof *smooth);
    *variance = 0.0;
    for (uint32_t i = 0; i < c->count; i++) {
        const estimates *e = &job->estimates[c->sites[i]];
        for (int b = 0; b < ESTIMATES; b++) {
            const float r = CHOICE_RADIUS[b];
            const double w =
                (double)(c->weights[i] * fmaxf(1.0f - c->distances[i] / (r * r), 0.0f));
            weights[b] += w;
            for (int a = 0; a < b; a++) {
                smooth[pair(a, b)] += w * (double)e->excess[pair(a, b)];
            }
            *variance += b == 0 ? w * sum_channels(job->lights[c->sites[i]].variance) : 0.0;
        }
    }
    *variance /= fmax(weights[0], 1e-30);
    for (int b = 1; b < ESTIMATES; b++) {
        for (int a = 0; a < b; a++) {
            smooth[pair(a, b)] /= fmax(weights[b], 1e-30);
        }
    }
}

/// An estimate's bias is the largest excess over smaller ones, which have less. A texel's own mean
/// has none.
static void judge(const denoise_job *job, uint32_t site, const circle *c, verdict *out)
{
    const estimates *e = &job->estimates[site];
    double smooth[PAIRS];
    *out = (verdict){.bias = {0.0}};
    smooth_excess(job, c, smooth, &out->errors[0]);
    for (int b = 1; b < ESTIMATES; b++) {
        for (int a = 0; a < b; a++) {
            out->bias[b] = fmax(out->bias[b], smooth[pair(a, b)]);
        }
        out->errors[b] = out->bias[b] + sum_channels(e->variances[b]);
    }
}

/// Blends the estimates by 1/error⁴.
static void blend(const denoise_job *job, uint32_t site, const verdict *found)
{
    const estimates *e = &job->estimates[site];
    const uint32_t texel = job->neighbours->sites[site].texel;
    double weights[ESTIMATES], sum = 0.0, bias = 0.0, least = HUGE_VAL;
    for (int k = 0; k < ESTIMATES; k++) {
        least = e->known[k] ? fmin(least, found->errors[k]) : least;
    }
    const double floor = 1e-9 * found->errors[0] + 1e-300; // no error is 0 for sure
    for (int k = 0; k < ESTIMATES; k++) {
        const double sureness = e->known[k] ? (least + floor) / (found->errors[k] + floor) : 0.0;
        weights[k] = sureness * sureness;
        sum += weights[k];
    }
    for (int k = 0; k < ESTIMATES; k++) {
        weights[k] /= sum;
        bias += weights[k] * sqrt(found->bias[k]);
    }
    for (int n = 0; n < CHANNELS; n++) {
        double mean = 0.0, error = 0.0;
        for (int k = 0; k < ESTIMATES; k++) {
            mean += weights[k] * (double)e->means[k][n];
            error += weights[k] * sqrt((double)e->variances[k][n]);
        }
        job->means[texel][n] = (float)mean;
        job->variances[texel][n] = (float)(error * error + bias * bias / CHANNELS);
    }
}

static alp_result choose_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const denoise_job *job = user;
    circle c;
    for (uint32_t i = begin; i < end; i++) {
        const estimates *e = &job->estimates[i];
        verdict found;
        find_circle(job, &job->neighbours->sites[i], CHOICE_RADIUS[ESTIMATES - 1], &c);
        judge(job, i, &c, &found);
        bool fitted = false;
        for (int k = 1; k < ESTIMATES; k++) {
            fitted = fitted || e->known[k];
        }
        if (fitted && (!e->known[0] || found.errors[0] > 0.0)) {
            blend(job, i, &found);
        }
    }
    return ALP_OK;
}

// --- all -----------------------------------------------------------------------------------------

static alp_result denoise(alp_context *context, denoise_job *job,
                          const alpi_task_progress *progress)
{
    const uint32_t placed = alpi_neighbours_placed(job->neighbours);
    const size_t size = job->texels->count * sizeof *job->means;
    if (size > 0) { // what cannot be bettered stays
        memmove(job->means, job->texels->means, size);
        memmove(job->variances, job->texels->variances, size);
    }
    ALPI_TRY_NEW(context, job->lights, placed);
    ALPI_TRY_NEW(context, job->lifts, placed);
    ALPI_TRY_NEW(context, job->estimates, placed);
    ALP_TRY(alpi_parallel_for(context, placed, SITES_PER_RANGE, load_range, job, progress));
    ALP_TRY(alpi_parallel_for(context, placed, SITES_PER_RANGE, estimate_range, job, progress));
    return alpi_parallel_for(context, placed, SITES_PER_RANGE, choose_range, job, progress);
}

alp_result alpi_denoise(alp_context *context, const alpi_tracer *tracer,
                        const alpi_denoise_texels *texels, const alpi_task_progress *progress,
                        float (*means)[3], float (*variances)[3])
{
    alpi_neighbours neighbours;
    ALP_TRY(alpi_neighbours_create(context, texels->count, texels->positions, texels->normals,
                                   texels->sides, &neighbours));
    denoise_job job = {.tracer = tracer,
                       .texels = texels,
                       .neighbours = &neighbours,
                       .means = means,
                       .variances = variances};
    const alp_result result = denoise(context, &job, progress);
    alpi_release(context, job.lights);
    alpi_release(context, job.lifts);
    alpi_release(context, job.estimates);
    alpi_neighbours_destroy(&neighbours);
    return result;
}
