// SPDX-License-Identifier: MIT
// Solids with curves: turned, swept, arched, uneven.
#include "scene/builtin/shapes.h"

#include "base/random.h"

#include <math.h>

// --- profiles ------------------------------------------------------------------------------------

/// A piece of a profile from p to q, cut into `count`.
typedef struct piece {
    alpi_profile_point p, q;
    uint32_t count;
} piece;

/// Cells: one where a piece is straight, more where it is bent more or is long (0.8 m).
static piece make_piece(const alpi_shaper *shaper, const alpi_profile_point *p,
                        const alpi_profile_point *q)
{
    double length = hypot((double)(q->out - p->out), (double)(q->up - p->up));
    uint32_t along = alpi_shaper_cells(shaper, length, 0.8);
    double bend = fabs((double)p->bulge);
    uint32_t bent = alpi_shaper_divide(shaper, 1.0 + 6.0 * bend, 1);
    return (piece){*p, *q, !(bend > 0.0) ? 1 : along > bent ? along : bent};
}

/// Point j of a piece, a parabola, and its normal to the right of the way: (out, up).
static void piece_at(const piece *s, uint32_t j, double point[2], double normal[2])
{
    double across = (double)s->q.out - (double)s->p.out, up = (double)s->q.up - (double)s->p.up;
    double t = (double)j / s->count, bulge = (double)s->p.bulge;
    double away = 4.0 * t * (1.0 - t) * bulge, slope = 4.0 * (1.0 - 2.0 * t) * bulge;
    point[0] = (double)s->p.out + t * across + away * up;
    point[1] = (double)s->p.up + t * up - away * across;
    if (j == s->count) { // to the bit where the next piece begins
        point[0] = (double)s->q.out;
        point[1] = (double)s->q.up;
    }
    double along[2] = {across + slope * up, up - slope * across};
    double length = hypot(along[0], along[1]);
    normal[0] = along[1] / length;
    normal[1] = -along[0] / length;
}

// --- turned --------------------------------------------------------------------------------------

typedef struct turning {
    piece part;
    uint32_t slices;
} turning;

static void turned_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const turning *t = shape;
    double c, s, point[2], n[2];
    alpi_builder_turn(i, t->slices, &c, &s);
    piece_at(&t->part, j, point, n);
    // −z first: around the axis × up looks away from it
    *position = (vec3){(float)(point[0] * c), (float)point[1], (float)(-point[0] * s)};
    *normal = (vec3){(float)(n[0] * c), (float)n[1], (float)(-n[0] * s)};
}

void alpi_shape_turned(alpi_shaper *shaper, const alpi_profile_point *points, uint32_t count,
                       double slices)
{
    turning t = {.slices = alpi_shaper_divide(shaper, slices, 4)};
    for (uint32_t k = 0; k + 1 < count; k++) {
        t.part = make_piece(shaper, &points[k], &points[k + 1]);
        alpi_shape_patch(shaper, &(alpi_patch){.u_count = t.slices,
                                               .v_count = t.part.count,
                                               .closed = true,
                                               .low_point = points[k].out <= 0.0f,
                                               .high_point = points[k + 1].out <= 0.0f,
                                               .at = turned_at,
                                               .shape = &t});
    }
}

// --- swept ---------------------------------------------------------------------------------------

typedef struct cornice {
    piece part;
    float half_x, half_z;
    int side; // 0 = +z, then on towards +x
    uint32_t cells;
} cornice;

static void cornice_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const cornice *c = shape;
    double point[2], n[2];
    piece_at(&c->part, j, point, n);
    bool turned = c->side % 2 == 1;
    float length = (float)((double)(turned ? c->half_z : c->half_x) - point[0]);
    float depth = (float)((double)(turned ? c->half_x : c->half_z) - point[0]);
    // From +x to −x on the side at +z, which looks towards −z.
    float x = i == 0          ? length
              : i == c->cells ? -length
                              : length * (1.0f - 2.0f * (float)i / (float)c->cells);
    vec3 p = {x, (float)point[1], depth}, m = {0.0f, (float)n[1], (float)-n[0]};
    for (int k = 0; k < c->side; k++) { // quarter turns: +z to +x
        p = (vec3){p.z, p.y, -p.x};
        m = (vec3){m.z, m.y, -m.x};
    }
    *position = p;
    *normal = m;
}

void alpi_shape_cornice(alpi_shaper *shaper, const alpi_profile_point *section, uint32_t count,
                        float half_x, float half_z)
{
    cornice c = {.half_x = half_x, .half_z = half_z};
    for (uint32_t k = 0; k < count; k++) {
        c.part = make_piece(shaper, &section[k], &section[(k + 1) % count]);
        for (c.side = 0; c.side < 4; c.side++) {
            float length = 2.0f * (c.side % 2 == 1 ? half_z : half_x);
            c.cells = alpi_shaper_cells(shaper, (double)length, 3.0);
            alpi_shape_patch(shaper, &(alpi_patch){.u_count = c.cells,
                                                   .v_count = c.part.count,
                                                   .at = cornice_at,
                                                   .shape = &c});
        }
    }
}

/// (cos, sin) of π i/n, exact at both ends and the crown.
static void half_turn(uint32_t i, uint32_t n, double *cosine, double *sine)
{
    alpi_builder_turn(i, 2 * n, cosine, sine);
}

static uint32_t arch_cells(const alpi_shaper *shaper)
{
    return alpi_shaper_divide(shaper, 14.0, 5);
}

typedef struct archivolt {
    piece part;
    float x, y;
    uint32_t cells;
} archivolt;

static vec3 archivolt_point(const archivolt *a, uint32_t i, const double point[2])
{
    double c, s;
    half_turn(i, a->cells, &c, &s);
    return (vec3){(float)((double)a->x + point[0] * c), (float)((double)a->y + point[0] * s),
                  (float)point[1]};
}

static void archivolt_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const archivolt *a = shape;
    double c, s, point[2], n[2];
    half_turn(i, a->cells, &c, &s);
    piece_at(&a->part, j, point, n);
    *position = archivolt_point(a, i, point);
    *normal = (vec3){(float)(n[0] * c), (float)(n[0] * s), (float)n[1]};
}

/// The section itself, where the arch stands on something: a fan about a point an eighth of its
/// height above its lowest, which sees all of a section that is flat below, though it be hollow
/// above.
static void build_archivolt_end(alpi_shaper *shaper, archivolt *a,
                                const alpi_profile_point *section, uint32_t count, bool last)
{
    double middle[2] = {0.0, 0.0}, low = HUGE_VAL, high = -HUGE_VAL;
    for (uint32_t k = 0; k < count; k++) {
        middle[0] += (double)section[k].out / count;
        low = fmin(low, (double)section[k].up);
        high = fmax(high, (double)section[k].up);
    }
    middle[1] = low + (high - low) / 8.0;
    uint32_t i = last ? a->cells : 0;
    vec3 centre = archivolt_point(a, i, middle);
    for (uint32_t k = 0; k < count; k++) {
        a->part = make_piece(shaper, &section[k], &section[(k + 1) % count]);
        for (uint32_t j = 0; j < a->part.count; j++) {
            double here[2], next[2], normal[2];
            piece_at(&a->part, j, here, normal);
            piece_at(&a->part, j + 1, next, normal);
            vec3 p = archivolt_point(a, i, here), q = archivolt_point(a, i, next);
            alpi_shape_triangle(shaper, centre, last ? q : p, last ? p : q);
        }
    }
}

void alpi_shape_archivolt(alpi_shaper *shaper, const alpi_profile_point *section, uint32_t count,
                          float x, float y)
{
    archivolt a = {.x = x, .y = y, .cells = arch_cells(shaper)};
    for (uint32_t k = 0; k < count; k++) {
        a.part = make_piece(shaper, &section[k], &section[(k + 1) % count]);
        alpi_shape_patch(shaper, &(alpi_patch){.u_count = a.cells,
                                               .v_count = a.part.count,
                                               .at = archivolt_at,
                                               .shape = &a});
    }
    build_archivolt_end(shaper, &a, section, count, false);
    build_archivolt_end(shaper, &a, section, count, true);
}

// --- arched --------------------------------------------------------------------------------------

enum { ARCADE_FRONT, ARCADE_BACK, ARCADE_UNDER, ARCADE_TOP, ARCADE_SIDES };

/// A stretch of an arcade: over an arch, or the level part between two.
typedef struct stretch {
    const alpi_arcade *arcade;
    float from, to, centre;
    bool arch;
    int side;
    uint32_t cells, rows, layers; // along, up, through
} stretch;

/// The underside at cell line i: x, y and the outward normal there.
static void stretch_under(const stretch *s, uint32_t i, vec3 *point, vec3 *normal)
{
    float t = (float)i / (float)s->cells;
    *point =
        (vec3){i == s->cells ? s->to : s->from + (s->to - s->from) * t, s->arcade->spring, 0.0f};
    *normal = (vec3){0.0f, -1.0f, 0.0f};
    if (s->arch) {
        double c, sine;
        half_turn(i, s->cells, &c, &sine); // from +x; the wall goes from −x
        if (i > 0 && i < s->cells) {
            point->x = (float)((double)s->centre - (double)s->arcade->radius * c);
            point->y = (float)((double)s->arcade->spring + (double)s->arcade->radius * sine);
        }
        *normal = (vec3){(float)c, (float)-sine, 0.0f};
    }
}

static void stretch_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const stretch *s = shape;
    const alpi_arcade *a = s->arcade;
    bool backward = s->side == ARCADE_BACK || s->side == ARCADE_UNDER;
    vec3 under, outward;
    stretch_under(s, backward ? s->cells - i : i, &under, &outward);
    float half = 0.5f * a->thickness, through = (float)j / (float)s->layers;
    float high = (float)j / (float)s->rows, z = half - a->thickness * through;
    if (s->side == ARCADE_FRONT || s->side == ARCADE_BACK) {
        float y = j == s->rows ? a->top : under.y + (a->top - under.y) * high;
        *position = (vec3){under.x, y, backward ? -half : half};
        *normal = (vec3){0.0f, 0.0f, backward ? -1.0f : 1.0f};
    } else {
        bool top = s->side == ARCADE_TOP;
        *position = (vec3){under.x, top ? a->top : under.y, j == s->layers ? -half : z};
        *normal = top ? (vec3){0.0f, 1.0f, 0.0f} : outward;
    }
}

static void build_stretch(alpi_shaper *shaper, stretch s)
{
    if (!(s.to > s.from)) {
        return;
    }
    s.cells = s.arch ? arch_cells(shaper) : alpi_shaper_cells(shaper, (double)(s.to - s.from), 1.0);
    for (s.side = 0; s.side < ARCADE_SIDES; s.side++) {
        bool upright = s.side == ARCADE_FRONT || s.side == ARCADE_BACK;
        alpi_shape_patch(shaper, &(alpi_patch){.u_count = s.cells,
                                               .v_count = upright ? s.rows : s.layers,
                                               .at = stretch_at,
                                               .shape = &s});
    }
}

static void build_arcade_ends(alpi_shaper *shaper, const alpi_arcade *a, uint32_t rows,
                              uint32_t layers)
{
    float half = 0.5f * a->thickness;
    const vec3 low[4] = {{a->start, a->spring, -half},
                         {a->start, a->spring, half},
                         {a->start, a->top, half},
                         {a->start, a->top, -half}};
    const vec3 high[4] = {{a->end, a->spring, half},
                          {a->end, a->spring, -half},
                          {a->end, a->top, -half},
                          {a->end, a->top, half}};
    alpi_shape_panel(shaper, low, layers, rows);
    alpi_shape_panel(shaper, high, layers, rows);
}

void alpi_shape_arcade(alpi_shaper *shaper, const alpi_arcade *arcade)
{
    stretch s = {.arcade = arcade,
                 .to = arcade->start,
                 .rows = alpi_shaper_cells(shaper, (double)(arcade->top - arcade->spring), 1.5),
                 .layers = alpi_shaper_cells(shaper, (double)arcade->thickness, 0.5)};
    for (uint32_t k = 0; k < arcade->arch_count; k++) {
        float centre = arcade->first + (float)k * arcade->distance;
        s.from = s.to;
        s.to = centre - arcade->radius;
        s.arch = false;
        build_stretch(shaper, s);
        s.from = s.to;
        s.to = centre + arcade->radius;
        s.centre = centre;
        s.arch = true;
        build_stretch(shaper, s);
    }
    s.from = s.to;
    s.to = arcade->end;
    s.arch = false;
    build_stretch(shaper, s);
    build_arcade_ends(shaper, arcade, s.rows, s.layers);
}

// --- uneven --------------------------------------------------------------------------------------

enum { WAVE_COUNT = 6 };

typedef struct uneven {
    const alpi_blob *blob;
    uint32_t slices, stacks;
    double wave[WAVE_COUNT][3], phase[WAVE_COUNT];
} uneven;

/// r = R (1 + a Σ sin(k·d + φ)) in direction d; the normal of such a surface is along r d − ∇r,
/// ∇r the part of the gradient across d.
static void blob_at(const void *shape, uint32_t i, uint32_t j, vec3 *position, vec3 *normal)
{
    const uneven *u = shape;
    double c, s, up, ring;
    alpi_builder_turn(i, u->slices, &c, &s);
    half_turn(j, u->stacks, &up, &ring);
    const double d[3] = {ring * c, -up, -ring * s};
    double amplitude = (double)u->blob->roughness / sqrt((double)WAVE_COUNT);
    double r = 1.0, gradient[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < WAVE_COUNT; k++) {
        const double *w = u->wave[k];
        double angle = w[0] * d[0] + w[1] * d[1] + w[2] * d[2] + u->phase[k];
        r += amplitude * sin(angle);
        for (int axis = 0; axis < 3; axis++) {
            gradient[axis] += amplitude * cos(angle) * w[axis];
        }
    }
    double along = gradient[0] * d[0] + gradient[1] * d[1] + gradient[2] * d[2], n[3];
    for (int axis = 0; axis < 3; axis++) {
        n[axis] = r * d[axis] - (gradient[axis] - along * d[axis]);
    }
    double size = (double)u->blob->radius, stretch_up = (double)u->blob->height_scale;
    *position = (vec3){(float)(size * r * d[0]), (float)(size * stretch_up * r * d[1]),
                       (float)(size * r * d[2])};
    *normal = (vec3){(float)n[0], (float)(n[1] / stretch_up), (float)n[2]};
}

void alpi_shape_blob(alpi_shaper *shaper, const alpi_blob *blob)
{
    uneven u = {.blob = blob, .slices = alpi_shaper_divide(shaper, blob->slices, 6)};
    u.stacks = u.slices / 2 + 1;
    for (int k = 0; k < WAVE_COUNT; k++) {
        double numbers[4];
        for (int axis = 0; axis < 4; axis++) {
            uint32_t key = alpi_random_key(blob->key, (uint64_t)k, (uint32_t)axis);
            numbers[axis] = 2.0 * (double)alpi_unit_float(key) - 1.0;
        }
        for (int axis = 0; axis < 3; axis++) {
            u.wave[k][axis] = (2.0 + 0.5 * k) * numbers[axis];
        }
        u.phase[k] = ALPI_PI * numbers[3];
    }
    alpi_shape_patch(shaper, &(alpi_patch){.u_count = u.slices,
                                           .v_count = u.stacks,
                                           .closed = true,
                                           .low_point = true,
                                           .high_point = true,
                                           .at = blob_at,
                                           .shape = &u});
}

void alpi_shape_leaf(alpi_shaper *shaper, vec3 middle, vec3 along, vec3 across, float thickness)
{
    enum { RIM = 6 };
    static const float RIMS[RIM][2] = {{-1.0f, 0.0f}, {-0.35f, -1.0f}, {0.4f, -0.8f},
                                       {1.0f, 0.0f},  {0.4f, 0.8f},    {-0.35f, 1.0f}};
    if (shaper->counting) {
        shaper->triangle_count += 2 * RIM;
        return;
    }
    vec3 up = vec3_normalize_or(vec3_cross(along, across), (vec3){0.0f, 1.0f, 0.0f});
    vec3 above = vec3_mad(middle, 0.5f * thickness, up);
    vec3 below = vec3_mad(middle, -0.5f * thickness, up);
    for (int k = 0; k < RIM; k++) {
        const float *p = RIMS[k], *q = RIMS[(k + 1) % RIM];
        vec3 here = vec3_mad(vec3_mad(middle, p[0], along), p[1], across);
        vec3 next = vec3_mad(vec3_mad(middle, q[0], along), q[1], across);
        alpi_shape_triangle(shaper, above, here, next);
        alpi_shape_triangle(shaper, below, next, here);
    }
}
