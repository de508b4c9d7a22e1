// SPDX-License-Identifier: MIT
// Ear clipping, with a queue of corners that may have become ears and a grid of reflex corners, so
// that a polygon of a hundred thousand corners is no matter of minutes.
// Meisters. Polygons Have Ears. American Mathematical Monthly 82, 1975.
// Eberly. Triangulation by Ear Clipping. Geometric Tools, 2002 (bridges to holes).
// Newell's normal: Sutherland, Sproull, Schumacker. A Characterization of Ten Hidden-Surface
// Algorithms. ACM Computing Surveys 6, 1974.
#include "formats/collada_polygon.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef struct alpi_ear_corner {
    double x, y;
    uint32_t point, previous, next;
    bool gone, reflex, queued;
} corner;

#define NONE UINT32_MAX
/// Bridges look at every corner for every hole.
#define BRIDGE_LIMIT ((uint64_t)1 << 28)

typedef struct cut {
    alpi_ear_cutter *cutter;
    const alpi_ear_polygon *polygon;
    corner *corners;
    uint32_t count, left; // corners made, and still there
    int axis_u, axis_v;   // coordinates that are kept
    bool flipped;
    // grid of reflex corners: cells[c] … cells[c + 1] of members
    double low[2], step[2];
    uint32_t side;
    uint32_t head, tail; // of the queue, a ring of count + 1
    uint64_t work;       // looks at corners that are left before ears are cut unseen
    uint32_t (*triangles)[3];
    uint32_t triangle_count;
    bool tidy;
} cut;

void alpi_ear_cutter_destroy(alpi_ear_cutter *cutter)
{
    alp_context *context = cutter->context;
    alpi_release(context, cutter->corners);
    alpi_release(context, cutter->queue);
    alpi_release(context, cutter->cells);
    alpi_release(context, cutter->members);
    *cutter = (alpi_ear_cutter){.context = context};
}

static uint32_t corner_count(const alpi_ear_polygon *polygon)
{
    return polygon->ring_ends[polygon->ring_count - 1];
}

uint32_t alpi_ear_triangle_count(const alpi_ear_polygon *polygon)
{
    return corner_count(polygon) + 2 * (polygon->ring_count - 1) - 2;
}

// --- the plane -----------------------------------------------------------------------------------

/// Twice the signed area of a, b, c. Of floats the differences are exact, or nearly so.
static double turn(const corner *a, const corner *b, const corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static void newell_normal(const alpi_ear_polygon *polygon, double normal[3])
{
    const uint32_t count = polygon->ring_ends[0];
    const float *origin = polygon->points[0];
    normal[0] = normal[1] = normal[2] = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const float *p = polygon->points[i], *q = polygon->points[(i + 1) % count];
        double a[3], b[3];
        for (int k = 0; k < 3; k++) { // far from the origin products would lose the area
            a[k] = (double)p[k] - (double)origin[k];
            b[k] = (double)q[k] - (double)origin[k];
        }
        for (int k = 0; k < 3; k++) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            normal[k] += a[u] * b[v] - a[v] * b[u];
        }
    }
}

/// Leaves out the coordinate along which the polygon is flattest; the rest stays as it is, exactly.
static void choose_plane(cut *c)
{
    double normal[3];
    newell_normal(c->polygon, normal);
    int k = 0;
    for (int i = 1; i < 3; i++) {
        k = fabs(normal[i]) > fabs(normal[k]) ? i : k;
    }
    c->axis_u = (k + 1) % 3;
    c->axis_v = (k + 2) % 3;
    c->flipped = normal[k] < 0.0;
}

/// A corner at the end of `corners`, not linked yet.
static uint32_t add_corner(cut *c, uint32_t point)
{
    const float *p = c->polygon->points[point];
    const double u = (double)p[c->axis_u], v = (double)p[c->axis_v];
    c->corners[c->count] = (corner){
        .x = isfinite(u) ? (c->flipped ? -u : u) : 0.0, .y = isfinite(v) ? v : 0.0, .point = point};
    return c->count++;
}

static void link_corners(cut *c, uint32_t first, uint32_t second)
{
    c->corners[first].next = second;
    c->corners[second].previous = first;
}

/// Makes a ring that turns counter-clockwise, or clockwise for a hole. @return its first corner
static uint32_t add_ring(cut *c, uint32_t begin, uint32_t end, bool hole)
{
    const uint32_t first = c->count;
    double area = 0.0;
    for (uint32_t i = begin; i < end; i++) {
        add_corner(c, i);
    }
    for (uint32_t i = first + 1; i + 1 < c->count; i++) {
        area += turn(&c->corners[first], &c->corners[i], &c->corners[i + 1]);
    }
    const bool turned = hole && area > 0.0;
    for (uint32_t i = first; i < c->count; i++) {
        const uint32_t next = i + 1 < c->count ? i + 1 : first;
        link_corners(c, turned ? next : i, turned ? i : next);
    }
    return first;
}

// --- bridges to holes ----------------------------------------------------------------------------

static uint32_t rightmost(const cut *c, uint32_t first)
{
    uint32_t best = first;
    for (uint32_t i = c->corners[first].next; i != first; i = c->corners[i].next) {
        best = c->corners[i].x > c->corners[best].x ? i : best;
    }
    return best;
}

static bool in_triangle(const corner *a, const corner *b, const corner *c, const corner *p)
{
    return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

/// Whether the direction from corner `at` of the ring to p starts inside the polygon.
static bool starts_inside(const cut *c, uint32_t at, const corner *p)
{
    const corner *a = &c->corners[at];
    const corner *before = &c->corners[a->previous], *after = &c->corners[a->next];
    return turn(before, a, after) > 0.0 ? turn(before, a, p) > 0.0 && turn(a, after, p) > 0.0
                                        : !(turn(before, a, p) < 0.0 && turn(a, after, p) < 0.0);
}

/// The edge of the ring at `outer` that a ray from m towards +x meets first: the end of it that
/// lies further to the right; *x is where. NONE: it meets none.
static uint32_t edge_right_of(cut *c, uint32_t outer, const corner *m, double *x)
{
    uint32_t best = NONE, i = outer;
    *x = HUGE_VAL;
    do {
        const corner *a = &c->corners[i], *b = &c->corners[a->next];
        if (a->y <= m->y && b->y >= m->y && a->y != b->y) { // upwards: inside is on its left
            const double at = a->x + (m->y - a->y) / (b->y - a->y) * (b->x - a->x);
            if (at >= m->x && at < *x) {
                *x = at;
                best = a->x > b->x ? i : a->next;
                best = a->y == m->y ? i : b->y == m->y ? a->next : best; // an end itself is seen
            }
        }
        i = a->next;
    } while (i != outer);
    return best;
}

/// A corner of the ring that the rightmost corner of a hole sees: Eberly's rule.
static uint32_t visible_corner(cut *c, uint32_t outer, const corner *m)
{
    double x;
    const uint32_t found = edge_right_of(c, outer, m, &x);
    if (found == NONE) {
        c->tidy = false; // the hole lies outside
        return outer;
    }
    uint32_t best = found;
    const corner hit = {.x = x, .y = m->y}, *p = &c->corners[found];
    if (p->x == hit.x && p->y == hit.y) { // of copies, one that looks towards the hole
        uint32_t i = found;
        do {
            const corner *q = &c->corners[i];
            if (q->x == p->x && q->y == p->y && starts_inside(c, i, m)) {
                return i;
            }
            i = q->next;
        } while (i != found);
        return found;
    }
    const bool above = p->y > m->y;
    double best_slope = HUGE_VAL;
    uint32_t i = outer;
    do { // what lies inside m, hit, p hides p: take the one nearest to the ray
        const corner *q = &c->corners[i];
        const bool inside = above ? in_triangle(m, &hit, p, q) : in_triangle(m, p, &hit, q);
        if (inside && q->x > m->x && starts_inside(c, i, m)) {
            const double slope = fabs(q->y - m->y) / (q->x - m->x);
            if (slope < best_slope || (slope == best_slope && q->x < c->corners[best].x)) {
                best_slope = slope;
                best = i;
            }
        }
        i = q->next;
    } while (i != outer);
    return best;
}

/// Cuts the polygon open from corner `outer` to corner `inner` of a hole: both are there twice
/// then.
static void build_bridge(cut *c, uint32_t outer, uint32_t inner)
{
    const uint32_t outer_next = c->corners[outer].next, inner_last = c->corners[inner].previous;
    const uint32_t inner_copy = add_corner(c, c->corners[inner].point);
    const uint32_t outer_copy = add_corner(c, c->corners[outer].point);
    link_corners(c, outer, inner);
    link_corners(c, inner_last, inner_copy);
    link_corners(c, inner_copy, outer_copy);
    link_corners(c, outer_copy, outer_next);
}

/// Joins all holes to the outline, those furthest to the right first.
static alp_result join_holes(cut *c, uint32_t outer)
{
    const alpi_ear_polygon *polygon = c->polygon;
    const uint32_t holes = polygon->ring_count - 1;
    if ((uint64_t)holes * (corner_count(polygon) + 2 * holes) > BRIDGE_LIMIT ||
        (uint64_t)holes * holes > BRIDGE_LIMIT) {
        return alpi_fail(c->cutter->context, ALP_ERROR_LIMIT,
                         "a polygon has %u holes and %u corners: too many to be joined; cut it "
                         "into triangles before",
                         holes, corner_count(polygon));
    }
    uint32_t *right = ALPI_NEW(c->cutter->context, uint32_t, holes); // their rightmost corners
    if (right == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t h = 0; h < holes; h++) {
        const uint32_t first = add_ring(c, polygon->ring_ends[h], polygon->ring_ends[h + 1], true);
        const uint32_t found = rightmost(c, first);
        uint32_t k = h; // sorted in as they come
        for (; k > 0 && c->corners[right[k - 1]].x < c->corners[found].x; k--) {
            right[k] = right[k - 1];
        }
        right[k] = found;
    }
    for (uint32_t h = 0; h < holes; h++) {
        build_bridge(c, visible_corner(c, outer, &c->corners[right[h]]), right[h]);
    }
    alpi_release(c->cutter->context, right);
    return ALP_OK;
}

// --- the grid of reflex corners ------------------------------------------------------------------

static uint32_t cell_of(const cut *c, double value, int axis)
{
    const double cell = (value - c->low[axis]) / c->step[axis];
    return cell >= c->side ? c->side - 1 : cell > 0.0 ? (uint32_t)cell : 0;
}

static void measure_grid(cut *c, uint32_t reflex_count)
{
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    c->low[0] = c->low[1] = HUGE_VAL;
    for (uint32_t i = 0; i < c->count; i++) {
        const double at[2] = {c->corners[i].x, c->corners[i].y};
        for (int k = 0; k < 2; k++) {
            c->low[k] = fmin(c->low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    c->side = (uint32_t)sqrt((double)reflex_count) + 1;
    for (int k = 0; k < 2; k++) {
        c->step[k] = fmax((high[k] - c->low[k]) / c->side, 1e-300);
    }
}

static alp_result make_room(alp_context *context, uint32_t **items, size_t *capacity, size_t count)
{
    void *grown = *items;
    alp_result result = alpi_grow(context, &grown, capacity, count, sizeof **items);
    *items = grown;
    return result;
}

/// Counting sort of the reflex corners into cells.
static alp_result fill_grid(cut *c)
{
    alpi_ear_cutter *cutter = c->cutter;
    uint32_t reflex_count = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        corner *at = &c->corners[i];
        at->reflex = turn(&c->corners[at->previous], at, &c->corners[at->next]) <= 0.0;
        reflex_count += at->reflex;
    }
    measure_grid(c, reflex_count);
    const size_t cell_count = (size_t)c->side * c->side;
    ALP_TRY(make_room(cutter->context, &cutter->cells, &cutter->cell_capacity, cell_count + 2));
    ALP_TRY(make_room(cutter->context, &cutter->members, &cutter->member_capacity, reflex_count));
    memset(cutter->cells, 0, (cell_count + 2) * sizeof *cutter->cells);
    uint32_t *starts = cutter->cells + 1; // starts[cell + 1] counts, then is the end of cell
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < c->count; i++) {
            const corner *at = &c->corners[i];
            if (at->reflex) {
                const size_t cell = (size_t)cell_of(c, at->y, 1) * c->side + cell_of(c, at->x, 0);
                if (pass == 0) {
                    starts[cell]++;
                } else {
                    cutter->members[cutter->cells[cell + 1]++] = i;
                }
            }
        }
        uint32_t sum = 0; // counts → begins; in the second pass begins have become ends
        for (size_t cell = 0; pass == 0 && cell <= cell_count; cell++) {
            const uint32_t size = starts[cell];
            starts[cell] = sum;
            sum += size;
        }
    }
    return ALP_OK; // cell's members: cells[cell] … cells[cell + 1]
}

// --- ears ----------------------------------------------------------------------------------------

/// Whether the edge of the ring at p, which coincides with corner `b` of the triangle, leads into
/// it.
static bool leads_inside(const corner *a, const corner *b, const corner *c, const corner *towards)
{
    return turn(a, b, towards) > 0.0 && turn(b, c, towards) > 0.0;
}

/// Whether reflex corner `i` makes the triangle of corners t[0], t[1], t[2] no ear.
static bool blocks(const cut *c, uint32_t i, const uint32_t t[3])
{
    const corner *p = &c->corners[i];
    if (p->gone || !p->reflex || i == t[0] || i == t[1] || i == t[2]) {
        return false;
    }
    const corner *k[3] = {&c->corners[t[0]], &c->corners[t[1]], &c->corners[t[2]]};
    for (int n = 0; n < 3; n++) {
        const corner *before = k[(n + 2) % 3], *at = k[n], *after = k[(n + 1) % 3];
        if (p->x == at->x && p->y == at->y) {
            return leads_inside(before, at, after, &c->corners[p->next]) ||
                   leads_inside(before, at, after, &c->corners[p->previous]);
        }
    }
    return in_triangle(k[0], k[1], k[2], p);
}

static bool is_ear(cut *c, uint32_t tip)
{
    const corner *at = &c->corners[tip];
    const uint32_t t[3] = {at->previous, tip, at->next};
    const corner *k[3] = {&c->corners[t[0]], at, &c->corners[t[2]]};
    if (turn(k[0], k[1], k[2]) <= 0.0) {
        return false;
    }
    const uint32_t x0 = cell_of(c, fmin(fmin(k[0]->x, k[1]->x), k[2]->x), 0);
    const uint32_t x1 = cell_of(c, fmax(fmax(k[0]->x, k[1]->x), k[2]->x), 0);
    const uint32_t y0 = cell_of(c, fmin(fmin(k[0]->y, k[1]->y), k[2]->y), 1);
    const uint32_t y1 = cell_of(c, fmax(fmax(k[0]->y, k[1]->y), k[2]->y), 1);
    for (uint32_t y = y0; y <= y1; y++) {
        const uint32_t *cells = c->cutter->cells + (size_t)y * c->side;
        for (uint32_t m = cells[x0]; m < cells[x1 + 1]; m++) { // a row of cells is one range
            if (blocks(c, c->cutter->members[m], t)) {
                return false;
            }
        }
        const uint64_t looked = 1 + cells[x1 + 1] - cells[x0];
        c->work = c->work > looked ? c->work - looked : 0;
    }
    return true;
}

static void push(cut *c, uint32_t i)
{
    if (!c->corners[i].queued && !c->corners[i].gone) {
        c->corners[i].queued = true;
        c->cutter->queue[c->tail] = i;
        c->tail = c->tail == c->count ? 0 : c->tail + 1;
    }
}

static uint32_t pop(cut *c)
{
    const uint32_t i = c->cutter->queue[c->head];
    c->head = c->head == c->count ? 0 : c->head + 1;
    c->corners[i].queued = false;
    return i;
}

/// Cuts off the triangle at `tip`; its neighbours may be ears now.
static void clip(cut *c, uint32_t tip)
{
    corner *at = &c->corners[tip];
    uint32_t *triangle = c->triangles[c->triangle_count++];
    triangle[0] = c->corners[at->previous].point;
    triangle[1] = at->point;
    triangle[2] = c->corners[at->next].point;
    at->gone = true;
    c->left--;
    link_corners(c, at->previous, at->next);
    const uint32_t beside[2] = {at->previous, at->next};
    for (int k = 0; k < 2; k++) {
        corner *b = &c->corners[beside[k]];
        b->reflex = b->reflex && turn(&c->corners[b->previous], b, &c->corners[b->next]) <= 0.0;
        push(c, beside[k]);
    }
}

/// What is cut where no proper ear is left: first corners on a line, then the widest angle there
/// is. Looking for them is O(n), so the budget of looks pays for it.
static uint32_t choose_without_ear(cut *c, uint32_t from)
{
    uint32_t i = from, best = from;
    double best_turn = -HUGE_VAL;
    do {
        const corner *at = &c->corners[i];
        const double area = turn(&c->corners[at->previous], at, &c->corners[at->next]);
        if (area == 0.0 || c->work == 0) {
            return i;
        }
        if (area > best_turn) {
            best_turn = area;
            best = i;
        }
        c->work--;
        i = at->next;
    } while (i != from);
    c->tidy = false;
    return best;
}

static void clip_all(cut *c, uint32_t start)
{
    uint32_t at = start;
    for (uint32_t i = c->corners[start].next; i != start; i = c->corners[i].next) {
        push(c, i);
    }
    push(c, start);
    while (c->left > 3) {
        uint32_t tip = NONE;
        while (tip == NONE && c->head != c->tail) {
            const uint32_t i = pop(c);
            tip = !c->corners[i].gone && (c->work == 0 || is_ear(c, i)) ? i : NONE;
        }
        if (tip == NONE) {
            tip = choose_without_ear(c, at);
        }
        c->tidy &= c->work > 0;
        at = c->corners[tip].next;
        clip(c, tip);
    }
    at = c->corners[at].gone ? c->corners[at].next : at;
    const corner *last = &c->corners[at];
    uint32_t *triangle = c->triangles[c->triangle_count++];
    triangle[0] = c->corners[last->previous].point;
    triangle[1] = last->point;
    triangle[2] = c->corners[last->next].point;
}

// --- all together --------------------------------------------------------------------------------

/// Without reflex corners, or without an area: a fan.
static void cut_fan(cut *c)
{
    const uint32_t count = c->polygon->ring_ends[0];
    for (uint32_t i = 1; i + 1 < count; i++) {
        uint32_t *triangle = c->triangles[c->triangle_count++];
        triangle[0] = 0;
        triangle[1] = i;
        triangle[2] = i + 1;
    }
}

/// Four corners need no grid: the diagonal that leaves two triangles turning the same way.
static bool cut_quad(cut *c)
{
    if (c->polygon->ring_count != 1 || c->polygon->ring_ends[0] != 4) {
        return false;
    }
    corner k[4];
    corner *kept = c->corners;
    c->corners = k;
    for (uint32_t i = 0; i < 4; i++) {
        add_corner(c, i);
    }
    c->corners = kept;
    c->count = 0;
    const double from_0 = fmin(turn(&k[0], &k[1], &k[2]), turn(&k[0], &k[2], &k[3]));
    const double from_1 = fmin(turn(&k[1], &k[2], &k[3]), turn(&k[1], &k[3], &k[0]));
    const uint32_t first = from_0 < 0.0 && from_1 > from_0 ? 1 : 0;
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t *triangle = c->triangles[c->triangle_count++];
        triangle[0] = first;
        triangle[1] = (first + 1 + i) % 4;
        triangle[2] = (first + 2 + i) % 4;
    }
    c->tidy = fmax(from_0, from_1) >= 0.0;
    return true;
}

static alp_result make_corners(cut *c)
{
    alpi_ear_cutter *cutter = c->cutter;
    const size_t most = (size_t)corner_count(c->polygon) + 2 * (size_t)c->polygon->ring_count;
    void *corners = cutter->corners;
    alp_result result =
        alpi_grow(cutter->context, &corners, &cutter->corner_capacity, most, sizeof(corner));
    cutter->corners = c->corners = corners;
    ALP_TRY(result);
    ALP_TRY(make_room(cutter->context, &cutter->queue, &cutter->queue_capacity, most + 1));
    const uint32_t outer = add_ring(c, 0, c->polygon->ring_ends[0], false);
    return c->polygon->ring_count > 1 ? join_holes(c, outer) : ALP_OK;
}

alp_result alpi_ear_triangulate(alpi_ear_cutter *cutter, const alpi_ear_polygon *polygon,
                                uint32_t (*triangles)[3], bool *tidy)
{
    cut c = {.cutter = cutter, .polygon = polygon, .triangles = triangles, .tidy = true};
    choose_plane(&c);
    if (corner_count(polygon) == 3) {
        cut_fan(&c);
    } else if (!cut_quad(&c)) {
        ALP_TRY(make_corners(&c));
        c.left = c.count;
        c.work = 2000 * (uint64_t)c.count + 1000000;
        ALP_TRY(fill_grid(&c));
        bool convex = polygon->ring_count == 1;
        for (uint32_t i = 0; convex && i < c.count; i++) {
            convex = !c.corners[i].reflex;
        }
        if (convex) {
            cut_fan(&c);
        } else {
            clip_all(&c, 0);
        }
    }
    *tidy = c.tidy;
    return ALP_OK;
}
