// SPDX-License-Identifier: MIT
// The choice of the next anchors to sample.
//
// Each level has a window round the way of the camera. The way begins at its position, and goes
// where the camera will be within a second. That follows from a known path, or from its velocity
// with inertia.
//
// Missing anchors come in the order of their level, coarse before fine. Among those of a level,
// near ones come first, then those in view, near objects, and where neighbours differ. Anchors are
// renewed before they expire. At speed, the finest levels would need more anchors than can be
// sampled: they have no window.
#include "base/memory.h"
#include "fields/ambience/ambience.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WAY_POINTS = 5, PLAN_UPDATES = 4 };
static const double PLAN_TIME = 0.1;   // seconds that a plan serves at most
static const double AHEAD = 1.0;       // seconds that are predicted
static const double INERTIA = 0.3;     // seconds that smooth the velocity
static const double MOST_CELLS = 15.0; // per second: finer cells pass before their light fades in
static const double OUTSIDE = 2.0; // cells round the way that have anchors beyond the bounds too
enum { RADII = 9 };
/// Cells of a window's radius, the widest that there is room for: in a volume, and flat.
static const double RADIUS[2][RADII] = {{24.0, 18.0, 14.0, 11.0, 9.0, 7.0, 5.0, 4.0, 3.0},
                                        {48.0, 40.0, 32.0, 24.0, 20.0, 16.0, 12.0, 8.0, 6.0}};
static const float RENEWAL = 0.6f;     // share of the lifetime from which on
static const float URGENT = 0.85f;     // the same, before all that is missing
static const double LEAST_RATE = 30.0; // anchors per second that any host samples
static const double CROWDED = 0.7;     // share of the limit from which on others fade out early
static const float RELIGHT = 0.15f;    // share of the lifetime after which stale light is urgent

/// A plan while it is made.
typedef struct plan {
    alp_ambience *a;
    const alp_ambience_camera *camera;
    double way[WAY_POINTS][3]; // metres
    uint32_t way_count;
    double length, speed; // of the way; metres per second
    double radius;        // of the window, cells
    double count;         // anchors of windows so far
    float mean;           // E
    alp_result result;
} plan;

// --- the way of the camera -----------------------------------------------------------------------

static bool all_finite(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static alp_result refuse_camera(const alp_ambience *a)
{
    return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                     "ambience: the camera's position, velocity, objects or path are not finite");
}

static alp_result check_camera(const alp_ambience *a, const alp_ambience_camera *c)
{
    if (!all_finite(c->position) || !all_finite(c->velocity) || !all_finite(c->forward) ||
        !isfinite(c->vfov)) {
        return refuse_camera(a);
    }
    if (isnan(a->time)) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: nothing is sampled before the first update");
    }
    return ALP_OK;
}

/// Objects and the path may be many, and are read by plans alone.
static alp_result check_lists(const alp_ambience *a, const alp_ambience_camera *c)
{
    bool good = true;
    for (uint32_t i = 0; c->objects != NULL && i < c->object_count; i++) {
        good = good && all_finite(c->objects[i]) && isfinite(c->objects[i][3]);
    }
    for (uint32_t i = 0; c->path != NULL && i < c->path_count; i++) {
        good = good && isfinite(c->path[i][0]) && all_finite(c->path[i] + 1);
    }
    return good ? ALP_OK : refuse_camera(a);
}

/// Place on a known path, which stays at its ends.
static void path_place(const alp_ambience_camera *c, double time, double place[3])
{
    uint32_t i = 1;
    while (i < c->path_count && c->path[i][0] < time) {
        i++;
    }
    const double *from = c->path[i - 1], *to = c->path[i < c->path_count ? i : i - 1];
    const double span = to[0] - from[0];
    const double share = span > 0.0 ? fmin(fmax((time - from[0]) / span, 0.0), 1.0) : 0.0;
    for (int k = 0; k < 3; k++) {
        place[k] = from[k + 1] + share * (to[k + 1] - from[k + 1]);
    }
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static void predict_way(plan *p)
{
    alp_ambience *a = p->a;
    const alp_ambience_camera *c = p->camera;
    const bool known = c->path != NULL && c->path_count > 0;
    const double step = isnan(a->planned_time) ? 1e30 : a->time - a->planned_time;
    const double keep = exp(-step / INERTIA);
    a->planned_time = a->time;
    for (int k = 0; k < 3; k++) {
        a->velocity[k] = c->velocity[k] + keep * (a->velocity[k] - c->velocity[k]);
        a->velocity[k] = isfinite(a->velocity[k]) ? a->velocity[k] : 0.0;
    }
    p->way_count = known ? WAY_POINTS : 2;
    p->length = 0.0;
    for (uint32_t i = 0; i < p->way_count; i++) {
        const double ahead = AHEAD * (double)i / (double)(p->way_count - 1);
        for (int k = 0; k < 3; k++) {
            p->way[i][k] = c->position[k] + ahead * a->velocity[k];
        }
        if (known && i > 0) {
            path_place(c, a->time + ahead, p->way[i]);
        }
        if (a->options.flat) {
            p->way[i][1] = 0.0;
        }
        p->length += i > 0 ? distance(p->way[i], p->way[i - 1]) : 0.0;
    }
    p->speed = p->length / AHEAD;
}

/// Distance from a place to the way, metres.
static double way_distance(const plan *p, const double place[3], uint32_t points)
{
    double nearest = distance(place, p->way[0]);
    for (uint32_t i = 1; i < points; i++) {
        const double *from = p->way[i - 1], *to = p->way[i];
        double along = 0.0, square = 0.0, foot[3];
        for (int k = 0; k < 3; k++) {
            along += (place[k] - from[k]) * (to[k] - from[k]);
            square += (to[k] - from[k]) * (to[k] - from[k]);
        }
        const double share = square > 0.0 ? fmin(fmax(along / square, 0.0), 1.0) : 0.0;
        for (int k = 0; k < 3; k++) {
            foot[k] = from[k] + share * (to[k] - from[k]);
        }
        nearest = fmin(nearest, distance(place, foot));
    }
    return nearest;
}

// --- urgency -------------------------------------------------------------------------------------

/// 1 where the camera looks and near objects, less elsewhere.
static float find_interest(const plan *p, const double place[3], double cell)
{
    const alp_ambience_camera *c = p->camera;
    for (uint32_t i = 0; c->objects != NULL && i < c->object_count; i++) {
        if (distance(place, c->objects[i]) < fabs(c->objects[i][3]) + cell) {
            return 1.0f;
        }
    }
    const double *f = c->forward;
    const double length = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double away = distance(place, c->position);
    if (!(length > 0.0) || away <= 2.0 * cell) {
        return 0.8f;
    }
    const double along = ((place[0] - c->position[0]) * f[0] + (place[1] - c->position[1]) * f[1] +
                          (place[2] - c->position[2]) * f[2]) /
                         (away * length);
    const double fov = c->vfov > 0.0 ? c->vfov : 1.0;
    return along > cos(fmin(fov, 2.0)) ? 0.8f : 0.4f; // the diagonal of a wide picture
}

/// Largest difference of the mean E between the parent and its neighbours, over the mean: 0 to 1.
static float expect_change(const plan *p, uint32_t level, const int32_t index[3])
{
    const alp_ambience *a = p->a;
    int32_t up[3];
    for (int k = 0; k < 3; k++) {
        up[k] = alpi_graph_parent_index(index[k]);
    }
    const uint32_t parent = alpi_graph_find(&a->graph, level + 1, up);
    if (parent == ALPI_NO_NODE || !(p->mean > 0.0f)) {
        return 1.0f;
    }
    const alpi_graph_node *n = &a->graph.nodes[parent];
    if (n->anchor == ALPI_NO_ANCHOR || a->anchors[n->anchor].state != ALPI_ANCHOR_LIT) {
        return 1.0f;
    }
    const float here = a->anchors[n->anchor].mean;
    float most = 0.0f;
    for (int d = 0; d < ALPI_GRAPH_DIRECTIONS; d++) {
        const uint32_t other = n->neighbour[d];
        const uint32_t at = other != ALPI_NO_NODE ? a->graph.nodes[other].anchor : ALPI_NO_ANCHOR;
        if (at == ALPI_NO_ANCHOR) {
            continue;
        }
        const bool solid = a->anchors[at].state == ALPI_ANCHOR_SOLID;
        const float there = solid ? here + p->mean : a->anchors[at].mean;
        most = fmaxf(most, fabsf(there - here));
    }
    return fminf(most / p->mean, 1.0f);
}

/// Urgency of an anchor that is there; 0: none.
static float renewal_urgency(const plan *p, const alpi_anchor *at, float near)
{
    const float age = (float)((p->a->time - at->born) / p->a->options.lifetime);
    if (at->pending || at->state == ALPI_ANCHOR_EMPTY) {
        return 0.0f;
    }
    if (at->stale_trace != 0) {
        return 30.0f + near;
    }
    if (at->state == ALPI_ANCHOR_SOLID) {
        return age > 3.0f ? 1.0f + near : 0.0f;
    }
    if (age > URGENT) {
        return 25.0f + age;
    }
    if (at->stale_light != 0) {
        return 4.0f + 12.0f * fminf(age / RELIGHT, 1.0f) + near;
    }
    if (at->coarse) {
        return 3.0f + near + fminf(at->change, 1.0f);
    }
    return age > RENEWAL ? age + near + fminf(at->change, 1.0f) : 0.0f;
}

// --- windows -------------------------------------------------------------------------------------

static void add_wish(plan *p, uint32_t level, const int32_t index[3], float urgency)
{
    alp_ambience *a = p->a;
    if (p->result == ALP_OK) {
        p->result = alpi_grow_tightly(a->context, (void **)&a->wishes, &a->wish_capacity,
                                      (size_t)a->wish_count + 1, sizeof *a->wishes);
    }
    if (p->result == ALP_OK) {
        alpi_wish *wish = &a->wishes[a->wish_count++];
        wish->urgency = urgency;
        wish->level = level;
        memcpy(wish->index, index, sizeof wish->index);
    }
}

static bool is_middle(const int32_t index[3])
{
    return index[0] % 3 == 0 && index[1] % 3 == 0 && index[2] % 3 == 0;
}

/// Whether a place is where light is wanted, or within a cell of it.
static bool is_within(const alp_ambience *a, const double place[3], double cell)
{
    bool within = true;
    for (int k = 0; k < 3; k++) {
        const bool flat = a->options.flat && k == 1;
        within =
            within &&
            (flat || (place[k] > a->bounds_min[k] - cell && place[k] < a->bounds_max[k] + cell));
    }
    return within;
}

/// Whether a place is so deep in a solid that no open point reads it. Then an ancestor lies in a
/// solid, and its surface is farther than the place and a cell's diagonal.
static bool is_deep(const alp_ambience *a, uint32_t level, const int32_t index[3],
                    const double place[3])
{
    const double diagonal = 1.7320508 * alpi_ambience_cell(a, level);
    int32_t up[3] = {index[0], index[1], index[2]};
    for (uint32_t l = level + 1; l <= a->graph.depth; l++) {
        for (int k = 0; k < 3; k++) {
            up[k] = alpi_graph_parent_index(up[k]);
        }
        const uint32_t node = alpi_graph_find(&a->graph, l, up);
        const uint32_t anchor = node != ALPI_NO_NODE ? a->graph.nodes[node].anchor : ALPI_NO_ANCHOR;
        if (anchor == ALPI_NO_ANCHOR || a->anchors[anchor].state != ALPI_ANCHOR_SOLID) {
            continue;
        }
        double middle[3];
        alpi_anchor_place(a, &a->anchors[anchor], middle);
        if (distance(place, middle) + diagonal < (double)a->anchors[anchor].surface) {
            return true;
        }
    }
    return false;
}

static void consider(plan *p, uint32_t level, const int32_t index[3], uint32_t points)
{
    alp_ambience *a = p->a;
    const double cell = alpi_ambience_cell(a, level);
    double place[3];
    for (int k = 0; k < 3; k++) { // a flat way is at height 0
        place[k] = a->options.centre[k] + cell * (double)index[k];
    }
    if (a->options.flat) {
        place[1] = 0.0;
    }
    const double away = way_distance(p, place, points) / cell;
    // Parents own the anchors of their middle children.
    if (away > p->radius || (level < a->graph.depth && is_middle(index)) ||
        (away > OUTSIDE && !is_within(a, place, cell))) {
        return;
    }
    const bool top = level + 1 >= a->graph.depth;
    if (top && !alpi_graph_reaches(&a->graph, level, index)) {
        return; // coarse windows alone do not make the root grow
    }
    const float near = 1.0f - (float)(away / (p->radius + 1.0));
    const uint32_t node = alpi_graph_find(&a->graph, level, index);
    const uint32_t anchor = node != ALPI_NO_NODE ? a->graph.nodes[node].anchor : ALPI_NO_ANCHOR;
    if (anchor != ALPI_NO_ANCHOR) {
        a->anchors[anchor].wanted = a->time;
        const float urgency = renewal_urgency(p, &a->anchors[anchor], near);
        if (urgency > 0.0f) {
            add_wish(p, level, index, urgency);
        }
        return;
    }
    if (is_deep(a, level, index, place)) {
        return;
    }
    const float interest = near * find_interest(p, place, cell);
    add_wish(p, level, index,
             4.0f + 2.0f * (float)level +
                 2.0f * interest * (0.3f + expect_change(p, level, index)));
}

/// Anchors that no window holds fade out before they expire, if room gets scarce.
static void make_room(alp_ambience *a)
{
    if ((double)a->anchor_count < CROWDED * (double)a->options.anchor_limit) {
        return;
    }
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        alpi_anchor *at = &a->anchors[i];
        if (at->state != ALPI_ANCHOR_FREE && !at->pending && at->wanted < a->time) {
            at->born = fmin(at->born, a->time - 10.0 * a->options.lifetime);
        }
    }
}

/// Anchors in the window of a level at most: those in its radius, in the bounds, and of coarse
/// levels in the root.
static double window_count(const plan *p, uint32_t level)
{
    const alp_ambience *a = p->a;
    const double r = p->radius, cell = alpi_ambience_cell(a, level), length = p->length / cell;
    const double children = a->options.flat ? 9.0 : 27.0;
    const double root = 2.0 * pow(children, (double)a->graph.depth - (double)level);
    double bounds = 1.0;
    for (int k = 0; k < 3; k++) {
        const double cells = (a->bounds_max[k] - a->bounds_min[k]) / cell + 2.0;
        bounds *= a->options.flat && k == 1 ? 1.0 : fmax(cells, 1.0);
    }
    const double round = a->options.flat ? ALPI_PI * r * r + 2.0 * r * length
                                         : ALPI_PI * r * r * (4.0 / 3.0 * r + length);
    const double least = fmin(round, bounds);
    return level + 2 >= a->graph.depth ? fmin(least, root) : least;
}

/// Whether a level with the plan's radius can be kept up at the camera's speed.
static bool is_kept_up(const plan *p, uint32_t level)
{
    const alp_ambience *a = p->a;
    const double cell = alpi_ambience_cell(a, level);
    const double across = a->options.flat ? 2.0 * p->radius : ALPI_PI * p->radius * p->radius;
    const double each_second = p->speed / cell * across;
    const double count = p->count + window_count(p, level);
    return p->speed <= MOST_CELLS * cell && count <= CROWDED * (double)a->options.anchor_limit &&
           each_second <= fmax(a->rate, LEAST_RATE);
}

/// Chooses the radius of a level. Coarse levels have less wide windows, which leaves room for fine
/// ones. @return whether there is one
static bool choose_radius(plan *p, uint32_t level)
{
    const alp_ambience *a = p->a;
    for (int i = level > 0 ? 6 : 0; i < RADII; i++) {
        p->radius = RADIUS[a->options.flat][i];
        if (is_kept_up(p, level)) {
            p->count += window_count(p, level);
            return true;
        }
    }
    return false;
}

static void scan_window(plan *p, uint32_t level, uint32_t points)
{
    const alp_ambience *a = p->a;
    const double cell = alpi_ambience_cell(a, level), reach = p->radius * cell;
    double low[3], high[3];
    int32_t first[3], last[3], index[3];
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = p->way[0][k];
        for (uint32_t i = 1; i < points; i++) {
            low[k] = fmin(low[k], p->way[i][k]);
            high[k] = fmax(high[k], p->way[i][k]);
        }
        const double near_low = low[k] - OUTSIDE * cell, near_high = high[k] + OUTSIDE * cell;
        low[k] -= reach;
        high[k] += reach;
        if (!a->options.flat || k != 1) {
            low[k] = fmin(fmax(low[k], a->bounds_min[k] - cell), near_low);
            high[k] = fmax(fmin(high[k], a->bounds_max[k] + cell), near_high);
        }
    }
    if (!alpi_ambience_index(a, level, low, first) || !alpi_ambience_index(a, level, high, last)) {
        return;
    }
    for (index[2] = first[2]; index[2] <= last[2]; index[2]++) {
        for (index[1] = first[1]; index[1] <= last[1]; index[1]++) {
            for (index[0] = first[0]; index[0] <= last[0]; index[0]++) {
                consider(p, level, index, points);
            }
        }
    }
}

static int compare_wishes(const void *a, const void *b)
{
    const alpi_wish *x = a, *y = b;
    if (x->urgency != y->urgency) {
        return x->urgency < y->urgency ? -1 : 1;
    }
    if (x->level != y->level) {
        return x->level < y->level ? -1 : 1;
    }
    return memcmp(x->index, y->index, sizeof x->index);
}

static alp_result make_plan(alp_ambience *a, const alp_ambience_camera *camera)
{
    plan p = {.a = a, .camera = camera, .mean = a->mean, .result = ALP_OK};
    int32_t index[3];
    ALP_TRY(check_lists(a, camera));
    a->wish_count = 0;
    a->plan_age = 0;
    memcpy(a->planned_from, camera->position, sizeof a->planned_from);
    predict_way(&p);
    uint32_t node;
    if (alpi_ambience_index(a, a->graph.depth, p.way[0], index)) { // the root grows to the camera
        ALP_TRY(alpi_graph_require(&a->graph, a->graph.depth, index, &node));
    }
    for (uint32_t down = 0; down <= a->graph.depth; down++) {
        const uint32_t level = a->graph.depth - down;
        const bool kept_up = choose_radius(&p, level);
        if (kept_up || level + 1 >= a->graph.depth) {
            scan_window(&p, level, kept_up ? p.way_count : 1);
        }
    }
    make_room(a);
    if (a->wish_count > 1) {
        qsort(a->wishes, a->wish_count, sizeof *a->wishes, compare_wishes);
    }
    return p.result;
}

// --- choice --------------------------------------------------------------------------------------

/// A plan serves some updates, while the camera stays in about its place and time moves.
static bool is_plan_old(const alp_ambience *a, const alp_ambience_camera *camera)
{
    const bool warms_up = !(a->time > a->first_time);
    return a->plan_age >= (warms_up ? 1 : PLAN_UPDATES) || a->time - a->planned_time > PLAN_TIME ||
           (a->plan_age > 0 && distance(a->planned_from, camera->position) > 0.25 * a->unit);
}

alp_result alpi_ambience_choose(alp_ambience *a, const alp_ambience_camera *camera,
                                uint32_t *anchor)
{
    *anchor = ALPI_NO_ANCHOR;
    ALP_TRY(check_camera(a, camera));
    if (is_plan_old(a, camera)) {
        ALP_TRY(make_plan(a, camera));
    }
    while (a->wish_count > 0) {
        const alpi_wish wish = a->wishes[--a->wish_count];
        uint32_t node, found;
        ALP_TRY(alpi_graph_require(&a->graph, wish.level, wish.index, &node));
        if (node == ALPI_NO_NODE) {
            continue;
        }
        found = a->graph.nodes[node].anchor;
        if (found == ALPI_NO_ANCHOR) {
            ALP_TRY(alpi_anchor_create(a, node, &found));
        }
        if (found != ALPI_NO_ANCHOR && !a->anchors[found].pending) {
            a->anchors[found].pending = true;
            *anchor = found;
            return ALP_OK;
        }
    }
    return ALP_OK;
}

alp_result alp_ambience_next(alp_ambience *ambience, const alp_ambience_camera *camera,
                             alp_ambience_request *request)
{
    if (ambience == NULL || camera == NULL || request == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    uint32_t anchor;
    *request = (alp_ambience_request){0};
    ALP_TRY(alpi_ambience_choose(ambience, camera, &anchor));
    if (anchor == ALPI_NO_ANCHOR) {
        return ALP_OK;
    }
    alpi_anchor *at = &ambience->anchors[anchor];
    request->id = alpi_request_open(ambience, anchor);
    if (request->id == 0) {
        at->pending = false;
        return ALP_OK;
    }
    alpi_anchor_place(ambience, at, request->position);
    request->cell = alpi_ambience_cell(ambience, at->level);
    request->renewal = at->state == ALPI_ANCHOR_LIT;
    request->relight = request->renewal && at->stale_light != 0 && at->stale_trace == 0;
    return ALP_OK;
}
