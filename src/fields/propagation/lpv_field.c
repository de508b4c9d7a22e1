// SPDX-License-Identifier: MIT
// Reading a volume: intensities between cells, and the light of surfaces, mirrors and air.
#include "base/memory.h"
#include "fields/field.h"
#include "fields/propagation/lpv.h"

#include <math.h>
#include <string.h>

enum { GLOSS_STEPS = 4 };

/// Sum of intensities at a point, divided by 1.5 s²: radiance L(ω) = p0 + p·ω of light that
/// travels along ω. [channel][term]
typedef float light_terms[3][ALPI_LPV_TERMS];

typedef struct grid_place {
    const alpi_lpv_grid *grid;
    float weight;
} grid_place;

alpi_lpv_fades alpi_lpv_find_fades(const alp_lpv *lpv, double border)
{
    alpi_lpv_fades f = {.count = lpv->options.cascades};
    for (int k = 0; k < 3; k++) {
        f.half[k] = 0.5 * (double)lpv->options.size[k] - 1.0;
        f.slope[k] = 1.0 / (border * fmax(f.half[k], 0.5)); // of 1 or 2 cells no share is left
    }
    for (uint32_t c = 0; c < f.count; c++) {
        f.cells[c] = 1.0 / lpv->grids[c].cell;
        alpi_lpv_ideal_centre(lpv, c, f.centre[c]);
    }
    return f;
}

/// The grids that hold a point and their weights, the finest first; the coarsest takes the rest.
static uint32_t find_grids(const alp_lpv *lpv, const alpi_lpv_fades *fades, const double p[3],
                           grid_place places[ALPI_LPV_CASCADES_MOST])
{
    double left = 1.0;
    uint32_t count = 0;
    for (uint32_t c = 0; c < fades->count && left > 0.0; c++) {
        const bool last = c + 1 == fades->count;
        const double weight = last ? left : left * alpi_lpv_share(fades, c, p);
        if (weight > 0.0) {
            places[count++] = (grid_place){&lpv->grids[c], (float)weight};
        }
        left -= weight;
    }
    return count;
}

/// Adds `weight` × the trilinear mean of the cells round a point; beyond the grid its edge.
static void add_terms(const alpi_lpv_grid *g, const double p[3], float weight, light_terms terms)
{
    uint32_t low[3], step[3];
    float part[3];
    for (int k = 0; k < 3; k++) {
        const double last = (double)g->size[k] - 1.0;
        double at = p[k] / g->cell - (double)g->sum_corner[k] - 0.5;
        at = at > 0.0 ? (at < last ? at : last) : 0.0;
        low[k] = (uint32_t)at;
        part[k] = (float)(at - (double)low[k]);
        step[k] = low[k] + 1 < g->size[k];
    }
    const size_t n = g->size[0];
    weight *= (float)(1.0 / (ALP_LPV_GAIN * g->cell * g->cell));
    for (uint32_t c = 0; c < 8; c++) {
        float w = weight;
        uint32_t cell[3];
        for (uint32_t k = 0; k < 3; k++) {
            const bool upper = (c >> k & 1u) != 0;
            w *= upper ? part[k] : 1.0f - part[k];
            cell[k] = low[k] + (upper ? step[k] : 0u);
        }
        const float *rows = g->sum + ((size_t)cell[2] * g->size[1] + cell[1]) * ALPI_LPV_ROWS * n;
        for (size_t r = 0; r < ALPI_LPV_ROWS; r++) {
            terms[r / ALPI_LPV_TERMS][r % ALPI_LPV_TERMS] += w * rows[r * n + cell[0]];
        }
    }
}

static void read_terms(const alp_lpv *lpv, const alpi_lpv_fades *fades, const double p[3],
                       light_terms terms)
{
    grid_place places[ALPI_LPV_CASCADES_MOST];
    const uint32_t count = find_grids(lpv, fades, p, places);
    memset(terms, 0, sizeof(light_terms));
    for (uint32_t i = 0; i < count; i++) {
        add_terms(places[i].grid, p, places[i].weight, terms);
    }
}

// --- surfaces ------------------------------------------------------------------------------------

static void move_along(const float from[3], const float n[3], double distance, double to[3])
{
    for (int k = 0; k < 3; k++) {
        to[k] = (double)from[k] + distance * (double)n[k];
    }
}

/// Light that fades along the normal comes from the surface itself or through it. Its share that
/// counts: 1 + cos, where cos < 0 is that of the angle between the light and its change over a cell
/// along the normal. Small changes count less, or noise would damp even light.
static float find_damping(const float here[ALPI_LPV_TERMS], const float low[ALPI_LPV_TERMS],
                          const float high[ALPI_LPV_TERMS])
{
    const float small = 0.3f; // of the light, a cell
    float most = 0.0f, product = 0.0f, light = 0.0f, change = 0.0f;
    for (int t = 0; t < ALPI_LPV_TERMS; t++) {
        most = fmaxf(most, fmaxf(fabsf(here[t]), fmaxf(fabsf(low[t]), fabsf(high[t]))));
    }
    for (int t = 0; t < ALPI_LPV_TERMS && most > 0.0f; t++) { // fourth powers stay within floats
        const float l = here[t] / most, d = high[t] / most - low[t] / most;
        product += l * d;
        light += l * l;
        change += d * d;
    }
    const float share =
        light > 0.0f ? 1.0f + product / (sqrtf(light * change) + small * light) : 1.0f;
    return share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
}

typedef struct lpv_field {
    alp_field field;
    const alp_lpv *lpv;
} lpv_field;

/// Share of light at a point that counts, by channel. A surface is read above the cells behind it,
/// so the light of ACCURATE needs no damping: it would blacken walls near lit floors.
static void damp(const alp_lpv *lpv, const alpi_lpv_grid *g, const float position[3],
                 const float n[3], light_terms here, float shares[3])
{
    light_terms low = {{0}}, high = {{0}};
    double p[3];
    shares[0] = shares[1] = shares[2] = 1.0f;
    if (lpv->options.mode == ALP_LPV_ACCURATE) {
        return;
    }
    move_along(position, n, (ALP_LPV_LIFT - 0.5) * g->cell, p);
    add_terms(g, p, 1.0f, low);
    move_along(position, n, (ALP_LPV_LIFT + 0.5) * g->cell, p);
    add_terms(g, p, 1.0f, high);
    for (int k = 0; k < 3; k++) {
        shares[k] = find_damping(here[k], low[k], high[k]);
    }
}

static void irradiance(const alp_field *field, uint32_t count, const float (*positions)[3],
                       const float (*normals)[3], float (*out)[3])
{
    const alp_lpv *lpv = ((const lpv_field *)field)->lpv;
    const alpi_lpv_fades fades = alpi_lpv_find_fades(lpv, ALP_LPV_READING_BORDER);
    for (uint32_t i = 0; i < count; i++) {
        const float *n = normals[i];
        grid_place places[ALPI_LPV_CASCADES_MOST];
        double p[3];
        move_along(positions[i], n, 0.0, p);
        const uint32_t grids = find_grids(lpv, &fades, p, places);
        memset(out[i], 0, sizeof out[i]);
        for (uint32_t g = 0; g < grids; g++) {
            light_terms here = {{0}};
            float shares[3];
            move_along(positions[i], n, ALP_LPV_LIFT * places[g].grid->cell, p);
            add_terms(places[g].grid, p, 1.0f, here);
            damp(lpv, places[g].grid, positions[i], n, here, shares);
            for (int k = 0; k < 3; k++) {
                const float *t = here[k];
                const float along = t[1] * n[0] + t[2] * n[1] + t[3] * n[2];
                const float e = (float)ALPI_PI * (t[0] - (2.0f / 3.0f) * along);
                out[i][k] += places[g].weight * shares[k] * fmaxf(e, 0.0f);
            }
        }
    }
}

static void destroy(alp_field *field)
{
    alpi_release(field->context, field);
}

static const alpi_field_kind kind = {"lpv", irradiance, NULL, destroy};

alp_result alp_field_create_lpv(const alp_lpv *lpv, alp_field **field)
{
    if (lpv == NULL || field == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *field = NULL;
    lpv_field *f = ALPI_NEW(lpv->context, lpv_field, 1);
    if (f == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    f->field = (alp_field){.context = lpv->context, .kind = &kind};
    f->lpv = lpv;
    *field = &f->field;
    return ALP_OK;
}

// --- mirrors and air -----------------------------------------------------------------------------

void alp_lpv_radiance(const alp_lpv *lpv, uint32_t count, const float (*positions)[3],
                      const float (*directions)[3], float (*radiance)[3])
{
    const alpi_lpv_fades fades = alpi_lpv_find_fades(lpv, ALP_LPV_READING_BORDER);
    for (uint32_t i = 0; i < count; i++) {
        const float *d = directions[i];
        float sum[3] = {0.0f, 0.0f, 0.0f}, weights = 0.0f;
        grid_place places[ALPI_LPV_CASCADES_MOST];
        double p[3];
        move_along(positions[i], d, 0.0, p);
        const uint32_t grids = find_grids(lpv, &fades, p, places);
        double cell = 0.0; // blended, or steps would jump where a grid begins
        for (uint32_t g = 0; g < grids; g++) {
            cell += (double)places[g].weight * places[g].grid->cell;
        }
        for (int step = 1; step <= GLOSS_STEPS; step++) {
            light_terms t;
            const float weight = 1.0f / (float)(step * step);
            move_along(positions[i], d, step * cell, p);
            read_terms(lpv, &fades, p, t);
            for (int k = 0; k < 3; k++) {
                const float along = t[k][1] * d[0] + t[k][2] * d[1] + t[k][3] * d[2];
                sum[k] += weight * fmaxf(t[k][0] - along, 0.0f);
            }
            weights += weight;
        }
        for (int k = 0; k < 3; k++) {
            radiance[i][k] = sum[k] / weights;
        }
    }
}

void alp_lpv_fluence(const alp_lpv *lpv, uint32_t count, const float (*positions)[3],
                     float (*fluence)[3])
{
    const alpi_lpv_fades fades = alpi_lpv_find_fades(lpv, ALP_LPV_READING_BORDER);
    const float sphere = 4.0f * (float)ALPI_PI, nowhere[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        light_terms t;
        double p[3];
        move_along(positions[i], nowhere, 0.0, p);
        read_terms(lpv, &fades, p, t);
        for (int k = 0; k < 3; k++) {
            fluence[i][k] = sphere * fmaxf(t[k][0], 0.0f);
        }
    }
}
