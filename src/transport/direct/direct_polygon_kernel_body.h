// SPDX-License-Identifier: MIT
// The loops over light of polygons, included once for each instruction set. Every inner loop runs
// over the eight lanes and becomes a few vector instructions (gcc -fopt-info-vec shows it). No
// fused operations in either: the same bits.
#include "transport/direct/direct_polygon_kernel.h"

#include "base/random.h"
#include "scene/double3.h"
#include "transport/lane_loop.h"

static inline uint32_t half_of(uint32_t sample)
{
    return sample % ALPI_DIRECT_REPLICATES / ALPI_POLYGON_HALF;
}

/// Where a sample is in the sequence of its half. What comes first, which is all for some, is its
/// beginning: of that each replicate has a run, and of the rest another. Samples beyond take turns.
static inline uint32_t place_in_half(const alpi_polygon_wave *w, uint32_t sample)
{
    const uint32_t replicate = sample % ALPI_POLYGON_HALF, own = sample / ALPI_DIRECT_REPLICATES;
    const uint32_t first = w->first_each, later = w->each - first;
    return own < first     ? replicate * first + own
           : own < w->each ? ALPI_POLYGON_HALF * first + replicate * later + own - first
                           : own * ALPI_POLYGON_HALF + replicate;
}

static void draw(alpi_polygon_wave *w, const uint32_t (*keys)[ALPI_PACKET], uint32_t use,
                 uint32_t first)
{
    const uint32_t of_use = alpi_hash32(use + 1u);
    for (uint32_t s = 0; s < w->count; s++) {
        const uint32_t *key = keys[half_of(first + s)];
        const uint32_t sample = place_in_half(w, first + s);
        ALPI_EACH_LANE
        {
            const vec2 u = alpi_sample_2d(alpi_hash32(key[i] ^ of_use), sample);
            w->u[s][i] = u.x;
            w->v[s][i] = u.y;
        }
    }
}

// --- form factors --------------------------------------------------------------------------------

/// γ / sin γ of an angle up to a right one, over x = (1 − cos γ) / 2: to 1e-9 (interpolated at the
/// Chebyshev points of [0, ½]), and 1 at 0, so that what small polygons leave of a sum of such
/// terms is as exact.
static inline double angle_over_sine(double x)
{
    const double low = 0.6666666682972414 +
                       x * (0.5333325457190476 + x * (0.457205227929286 + x * 0.404439952070041));
    const double middle =
        0.3990712758534087 +
        x * (0.07564079306575991 + x * (1.772037571211828 + x * -4.68324928552553));
    const double high = 10.7925268200366 + x * (-12.3978418283396 + x * 7.222992554337668);
    const double x2 = x * x, x4 = x2 * x2;
    return 1.0 + x * (low + x4 * (middle + x4 * high));
}

/// A vector of each lane.
typedef struct lanes3 {
    _Alignas(32) double x[ALPI_PACKET];
    double y[ALPI_PACKET], z[ALPI_PACKET];
} lanes3;

/// A polygon as the points of a sample see it.
typedef struct lanes_view {
    lanes3 normal, corner[5];                         // from the point; the last is the first
    _Alignas(32) double height[5][ALPI_PACKET];       // of the corners above the horizon
    double square[5][ALPI_PACKET];                    // of their distances
    double sum[ALPI_PACKET];                          // of γ (n·Γ) over the edges
    double lowest[ALPI_PACKET], highest[ALPI_PACKET]; // of the heights
    double middle[ALPI_PACKET];                       // square of the distance of the middle
} lanes_view;

static inline void view_corners(const alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s,
                                lanes_view *v)
{
    ALPI_EACH_LANE
    {
        v->normal.x[i] = (double)w->normal[0][s][i];
        v->normal.y[i] = (double)w->normal[1][s][i];
        v->normal.z[i] = (double)w->normal[2][s][i];
        v->sum[i] = 0.0;
    }
    for (int k = 0; k < 5; k++) {
        const double3 c = double3_from(p->corner[k % 4]);
        ALPI_EACH_LANE
        {
            const double x = c.x - (double)w->position[0][s][i];
            const double y = c.y - (double)w->position[1][s][i];
            const double z = c.z - (double)w->position[2][s][i];
            v->corner[k].x[i] = x;
            v->corner[k].y[i] = y;
            v->corner[k].z[i] = z;
            v->square[k][i] = x * x + y * y + z * z;
            v->height[k][i] = x * v->normal.x[i] + y * v->normal.y[i] + z * v->normal.z[i];
        }
    }
    const double3 m = double3_from(p->middle);
    ALPI_EACH_LANE
    {
        const double x = m.x - (double)w->position[0][s][i];
        const double y = m.y - (double)w->position[1][s][i];
        const double z = m.z - (double)w->position[2][s][i];
        v->middle[i] = x * x + y * y + z * z;
        const double a = v->height[0][i], b = v->height[1][i];
        const double c = v->height[2][i], d = v->height[3][i];
        const double low = a < b ? a : b, lower = c < d ? c : d;
        const double high = a < b ? b : a, higher = c < d ? d : c;
        v->lowest[i] = low < lower ? low : lower;
        v->highest[i] = high < higher ? higher : high;
    }
}

/// Adds γ (n·Γ) of edge k, wholly above the horizon and seen under less than a right angle: the
/// same bits as add_arc.
static inline void add_edge(int k, lanes_view *v)
{
    const lanes3 *a = &v->corner[k], *b = &v->corner[k + 1];
    ALPI_EACH_LANE
    {
        const double ex = b->x[i] - a->x[i], ey = b->y[i] - a->y[i], ez = b->z[i] - a->z[i];
        const double x = a->y[i] * ez - a->z[i] * ey;
        const double y = a->z[i] * ex - a->x[i] * ez;
        const double z = a->x[i] * ey - a->y[i] * ex;
        const double along = v->normal.x[i] * x + v->normal.y[i] * y + v->normal.z[i] * z;
        const double scale = 1.0 / sqrt(v->square[k][i] * v->square[k + 1][i]);
        const double dot = a->x[i] * b->x[i] + a->y[i] * b->y[i] + a->z[i] * b->z[i];
        v->sum[i] += along * scale * angle_over_sine(0.5 - 0.5 * (dot * scale));
    }
}

/// Where the horizon cuts polygons: where they dive below, and come up.
typedef struct lanes_horizon {
    lanes3 left, risen;
} lanes_horizon;

/// Adds γ (n·Γ) from a to b, of any angle.
static inline void add_arc(const lanes3 *a, const lanes3 *b, lanes_view *v)
{
    ALPI_EACH_LANE
    {
        const double ex = b->x[i] - a->x[i], ey = b->y[i] - a->y[i], ez = b->z[i] - a->z[i];
        const double x = a->y[i] * ez - a->z[i] * ey;
        const double y = a->z[i] * ex - a->x[i] * ez;
        const double z = a->x[i] * ey - a->y[i] * ex;
        const double along = v->normal.x[i] * x + v->normal.y[i] * y + v->normal.z[i] * z;
        const double a2 = a->x[i] * a->x[i] + a->y[i] * a->y[i] + a->z[i] * a->z[i];
        const double b2 = b->x[i] * b->x[i] + b->y[i] * b->y[i] + b->z[i] * b->z[i];
        const double both = a2 * b2;
        const double scale = 1.0 / sqrt(both > 1e-300 ? both : 1e-300);
        const double dot = a->x[i] * b->x[i] + a->y[i] * b->y[i] + a->z[i] * b->z[i];
        const double cosine = dot * scale;
        const double sharp = along * scale * angle_over_sine(0.5 - 0.5 * fabs(cosine));
        const double length = x * x + y * y + z * z; // its square
        const double straight = ALPI_PI * along / sqrt(length > 1e-300 ? length : 1e-300);
        v->sum[i] += cosine < 0.0 ? straight - sharp : sharp;
    }
}

/// The part of edge k that is above the horizon; both ends are the first corner where none is.
static inline void clip_edge(const lanes_view *v, int k, lanes3 *from, lanes3 *to, lanes_horizon *h)
{
    const lanes3 *a = &v->corner[k], *b = &v->corner[k + 1];
    ALPI_EACH_LANE
    {
        const double ha = v->height[k][i], hb = v->height[k + 1][i];
        const double apart = ha - hb;
        const double t = ha / (apart == 0.0 ? 1.0 : apart);
        const double x = a->x[i] + t * (b->x[i] - a->x[i]);
        const double y = a->y[i] + t * (b->y[i] - a->y[i]);
        const double z = a->z[i] + t * (b->z[i] - a->z[i]);
        from->x[i] = ha >= 0.0 ? a->x[i] : x;
        from->y[i] = ha >= 0.0 ? a->y[i] : y;
        from->z[i] = ha >= 0.0 ? a->z[i] : z;
        const double sunk = ha >= 0.0 ? 1.0 : hb; // < 0: all of it
        to->x[i] = sunk < 0.0 ? from->x[i] : hb >= 0.0 ? b->x[i] : x;
        to->y[i] = sunk < 0.0 ? from->y[i] : hb >= 0.0 ? b->y[i] : y;
        to->z[i] = sunk < 0.0 ? from->z[i] : hb >= 0.0 ? b->z[i] : z;
        const double dives = ha >= 0.0 ? hb : 1.0, comes_up = ha >= 0.0 ? -1.0 : hb;
        h->left.x[i] = dives < 0.0 ? x : h->left.x[i];
        h->left.y[i] = dives < 0.0 ? y : h->left.y[i];
        h->left.z[i] = dives < 0.0 ? z : h->left.z[i];
        h->risen.x[i] = comes_up >= 0.0 ? x : h->risen.x[i];
        h->risen.y[i] = comes_up >= 0.0 ? y : h->risen.y[i];
        h->risen.z[i] = comes_up >= 0.0 ? z : h->risen.z[i];
    }
}

/// All edges, clipped to the horizon.
static void add_clipped(lanes_view *v)
{
    lanes_horizon h = {v->corner[0], v->corner[0]};
    lanes3 from, to;
    for (int k = 0; k < 4; k++) {
        clip_edge(v, k, &from, &to, &h);
        add_arc(&from, &to, v);
    }
    add_arc(&h.left, &h.risen, v);
}

/// Form factors from the points of a sample, 0 where a point is behind, or so close to its plane
/// that it is on it: closer than rays start. @return false: all are 0
static bool find_factors(alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s)
{
    lanes_view v;
    view_corners(w, p, s, &v);
    const double far = (double)p->diameter * (double)p->diameter * 1.0001;
    bool clipped = false, any = false;
    w->nears[s] = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const bool near = !(v.middle[i] > far);
        clipped = clipped || near || v.lowest[i] < 0.0;
        any = any || v.highest[i] > 0.0;
        w->nears[s] |= near ? 1u << i : 0u;
    }
    if (!any) {
        return false;
    }
    if (clipped) {
        add_clipped(&v);
    }
    for (int k = 0; k < 4 && !clipped; k++) {
        add_edge(k, &v);
    }
    const float *wanted = w->wanted[half_of(w->begin + s)];
    _Alignas(32) float given[ALPI_PACKET];
    const double3 front = double3_from(p->normal);
    const double behind = p->two_sided ? -1.0 : 0.0;
    ALPI_EACH_LANE
    {
        const double height =
            -(front.x * v.corner[0].x[i] + front.y * v.corner[0].y[i] + front.z * v.corner[0].z[i]);
        const double away = height > 0.0 ? height : behind * height;
        const double factor = (height > 0.0 ? -0.5 / ALPI_PI : 0.5 / ALPI_PI) * v.sum[i];
        const double positive = factor > 0.0 ? factor : 0.0;
        const double seen = away > (double)w->offset[s][i] ? positive : 0.0;
        w->factor[s][i] = seen * (double)wanted[i];
        given[i] = (float)w->factor[s][i];
    }
    float sum = 0.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        w->weight[s][i] = given[i];
        sum += given[i];
    }
    return sum > 0.0f;
}

// --- rays ----------------------------------------------------------------------------------------

/// Points of the polygon, of even density, that u and v tell: their light, and rays to them. None
/// where the form factor is 0.
static inline void aim_sample(alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s,
                              alpi_rays *rays)
{
    const vec3 c = p->corner[0], e = p->along, f = p->across, n = p->normal;
    const float area = p->area;
    const bool triangle = p->triangle;
    ALPI_EACH_LANE
    {
        const float u = w->u[s][i], v = w->v[s][i];
        const float root = sqrtf(u); // of a triangle: as many points as it is wide
        const float a = triangle ? root * (1.0f - v) : u, b = triangle ? root * v : v;
        const float x = c.x + a * e.x + b * f.x - w->origin[0][s][i];
        const float y = c.y + a * e.y + b * f.y - w->origin[1][s][i];
        const float z = c.z + a * e.z + b * f.z - w->origin[2][s][i];
        const float square = x * x + y * y + z * z;
        const float inverse = 1.0f / sqrtf(square);
        const float dx = x * inverse, dy = y * inverse, dz = z * inverse;
        const float here =
            dx * w->normal[0][s][i] + dy * w->normal[1][s][i] + dz * w->normal[2][s][i];
        const float there = fabsf(dx * n.x + dy * n.y + dz * n.z);
        const float weight = area * here * there * inverse * inverse;
        const float sane = weight < 1e30f ? weight : 0.0f; // not where a number is none
        const float given = w->weight[s][i] > 0.0f ? sane : 0.0f;
        const float reach = square * inverse * (1.0f - 1e-5f) - 2.0f * w->offset[s][i];
        const float far = reach > 0.0f ? reach : 0.0f;
        w->weight[s][i] = given > 0.0f ? given : 0.0f;
        rays->origin_x[i] = w->origin[0][s][i];
        rays->origin_y[i] = w->origin[1][s][i];
        rays->origin_z[i] = w->origin[2][s][i];
        rays->direction_x[i] = given > 0.0f ? dx : 0.0f;
        rays->direction_y[i] = given > 0.0f ? dy : 0.0f;
        rays->direction_z[i] = given > 0.0f ? dz : 0.0f;
        rays->maximum[i] = given > 0.0f ? far : 0.0f;
    }
}

/// Nothing comes of a sample.
static void clear_sample(alpi_polygon_wave *w, uint32_t s)
{
    w->nears[s] = 0;
    memset(w->factor[s], 0, sizeof w->factor[s]);
    memset(w->weight[s], 0, sizeof w->weight[s]);
    memset(w->rays[s].maximum, 0, sizeof w->rays[s].maximum);
}

/// As a scout: what it would bring does not count, so the form factor of another point says whether
/// it would bring anything.
static void aim_scout(alpi_polygon_wave *w, const alpi_polygon *p, uint32_t s)
{
    const uint32_t other = s - w->scouts;
    for (int i = 0; i < ALPI_PACKET; i++) {
        w->weight[s][i] = w->factor[other][i] > 0.0 ? 1.0f : 0.0f;
    }
    w->nears[s] = 0;
    aim_sample(w, p, s, &w->rays[s]);
}

static void aim(alpi_polygon_wave *w, const alpi_polygon *p)
{
    for (uint32_t s = 0; s < w->count - w->scouts; s++) {
        if (w->any_wanted[half_of(w->begin + s)] && find_factors(w, p, s)) {
            aim_sample(w, p, s, &w->rays[s]);
        } else {
            clear_sample(w, s);
        }
    }
    for (uint32_t s = w->count - w->scouts; s < w->count; s++) {
        aim_scout(w, p, s);
    }
}

// --- sums ----------------------------------------------------------------------------------------

static void tally(const alpi_polygon_wave *w, bool panes, alpi_polygon_tally *t)
{
    const double share = panes ? 0.0 : 1.0;
    for (uint32_t s = 0; s < w->count - w->scouts; s++) {
        const uint32_t r = (w->begin + s) % ALPI_DIRECT_REPLICATES;
        ALPI_EACH_LANE
        {
            const double weight = (double)w->weight[s][i];
            t->factor[r][i] += w->factor[s][i];
            t->weight[r][i] += weight;
            t->seen[0][r][i] += w->rays[s].maximum[i] >= 0.0f ? weight * share : 0.0;
        }
    }
}

const alpi_polygon_loops ALPI_VARIANT(alpi_polygon_loops) = {draw, aim, tally};
