// SPDX-License-Identifier: MIT
// Stretch, density spread and flipped triangles of an atlas.
// Based on: P. V. Sander, J. Snyder, S. J. Gortler, H. Hoppe. Texture Mapping Progressive Meshes.
// SIGGRAPH 2001.
#include "atlas/stretch.h"

#include "atlas/factors.h"

#include "base/angle.h"
#include "base/memory.h"

#include <math.h>

static const double SLIVER_HEIGHT = 1.0 / 64.0; // texels at the density that is asked for

// Percentiles are found by counting areas into these: a bin is 0.07 % wide, and densities further
// than 2³² from the mean lie in the last ones.
enum { BINS_PER_OCTAVE = 1024, OCTAVES = 64, BIN_COUNT = BINS_PER_OCTAVE * OCTAVES };

typedef struct measured {
    double area, page_area; // m², texels², the latter signed
    double edge, page_edge; // the longest ones
    double stretch;         // metres per texel
} measured;

/// The squared lengths of the map's two derivatives, summed: Γ² + γ², times the squared area that
/// the edges u and v of the map span.
static double derivative_square(const double e[3], const double f[3], const double u[2],
                                const double v[2])
{
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double along = e[i] * v[1] - f[i] * u[1], across = f[i] * u[0] - e[i] * v[0];
        sum += along * along + across * across;
    }
    return sum;
}

double alpi_stretch_of(const vec3 surface[3], const double map[3][2])
{
    const double e[3] = {(double)surface[1].x - (double)surface[0].x,
                         (double)surface[1].y - (double)surface[0].y,
                         (double)surface[1].z - (double)surface[0].z};
    const double f[3] = {(double)surface[2].x - (double)surface[0].x,
                         (double)surface[2].y - (double)surface[0].y,
                         (double)surface[2].z - (double)surface[0].z};
    const double u[2] = {map[1][0] - map[0][0], map[1][1] - map[0][1]};
    const double v[2] = {map[2][0] - map[0][0], map[2][1] - map[0][1]};
    const double span = fabs(u[0] * v[1] - u[1] * v[0]);
    return span > 0.0 ? sqrt(0.5 * derivative_square(e, f, u, v)) / span : HUGE_VAL;
}

// --- triangles -----------------------------------------------------------------------------------

static bool is_measured(const alp_atlas *atlas, uint32_t triangle)
{
    return atlas->scene->triangle_usable[triangle] && atlas->triangle_pages[triangle] != ALPI_NONE;
}

static double longest_edge(const vec3 c[3])
{
    double longest = 0.0;
    for (int k = 0; k < 3; k++) {
        const vec3 a = c[k], b = c[(k + 1) % 3];
        const double x = (double)b.x - (double)a.x, y = (double)b.y - (double)a.y,
                     z = (double)b.z - (double)a.z;
        longest = fmax(longest, x * x + y * y + z * z);
    }
    return sqrt(longest);
}

static double longest_page_edge(const double p[3][2])
{
    double longest = 0.0;
    for (int k = 0; k < 3; k++) {
        const double *a = p[k], *b = p[(k + 1) % 3];
        longest = fmax(longest, alpi_length2(b[0] - a[0], b[1] - a[1]));
    }
    return longest;
}

static measured measure_triangle(const alp_atlas *atlas, uint32_t triangle)
{
    const double size[2] = {atlas->info.width, atlas->info.height};
    double p[3][2];
    vec3 c[3];
    for (int k = 0; k < 6; k++) {
        p[k / 2][k % 2] = (double)atlas->corner_uvs[triangle][k / 2][k % 2] * size[k % 2];
    }
    alpi_triangle_corners(atlas->scene, triangle, c);
    return (measured){.area = vec3_triangle_area(c[0], c[1], c[2]),
                      .page_area = 0.5 * ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                                          (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])),
                      .edge = longest_edge(c),
                      .page_edge = longest_page_edge((const double(*)[2])p),
                      .stretch = alpi_stretch_of(c, (const double(*)[2])p)};
}

static bool is_sliver(const measured *m, double texels_per_metre)
{
    return !(2.0 * m->area * texels_per_metre >= SLIVER_HEIGHT * m->edge);
}

bool alpi_stretch_is_sliver(const alp_atlas *atlas, uint32_t triangle, double base)
{
    const measured m = measure_triangle(atlas, triangle);
    return is_sliver(&m, base * alpi_factor_of(atlas, triangle));
}

/// A sliver may be turned over by its coordinates' rounding, which moves a corner in [½, 1) by half
/// of 2⁻²⁴ of the page, on both axes.
static bool is_flipped(const alp_atlas *atlas, const measured *m, bool sliver)
{
    const double size = fmax((double)atlas->info.width, (double)atlas->info.height);
    return sliver ? m->page_area < -0x1p-24 * size * m->page_edge : !(m->page_area > 0.0);
}

// --- all of them ---------------------------------------------------------------------------------

/// What a triangle counts in figures that are compared with what was asked for: the area that it
/// takes at the density of factor 1. Weighed so, no map has a mean stretch below 1.
static double wanted_area(const measured *m, double factor)
{
    return factor * factor * m->area;
}

/// @param wanted out: the area of all that is measured, at the density of factor 1; m²
static void find_density(const alp_atlas *atlas, alpi_stretch_facts *facts, double *wanted)
{
    double page_area = 0.0, area = 0.0;
    *wanted = 0.0;
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        if (is_measured(atlas, t)) {
            const measured m = measure_triangle(atlas, t);
            page_area += fabs(m.page_area);
            area += m.area;
            *wanted += wanted_area(&m, alpi_factor_of(atlas, t));
        }
    }
    facts->texels_per_metre = area > 0.0 ? sqrt(page_area / area) : 0.0;
    facts->base = *wanted > 0.0 ? sqrt(page_area / *wanted) : 0.0;
}

/// The bin of a density, relative to what is asked for.
static uint32_t bin_of(double density)
{
    const double bin = floor(BINS_PER_OCTAVE * (log2(density) + 0.5 * OCTAVES));
    return bin >= 0.0 ? (uint32_t)fmin(bin, BIN_COUNT - 1.0) : 0; // of nothing: 0
}

/// The bin that the share of the area ends in.
static uint32_t percentile(const double *bins, double area, double share)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < BIN_COUNT; i++) {
        sum += bins[i];
        if (sum >= share * area) {
            return i;
        }
    }
    return BIN_COUNT - 1;
}

static void find_spread(const double *bins, double area, alpi_stretch_facts *facts)
{
    const uint32_t low = percentile(bins, area, 0.01), high = percentile(bins, area, 0.99);
    facts->spread = exp2((double)(high > low ? high - low : 0) / BINS_PER_OCTAVE);
}

static void find_stretch(const alp_atlas *atlas, double *bins, alpi_stretch_facts *facts)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        if (!is_measured(atlas, t)) {
            continue;
        }
        const measured m = measure_triangle(atlas, t);
        const double factor = alpi_factor_of(atlas, t), density = facts->base * factor;
        const double weight = wanted_area(&m, factor);
        const bool sliver = is_sliver(&m, density);
        bins[bin_of(sqrt(fabs(m.page_area) / m.area) / density)] += weight;
        if (is_flipped(atlas, &m, sliver)) {
            facts->first_flipped = facts->flipped++ == 0 ? t : facts->first_flipped;
        }
        if (sliver) {
            facts->slivers++;
            continue;
        }
        const double stretch = m.stretch * density;
        sum += stretch * stretch * weight;
        area += weight;
        if (stretch > facts->worst) {
            facts->worst = stretch;
            facts->worst_triangle = t;
        }
    }
    facts->mean = area > 0.0 ? sqrt(sum / area) : 1.0;
    facts->worst = area > 0.0 ? facts->worst : 1.0; // of slivers alone: nothing is stretched
}

alp_result alpi_stretch_measure(const alp_atlas *atlas, alpi_stretch_facts *facts)
{
    double wanted;
    *facts = (alpi_stretch_facts){.worst_triangle = ALPI_NONE, .first_flipped = ALPI_NONE};
    find_density(atlas, facts, &wanted);
    double *bins = ALPI_NEW(atlas->context, double, BIN_COUNT);
    if (bins == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    find_stretch(atlas, bins, facts);
    find_spread(bins, wanted, facts);
    alpi_release(atlas->context, bins);
    return ALP_OK;
}
