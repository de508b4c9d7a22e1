// SPDX-License-Identifier: MIT
// The doctor's picture of a UV set: islands in colours of their own, what overlaps in red, what
// lies outside of the unit square as orange lines.
#include "doctor/doctor.h"

#include "doctor/doctor_spot.h"

#include "atlas/raster.h"
#include "base/memory.h"
#include "base/random.h"

#include <math.h>

enum { SIDE = 1024, CELLS = 8 }; // texels; squares of the ground across the unit square
/// Where triangles lie outside, so much around the unit square is shown, least and most: beyond
/// four tiles it would be too small to see.
static const double LEAST_AROUND = 0.25, MOST_AROUND = 4.0;
/// Lines are drawn pixel by pixel: a bound on the work, a few of the longest for each of a million
/// triangles.
static const uint64_t STEP_LIMIT = (uint64_t)1 << 28;

typedef struct color {
    uint8_t r, g, b;
} color;
static const color GROUND = {38, 41, 48}, GROUND_LIGHT = {45, 48, 56}, OUTSIDE = {24, 25, 29},
                   FRAME = {240, 240, 240}, RED = {235, 40, 40}, DARK_RED = {150, 12, 20},
                   ORANGE = {255, 150, 40};

typedef struct layout_picture {
    const alp_atlas *layout;
    double low, size;  // of the window: u and v from low to low + size
    color *pixels;     // [SIDE][SIDE]
    uint32_t *islands; // [SIDE][SIDE], ALPI_NONE = ground
    uint64_t steps;
} layout_picture;

static double pixel_of(const layout_picture *p, double value)
{
    return (value - p->low) / p->size * SIDE;
}

// --- ground --------------------------------------------------------------------------------------

static void put_ground(const layout_picture *p)
{
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const double u = p->low + ((double)x + 0.5) / SIDE * p->size;
            const double v = p->low + ((double)y + 0.5) / SIDE * p->size;
            const bool inside = u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0;
            const int cell = (int)floor(u * CELLS) + (int)floor(v * CELLS);
            p->pixels[(size_t)y * SIDE + x] = !inside         ? OUTSIDE
                                              : cell % 2 == 0 ? GROUND
                                                              : GROUND_LIGHT;
        }
    }
}

/// The border of the unit square, where there is something around it.
static void put_frame(const layout_picture *p)
{
    const int low = (int)pixel_of(p, 0.0), high = (int)pixel_of(p, 1.0);
    for (int i = low; i <= high && low > 0; i++) {
        p->pixels[(size_t)low * SIDE + (size_t)i] = p->pixels[(size_t)high * SIDE + (size_t)i] =
            p->pixels[(size_t)i * SIDE + (size_t)low] = p->pixels[(size_t)i * SIDE + (size_t)high] =
                FRAME;
    }
}

// --- islands -------------------------------------------------------------------------------------

/// A colour of its own: one of many hues, not too dark and not too pure, and never the red or the
/// orange of a fault.
static color color_of(uint32_t island)
{
    const uint32_t hash = alpi_hash32(island + 1);
    const double hue = 0.18 + 0.70 * ((double)(hash & 0xffffu) / 65536.0); // yellow-green to violet
    const double value = 0.62 + 0.30 * ((double)(hash >> 16 & 0xffu) / 256.0);
    double channel[3];
    for (int k = 0; k < 3; k++) { // HSV of saturation .45, in closed form
        const double place = fmod(hue * 6.0 + (k == 0 ? 5.0 : k == 1 ? 3.0 : 1.0), 6.0);
        const double part = fmax(0.0, fmin(fmin(place, 4.0 - place), 1.0));
        channel[k] = 255.0 * value * (1.0 - 0.45 * part);
    }
    return (color){(uint8_t)channel[0], (uint8_t)channel[1], (uint8_t)channel[2]};
}

static alp_result put_band(void *user, const alpi_band *band)
{
    const layout_picture *p = user;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            const alpi_cell *cell = &band->cells[(size_t)row * band->width + x];
            if (cell->triangle != ALPI_NONE) {
                const uint32_t island = p->layout->triangle_charts[cell->triangle];
                const size_t i = (size_t)y * SIDE + x;
                p->pixels[i] = cell->other != ALPI_NONE ? RED : color_of(island);
                p->islands[i] = island;
            }
        }
    }
    return ALP_OK;
}

/// Darkens islands where they end, so that two of like colours part.
static void put_borders(const layout_picture *p)
{
    for (uint32_t y = 0; y + 1 < SIDE; y++) {
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            const size_t i = (size_t)y * SIDE + x;
            const uint32_t here = p->islands[i];
            if (here != ALPI_NONE && (p->islands[i + 1] != here || p->islands[i + SIDE] != here)) {
                color *c = &p->pixels[i];
                *c = (color){(uint8_t)(c->r / 2), (uint8_t)(c->g / 2), (uint8_t)(c->b / 2)};
            }
        }
    }
}

// --- what lies outside ---------------------------------------------------------------------------

/// The part of a line within the window along one axis.
static void clip_axis(double from, double along, double *begin, double *end)
{
    if (along == 0.0) {
        *end = from >= 0.0 && from < SIDE ? *end : -1.0;
        return;
    }
    const double a = -from / along, b = (SIDE - 1e-3 - from) / along;
    *begin = fmax(*begin, fmin(a, b));
    *end = fmin(*end, fmax(a, b));
}

/// A line of the picture; with `over`, where that colour is alone.
static void put_line(layout_picture *p, const float *from, const float *to, const color *over)
{
    const double x = pixel_of(p, (double)from[0]), y = pixel_of(p, (double)from[1]);
    const double dx = pixel_of(p, (double)to[0]) - x, dy = pixel_of(p, (double)to[1]) - y;
    if (!isfinite(dx) || !isfinite(dy) || !isfinite(x) || !isfinite(y)) {
        return;
    }
    double begin = 0.0, end = 1.0;
    clip_axis(x, dx, &begin, &end);
    clip_axis(y, dy, &begin, &end);
    if (!(begin <= end)) {
        return;
    }
    const double length = fmax(fabs(dx), fabs(dy)) * (end - begin);
    const uint32_t steps = 1 + (uint32_t)length; // at most SIDE + 1
    p->steps += steps;
    for (uint32_t i = 0; i <= steps && p->steps < STEP_LIMIT; i++) {
        const double t = begin + (end - begin) * i / steps;
        const int column = (int)(x + t * dx), row = (int)(y + t * dy);
        if (column >= 0 && column < SIDE && row >= 0 && row < SIDE) {
            color *at = &p->pixels[(size_t)row * SIDE + (size_t)column];
            *at = over == NULL ? ORANGE : at->r == over->r && at->g == over->g ? DARK_RED : *at;
        }
    }
}

/// Outlines of the triangles that the page does not hold, from the scene's own coordinates.
static void put_outside(layout_picture *p, uint32_t set)
{
    const alp_scene *scene = p->layout->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[t]];
        if (!scene->triangle_usable[t] || surface->uv_sets <= set ||
            p->layout->triangle_pages[t] != ALPI_NONE) {
            continue;
        }
        for (int k = 0; k < 3; k++) {
            put_line(p, scene->uvs[set][scene->triangles[t][k]],
                     scene->uvs[set][scene->triangles[t][(k + 1) % 3]], NULL);
        }
    }
}

/// Outlines in what overlaps, which would be one red shape without them.
static void put_overlapping(layout_picture *p, uint32_t set)
{
    const alp_scene *scene = p->layout->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3 && p->layout->triangle_pages[t] != ALPI_NONE; k++) {
            put_line(p, scene->uvs[set][scene->triangles[t][k]],
                     scene->uvs[set][scene->triangles[t][(k + 1) % 3]], &RED);
        }
    }
}

/// How much around the unit square is to be shown, a little more than is used.
static double reach_of(const alp_atlas *layout, uint32_t set)
{
    const alp_scene *scene = layout->scene;
    double reach = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const bool is_outside = scene->triangle_usable[t] &&
                                scene->surfaces[scene->triangle_surface[t]].uv_sets > set &&
                                layout->triangle_pages[t] == ALPI_NONE;
        for (int k = 0; k < 6 && is_outside; k++) { // a NaN does not count
            const double value = (double)scene->uvs[set][scene->triangles[t][k / 2]][k % 2];
            reach = fmax(reach, fmax(-value, value - 1.0));
        }
    }
    return fmin(fmax(1.05 * reach, LEAST_AROUND), MOST_AROUND);
}

// --- all of it -----------------------------------------------------------------------------------

/// Moves the layout's coordinates from the unit square to their part of the window.
static void move_into_window(alp_atlas *layout, const layout_picture *p)
{
    for (uint32_t t = 0; t < layout->scene->triangle_count; t++) {
        for (int k = 0; k < 6 && layout->triangle_pages[t] != ALPI_NONE; k++) {
            float *value = &layout->corner_uvs[t][k / 2][k % 2];
            *value = (float)(((double)*value - p->low) / p->size);
        }
    }
}

static alp_result draw(layout_picture *p, alp_atlas *layout, uint32_t set,
                       const alpi_uv_set_facts *facts)
{
    const bool has_outside = facts->outside > 0, has_overlaps = facts->overlapping > 0;
    const double around = has_outside ? reach_of(layout, set) : 0.0;
    p->low = -around;
    p->size = 1.0 + 2.0 * around;
    p->layout = layout;
    put_ground(p);
    if (has_outside) {
        put_outside(p, set);
    }
    move_into_window(layout, p);
    ALP_TRY(alpi_raster(layout, 0, 1, put_band, p));
    if (has_overlaps) {
        put_overlapping(p, set);
    }
    put_borders(p);
    put_frame(p);
    return ALP_OK;
}

/// Rings around the spots of findings, over all else.
static void put_spots(const layout_picture *p, const alp_diagnosis *d, uint32_t set)
{
    for (size_t i = 0; i < d->count; i++) {
        const alp_finding *f = &d->findings[i].view;
        if (f->spot.known && f->place == ALP_PLACE_UV_SET && f->index == set) {
            alpi_doctor_ring((uint8_t *)p->pixels, SIDE, SIDE, pixel_of(p, (double)f->spot.uv[0]),
                             pixel_of(p, (double)f->spot.uv[1]));
        }
    }
}

alp_result alpi_doctor_draw_uv_set(const alp_diagnosis *diagnosis, uint32_t set, alp_image **image)
{
    const alp_scene *scene = diagnosis->scene;
    alpi_uv_set_facts facts;
    alp_atlas *layout = NULL;
    ALP_TRY(alpi_uv_set_survey(scene, set, SIDE, NULL, &facts, &layout));
    layout_picture p = {.islands = ALPI_NEW(scene->context, uint32_t, (size_t)SIDE * SIDE)};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (p.islands != NULL) {
        result = alp_image_create(scene->context, (alp_image_info){SIDE, SIDE, 3, ALP_COMPONENT_U8},
                                  image);
    }
    if (result == ALP_OK) {
        for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
            p.islands[i] = ALPI_NONE;
        }
        p.pixels = (color *)(void *)alp_image_bytes(*image);
        result = draw(&p, layout, set, &facts);
        put_spots(&p, diagnosis, set);
    }
    alpi_release(scene->context, p.islands);
    alp_atlas_destroy(layout);
    if (result != ALP_OK) {
        alp_image_destroy(*image);
        *image = NULL;
    }
    return result;
}
