// SPDX-License-Identifier: MIT
// Slivers thinner than the steps of a float: rounded to the page they may lie flat, turned over, or
// at a fraction of their width. They are given a width of some steps, each for itself: that is less
// than a thousandth of a texel.
#include "atlas/factors.h"

#include "base/angle.h"

#include <math.h>

// Steps of a float below 1; and the stretch, of the 2 that is stated, beyond which one is widened.
static const double FLOAT_STEP = 0x1p-24, WORST_STRETCH = 1.9;
enum { FIRST_STEPS = 3, TRY_LIMIT = 12 };

typedef struct sliver {
    double p[3][2];     // coordinates, pages
    double world, laid; // twice the area in the world, m², and on the page
    double flat[3];     // corners at (0, 0), (flat[0], 0), (flat[1], flat[2]), metres
} sliver;

static double load_page(const float (*uv)[2], double p[3][2])
{
    for (int k = 0; k < 6; k++) {
        p[k / 2][k % 2] = (double)uv[k / 2][k % 2];
    }
    return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
}

static void load_world(const alp_scene *scene, uint32_t triangle, sliver *s)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const double u[3] = {(double)c[1].x - (double)c[0].x, (double)c[1].y - (double)c[0].y,
                         (double)c[1].z - (double)c[0].z};
    const double v[3] = {(double)c[2].x - (double)c[0].x, (double)c[2].y - (double)c[0].y,
                         (double)c[2].z - (double)c[0].z};
    const double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    s->world = 2.0 * vec3_triangle_area(c[0], c[1], c[2]);
    s->flat[0] = length;
    s->flat[1] = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / length;
    s->flat[2] = s->world / length;
}

/// L2 stretch in metres per page; HUGE_VAL where the triangle is flat or turned over.
static double stretch_of(const sliver *s)
{
    if (!(s->laid > 0.0)) {
        return HUGE_VAL;
    }
    const double ax = s->p[1][0] - s->p[0][0], ay = s->p[1][1] - s->p[0][1];
    const double bx = s->p[2][0] - s->p[0][0], by = s->p[2][1] - s->p[0][1];
    const double xs = by * s->flat[0] - ay * s->flat[1], xt = ax * s->flat[1] - bx * s->flat[0];
    const double ys = -ay * s->flat[2], yt = ax * s->flat[2];
    return sqrt(0.5 * (xs * xs + xt * xt + ys * ys + yt * yt)) / s->laid;
}

/// Where the corners are to lie, about the middle of where they lie: with the triangle's true shape
/// turned along its longest side, but `width` high at least.
static void shape(const sliver *s, double density, double width, double to[3][2])
{
    const double flat[3][2] = {{0.0, 0.0}, {s->flat[0], 0.0}, {s->flat[1], s->flat[2]}};
    double longest = -1.0, along[2] = {1.0, 0.0};
    int at = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = flat[k], *b = flat[(k + 1) % 3];
        const double length = alpi_length2(b[0] - a[0], b[1] - a[1]);
        if (length > longest) {
            longest = length;
            at = k;
        }
    }
    const int next = (at + 1) % 3, apex = (at + 2) % 3;
    const double x = s->p[next][0] - s->p[at][0], y = s->p[next][1] - s->p[at][1];
    if (alpi_length2(x, y) > 0.0) {
        along[0] = x / alpi_length2(x, y);
        along[1] = y / alpi_length2(x, y);
    }
    const double base = fmax(density * longest, width);
    const double height = fmax(density * s->world / longest, width);
    const double ax = flat[apex][0] - flat[at][0], ay = flat[apex][1] - flat[at][1];
    const double bx = flat[next][0] - flat[at][0], by = flat[next][1] - flat[at][1];
    const double foot = base * (ax * bx + ay * by) / (longest * longest);
    const double corners[3][2] = {{0.0, 0.0}, {base, 0.0}, {foot, height}};
    for (int k = 0; k < 3; k++) { // corner at + k
        const double *c = corners[k], mx = (base + foot) / 3.0, my = height / 3.0;
        double *out = to[(at + k) % 3];
        out[0] = along[0] * (c[0] - mx) - along[1] * (c[1] - my);
        out[1] = along[1] * (c[0] - mx) + along[0] * (c[1] - my);
        for (int i = 0; i < 2; i++) {
            out[i] += (s->p[0][i] + s->p[1][i] + s->p[2][i]) / 3.0;
        }
    }
}

/// Moves a triangle into the page.
static void keep_inside(double p[3][2])
{
    for (int i = 0; i < 2; i++) {
        const double low = fmin(p[0][i], fmin(p[1][i], p[2][i]));
        const double high = fmax(p[0][i], fmax(p[1][i], p[2][i]));
        const double shift = low < 0.0 ? -low : high > 1.0 ? 1.0 - high : 0.0;
        for (int k = 0; k < 3; k++) {
            p[k][i] = fmin(fmax(p[k][i] + shift, 0.0), 1.0);
        }
    }
}

static void widen(const sliver *s, double density, float (*uv)[2])
{
    double width = FIRST_STEPS * FLOAT_STEP;
    for (int i = 0; i < TRY_LIMIT; i++, width *= 1.5) {
        double to[3][2];
        sliver wider = *s;
        shape(s, density, width, to);
        keep_inside(to);
        for (int k = 0; k < 6; k++) {
            uv[k / 2][k % 2] = (float)to[k / 2][k % 2];
        }
        wider.laid = load_page((const float(*)[2])uv, wider.p);
        if (density * stretch_of(&wider) <= WORST_STRETCH) {
            return;
        }
    }
}

void alpi_widen_slivers(alp_atlas *atlas)
{
    const alp_scene *scene = atlas->scene;
    double world = 0.0, laid = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        sliver s;
        if (scene->triangle_usable[t]) {
            load_world(scene, t, &s);
            const double factor = alpi_factor_of(atlas, t);
            laid += fmax(load_page((const float(*)[2])atlas->corner_uvs[t], s.p), 0.0);
            world += factor * factor * s.world;
        }
    }
    const double mean = world > 0.0 ? sqrt(laid / world) : 0.0; // pages per metre
    for (uint32_t t = 0; t < scene->triangle_count && mean > 0.0; t++) {
        sliver s;
        if (!scene->triangle_usable[t]) {
            continue;
        }
        const double density = mean * alpi_factor_of(atlas, t);
        load_world(scene, t, &s);
        s.laid = load_page((const float(*)[2])atlas->corner_uvs[t], s.p);
        const double thin = s.world * density / fmax(s.flat[0], alpi_length2(s.flat[1], s.flat[2]));
        if (density * stretch_of(&s) > WORST_STRETCH && thin < 64.0 * FLOAT_STEP) {
            widen(&s, density, atlas->corner_uvs[t]);
        }
    }
}
