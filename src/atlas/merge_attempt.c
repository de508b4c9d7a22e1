// SPDX-License-Identifier: MIT
// Two charts that meet, unwrapped as one: laid side by side along what they share, then unfolded,
// and judged.
#include "atlas/box.h"
#include "atlas/merge.h"

#include "base/angle.h"
#include "base/memory.h"

// The bound of the whole atlas is 2: charts keep a distance, since coordinates are rounded to
// floats, and pages draw the least charts larger than they are.
static const double WORST_STRETCH = 1.75;
// Root mean square over a chart: half a sphere has 1.08 when laid out conformally.
static const double MEAN_STRETCH = 1.12;
// Beyond this after the first steps, further ones never were enough.
static const double HOPELESS_STRETCH = 1.5;
enum { FIRST_STEPS = 3, MORE_STEPS = 8 };

/// Sums over the corners that two charts share, of where they lie in the one and in the other.
typedef struct alignment {
    double count, from[2], to[2], dot, cross;
} alignment;

static void add_corner(alignment *a, const double from[2], const double to[2])
{
    a->count += 1.0;
    for (int k = 0; k < 2; k++) {
        a->from[k] += from[k];
        a->to[k] += to[k];
    }
    a->dot += from[0] * to[0] + from[1] * to[1];
    a->cross += from[0] * to[1] - from[1] * to[0];
}

/// Lays the vertices of the first chart where it has them, and those of the second where it has
/// them, turned and moved so that what both have comes to lie as near as can be.
static void lay_side_by_side(const alp_atlas *atlas, const alpi_patch_source *source,
                             uint32_t first_count, bool *laid, alpi_patch *patch)
{
    alignment sums = {0};
    for (uint32_t i = 0; i < 3 * source->count; i++) {
        const float *uv = atlas->corner_uvs[source->triangles[i / 3]][i % 3];
        const double at[2] = {(double)uv[0], (double)uv[1]};
        const uint32_t v = patch->vertices[i / 3][i % 3];
        if (i < 3 * first_count) {
            laid[v] = true;
            patch->at[v][0] = at[0];
            patch->at[v][1] = at[1];
        } else if (laid[v]) {
            add_corner(&sums, at, patch->at[v]);
        }
    }
    const double n = fmax(sums.count, 1.0);
    const double dot = sums.dot - (sums.from[0] * sums.to[0] + sums.from[1] * sums.to[1]) / n;
    const double cross = sums.cross - (sums.from[0] * sums.to[1] - sums.from[1] * sums.to[0]) / n;
    const double length = alpi_length2(dot, cross);
    const double c = length > 0.0 ? dot / length : 1.0, s = length > 0.0 ? cross / length : 0.0;
    for (uint32_t i = 3 * first_count; i < 3 * source->count; i++) {
        const float *uv = atlas->corner_uvs[source->triangles[i / 3]][i % 3];
        const double x = (double)uv[0] - sums.from[0] / n, y = (double)uv[1] - sums.from[1] / n;
        const uint32_t v = patch->vertices[i / 3][i % 3];
        if (!laid[v]) {
            patch->at[v][0] = c * x - s * y + sums.to[0] / n;
            patch->at[v][1] = s * x + c * y + sums.to[1] / n;
        }
    }
}

static bool is_good(const alpi_stretch *stretch)
{
    return !stretch->flipped && stretch->worst <= WORST_STRETCH && stretch->mean <= MEAN_STRETCH;
}

/// A number as a float has it. The compiler must go by memory: gcc 12 is known to leave out such
/// ways there and back (regions.c), and what it lays out must not hang on that.
static double round_to_float(double number)
{
    volatile const float stored = (float)number;
    return (double)stored;
}

/// Whether no triangle is flipped once coordinates are floats.
static bool stays_upright(const alpi_patch *patch)
{
    for (uint32_t i = 0; i < patch->count; i++) {
        double p[3][2];
        for (int k = 0; k < 6; k++) {
            p[k / 2][k % 2] = round_to_float(patch->at[patch->vertices[i][k / 2]][k % 2]);
        }
        const double ax = p[1][0] - p[0][0], ay = p[1][1] - p[0][1];
        const double bx = p[2][0] - p[0][0], by = p[2][1] - p[0][1];
        if (!(ax * by - ay * bx > 0.0)) {
            return false;
        }
    }
    return true;
}

/// Whether the chart's tightest box is small enough.
static alp_result fits_box(const alpi_patch *patch, alpi_merge *merge, bool *fits)
{
    alp_context *context = patch->context;
    alpi_point *points = ALPI_NEW(context, alpi_point, patch->vertex_count);
    alpi_point *hull = ALPI_NEW(context, alpi_point, 2 * (size_t)patch->vertex_count + 2);
    const bool made = points != NULL && hull != NULL;
    if (made) {
        double area = 0.0;
        for (uint32_t v = 0; v < patch->vertex_count; v++) {
            points[v] = (alpi_point){patch->at[v][0], patch->at[v][1]};
        }
        for (uint32_t i = 0; i < patch->count; i++) {
            area += 0.5 * patch->flat[i][0] * patch->flat[i][2];
        }
        const alpi_box box = alpi_tightest_box(points, patch->vertex_count, hull);
        merge->width = box.width;
        merge->height = box.height;
        *fits = (box.width + merge->margin) * (box.height + merge->margin) <= merge->room &&
                area >= merge->fill * box.width * box.height;
    }
    alpi_release(context, points);
    alpi_release(context, hull);
    return made ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

/// Lays the patch of both charts, and says in merge->merges whether it is good.
static alp_result unwrap(const alp_atlas *atlas, alpi_merge *merge, alpi_patch *patch)
{
    ALP_TRY(alpi_patch_create(atlas->context, &merge->source, patch));
    bool *laid = ALPI_NEW(atlas->context, bool, patch->vertex_count);
    if (laid == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    lay_side_by_side(atlas, &merge->source, merge->first_count, laid, patch);
    alpi_release(atlas->context, laid);
    ALP_TRY(alpi_patch_unfold(patch, FIRST_STEPS));
    alpi_stretch stretch = alpi_patch_stretch(patch);
    if (!is_good(&stretch) && (stretch.flipped || stretch.mean < HOPELESS_STRETCH)) {
        ALP_TRY(alpi_patch_unfold(patch, MORE_STEPS));
        stretch = alpi_patch_stretch(patch);
    }
    bool good = is_good(&stretch) && stays_upright(patch), overlaps = false;
    if (good) {
        ALP_TRY(fits_box(patch, merge, &good));
    }
    if (good) {
        ALP_TRY(alpi_patch_overlaps(patch, &overlaps));
    }
    merge->merges = good && !overlaps;
    return ALP_OK;
}

alp_result alpi_merge_attempt(alp_atlas *atlas, alpi_merge *merge)
{
    alpi_patch patch = {.context = atlas->context};
    const alpi_patch_source *source = &merge->source;
    merge->merges = false;
    const alp_result result = unwrap(atlas, merge, &patch);
    for (uint32_t i = 0; result == ALP_OK && merge->merges && i < 3 * source->count; i++) {
        const double *at = patch.at[patch.vertices[i / 3][i % 3]];
        float *uv = atlas->corner_uvs[source->triangles[i / 3]][i % 3];
        uv[0] = (float)at[0];
        uv[1] = (float)at[1];
    }
    alpi_patch_destroy(&patch);
    return result;
}
