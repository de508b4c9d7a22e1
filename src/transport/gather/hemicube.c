// SPDX-License-Identifier: MIT
#include "transport/gather/hemicube.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STREAM_TURN = 7, STREAM_PLACE = 9 };
enum { BLOCK_WIDTH = 4, BLOCK_HEIGHT = 2, FACES = 5 };
_Static_assert(BLOCK_WIDTH *BLOCK_HEIGHT == ALPI_PACKET, "a block fills a packet");
/// Packets between questions whether to go on: some milliseconds.
enum { PACKETS_PER_LOOK = 1024 };
/// Pixels of at most 3.6°, so that a packet's rays are like a camera's. At 64 they take .5 to .75
/// of the time of scattered ones, by the size of the scene.
enum { COHERENT_FROM = 32 };

// --- weights -------------------------------------------------------------------------------------
//
// The cross is symmetric in 8 ways: a pixel is told by its distances from the middle lines, in
// units of half a pixel: odd numbers, of which `far` is the larger. Up to n that is the front face.

typedef struct place {
    uint32_t far, near;
} place;

static place place_of(uint32_t n, uint32_t column, uint32_t row)
{
    const uint32_t a = (uint32_t)abs((int)(2 * column + 1) - (int)(2 * n));
    const uint32_t b = (uint32_t)abs((int)(2 * row + 1) - (int)(2 * n));
    return a > b ? (place){a, b} : (place){b, a};
}

/// Form factor of a rectangle a × b parallel to the receiver at distance 1, a corner above it.
/// Both functions are of Siegel, Howell. Thermal Radiation Heat Transfer, appendix of configuration
/// factors from an element to a rectangle.
static double parallel_factor(double a, double b)
{
    const double p = sqrt(1.0 + a * a), q = sqrt(1.0 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2.0 * ALPI_PI);
}

/// Form factor of an upright rectangle of width w and height h at distance 1, a corner at its foot.
static double upright_factor(double w, double h)
{
    const double q = sqrt(1.0 + h * h);
    return (atan(w) - atan(w / q) / q) / (2.0 * ALPI_PI);
}

static double weight_at(uint32_t n, place at)
{
    const double edge = (double)n;
    const double b0 = (at.near - 1) / edge, b1 = (at.near + 1) / edge;
    if (at.near > n) {
        return 0.0; // a corner of the cross
    }
    if (at.far < n) {
        const double a0 = (at.far - 1) / edge, a1 = (at.far + 1) / edge;
        return parallel_factor(a1, b1) - parallel_factor(a0, b1) - parallel_factor(a1, b0) +
               parallel_factor(a0, b0);
    }
    const double z0 = (2 * n - at.far - 1) / edge, z1 = (2 * n - at.far + 1) / edge;
    return upright_factor(b1, z1) - upright_factor(b0, z1) - upright_factor(b1, z0) +
           upright_factor(b0, z0);
}

double alpi_hemicube_weight(uint32_t resolution, uint32_t column, uint32_t row)
{
    return weight_at(resolution, place_of(resolution, column, row));
}

bool alpi_hemicube_pixel(uint32_t resolution, uint32_t column, uint32_t row, double local[3])
{
    const double n = (double)resolution;
    const double u = (2.0 * column + 1.0) / n - 2.0, v = 2.0 - (2.0 * row + 1.0) / n;
    const double over = fmax(fmax(fabs(u), fabs(v)) - 1.0, 0.0); // how far down a side
    if (fmin(fabs(u), fabs(v)) > 1.0) {
        return false;
    }
    local[0] = fmin(fmax(u, -1.0), 1.0);
    local[1] = fmin(fmax(v, -1.0), 1.0);
    local[2] = 1.0 - over;
    return true;
}

// --- making --------------------------------------------------------------------------------------

/// A face in the cross.
typedef struct face {
    uint32_t left, top, width, height;
} face;

static void list_faces(uint32_t n, face faces[FACES])
{
    const uint32_t half = n / 2;
    faces[0] = (face){half, half, n, n};
    faces[1] = (face){half, 0, n, half};
    faces[2] = (face){half, half + n, n, half};
    faces[3] = (face){0, half, half, n};
    faces[4] = (face){half + n, half, half, n};
}

static uint32_t blocks_across(uint32_t length, uint32_t block)
{
    return (length + block - 1) / block;
}

static void fill_lane(alpi_hemicube_packet *packet, int lane, uint32_t n, uint32_t column,
                      uint32_t row)
{
    double d[3];
    if (!alpi_hemicube_pixel(n, column, row, d)) {
        return;
    }
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    packet->x[lane] = (float)(d[0] / length);
    packet->y[lane] = (float)(d[1] / length);
    packet->z[lane] = (float)(d[2] / length);
    packet->column[lane] = (uint16_t)column;
    packet->row[lane] = (uint16_t)row;
    packet->active |= 1u << lane;
}

/// One packet. @param left, top its first pixel, in the face
static void fill_block(alpi_hemicube *cube, const face *f, uint32_t left, uint32_t top)
{
    alpi_hemicube_packet *packet = &cube->packets[cube->packet_count++];
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t c = left + i % BLOCK_WIDTH, r = top + i / BLOCK_WIDTH;
        if (c < f->width && r < f->height) {
            fill_lane(packet, (int)i, cube->resolution, f->left + c, f->top + r);
        }
    }
}

/// Blocks that lie one above the other follow each other: packets that are traced in pairs look
/// through a square of 4 × 4 pixels, which crosses fewer boxes than 8 × 2. (Where half the
/// resolution is no multiple of 4 some pairs are torn: slower, not wrong.)
static void fill_face(alpi_hemicube *cube, const face *f)
{
    for (uint32_t y = 0; y < f->height; y += 2 * BLOCK_HEIGHT) {
        for (uint32_t x = 0; x < f->width; x += BLOCK_WIDTH) {
            fill_block(cube, f, x, y);
            if (y + BLOCK_HEIGHT < f->height) {
                fill_block(cube, f, x, y + BLOCK_HEIGHT);
            }
        }
    }
}

/// Computes one of eight equal weights each, and hands them out.
static alp_result fill_weights(alpi_hemicube *cube)
{
    const uint32_t n = cube->resolution, half = n / 2;
    const size_t count = (size_t)n * half;
    float *eighth = ALPI_NEW(cube->context, float, count);
    if (eighth == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t k = 0; k < half && k <= i; k++) {
            eighth[(size_t)i * half + k] = (float)weight_at(n, (place){2 * i + 1, 2 * k + 1});
        }
    }
    for (uint32_t p = 0; p < cube->packet_count; p++) {
        const alpi_hemicube_packet *packet = &cube->packets[p];
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((packet->active >> i & 1u) != 0) {
                const place at = place_of(n, packet->column[i], packet->row[i]);
                cube->weights[p][i] = eighth[(size_t)(at.far / 2) * half + at.near / 2];
            }
        }
    }
    alpi_release(cube->context, eighth);
    return ALP_OK;
}

static alp_result fill(alpi_hemicube *cube)
{
    face faces[FACES];
    uint32_t count = 0;
    list_faces(cube->resolution, faces);
    for (int i = 0; i < FACES; i++) {
        count += blocks_across(faces[i].width, BLOCK_WIDTH) *
                 blocks_across(faces[i].height, BLOCK_HEIGHT);
    }
    ALPI_TRY_NEW(cube->context, cube->packets, count);
    ALPI_TRY_NEW(cube->context, cube->weights, count);
    for (int i = 0; i < FACES; i++) {
        fill_face(cube, &faces[i]);
    }
    return fill_weights(cube);
}

alp_result alpi_hemicube_create(alp_context *context, uint32_t resolution, alpi_hemicube **cube)
{
    *cube = NULL;
    if (resolution < ALPI_HEMICUBE_LEAST || resolution > ALPI_HEMICUBE_MOST ||
        resolution % 2 != 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "hemicube: a resolution of %u is not possible; choose an even number from "
                         "%d to %d",
                         resolution, ALPI_HEMICUBE_LEAST, ALPI_HEMICUBE_MOST);
    }
    alpi_hemicube *made = ALPI_NEW(context, alpi_hemicube, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *made = (alpi_hemicube){.context = context,
                            .resolution = resolution,
                            .aim = ALPI_COMPILED_FOR(context, alpi_hemicube_aim)};
    const alp_result result = fill(made);
    if (result != ALP_OK) {
        alpi_hemicube_destroy(made);
        return result;
    }
    *cube = made;
    return ALP_OK;
}

void alpi_hemicube_destroy(alpi_hemicube *cube)
{
    if (cube != NULL) {
        alpi_release(cube->context, cube->packets);
        alpi_release(cube->context, cube->weights);
        alpi_release(cube->context, cube);
    }
}

// --- frames --------------------------------------------------------------------------------------

alpi_hemicube_frame alpi_hemicube_frame_about(vec3 normal, float turn)
{
    const float c = cosf(turn), s = sinf(turn);
    vec3 t, b;
    vec3_frame(normal, &t, &b); // t × b = normal: −t is to the right of who looks along it
    const vec3 right = vec3_scale(t, -1.0f);
    return (alpi_hemicube_frame){vec3_mad(vec3_scale(right, c), s, b),
                                 vec3_mad(vec3_scale(b, c), -s, right), normal};
}

alpi_hemicube_frame alpi_hemicube_frame_upright(vec3 normal)
{
    const bool level = fabsf(normal.y) < 0.999f;
    const vec3 above = level ? (vec3){0.0f, 1.0f, 0.0f} : (vec3){0.0f, 0.0f, -1.0f};
    const vec3 right = vec3_normalize_or(vec3_cross(normal, above), (vec3){1.0f, 0.0f, 0.0f});
    return (alpi_hemicube_frame){right, vec3_cross(right, normal), normal};
}

// --- gathering -----------------------------------------------------------------------------------

static vec3 start_of(const alpi_receiver_point *p)
{
    return vec3_mad(p->position, p->offset, p->geometric_normal);
}

void alpi_hemicube_trace(const alpi_hemicube_options *options, const alpi_receiver_point *point,
                         const alpi_hemicube_frame *frame, uint32_t packet,
                         vec3 radiance[ALPI_PACKET])
{
    alpi_rays rays;
    const alpi_hemicube_packet *pixels = &options->cube->packets[packet];
    options->cube->aim(pixels, start_of(point), frame, &rays);
    alpi_gather_trace(&options->from, &rays, pixels->active,
                      options->cube->resolution >= COHERENT_FROM, radiance, NULL);
}

alp_result alpi_hemicube_gather_in(const alpi_hemicube_options *options,
                                   const alpi_receiver_point *point,
                                   const alpi_hemicube_frame *frame, float irradiance[3])
{
    const alpi_hemicube *cube = options->cube;
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t k = 0; k < cube->packet_count; k++) {
        vec3 radiance[ALPI_PACKET];
        if (k % PACKETS_PER_LOOK == 0 && !alpi_loop_goes_on(options->context)) {
            return ALP_ERROR_CANCELLED;
        }
        alpi_hemicube_trace(options, point, frame, k, radiance);
        for (int i = 0; i < ALPI_PACKET; i++) {
            const double weight = (double)cube->weights[k][i];
            sum[0] += weight * (double)radiance[i].x;
            sum[1] += weight * (double)radiance[i].y;
            sum[2] += weight * (double)radiance[i].z;
        }
    }
    for (int k = 0; k < 3; k++) {
        irradiance[k] = (float)(ALPI_PI * sum[k]);
    }
    return ALP_OK;
}

/// The cube looks the same after a quarter turn, so that a quarter is all that it turns.
static float turn_of(const alpi_hemicube_options *options, uint64_t receiver)
{
    const uint32_t bits = alpi_random_key(options->seed, receiver, STREAM_TURN);
    return options->turned ? (float)(ALPI_PI / 2.0) * alpi_unit_float(bits) : 0.0f;
}

alp_result alpi_hemicube_gather(const alpi_hemicube_options *options,
                                const alpi_receiver_point *point, uint64_t receiver,
                                float irradiance[3])
{
    const alpi_hemicube_frame frame =
        alpi_hemicube_frame_about(point->shading_normal, turn_of(options, receiver));
    return alpi_hemicube_gather_in(options, point, &frame, irradiance);
}

static void aim_receiver(const void *user, const alpi_receivers *receivers, uint32_t receiver,
                         uint32_t first, uint32_t count, alpi_gather_packet *packets,
                         alpi_gather_ways *ways)
{
    const alpi_hemicube_options *o = user;
    const vec2 at = alpi_sample_2d(alpi_random_key(o->seed, receiver, STREAM_PLACE), 0);
    const float square[1][2] = {{o->scattered ? at.x : 0.5f, o->scattered ? at.y : 0.5f}};
    alpi_receiver_point point;
    receivers->place(receivers->user, receiver, 1, square, &point);
    const alpi_hemicube_frame frame =
        alpi_hemicube_frame_about(point.shading_normal, turn_of(o, receiver));
    const vec3 start = start_of(&point);
    for (uint32_t k = 0; k < count; k++) {
        const alpi_hemicube_packet *pixels = &o->cube->packets[first + k];
        o->cube->aim(pixels, start, &frame, &packets[k].rays);
        packets[k].active = pixels->active;
        for (int i = 0; i < ALPI_PACKET && ways != NULL; i++) {
            ways[k].normals[i] = frame.forward;
            ways[k].cosines[i] = pixels->z[i];
        }
    }
}

alpi_gatherer alpi_hemicube_gatherer(const alpi_hemicube_options *options)
{
    const alpi_hemicube *cube = options->cube;
    return (alpi_gatherer){.aim = aim_receiver,
                           .user = options,
                           .packet_count = cube->packet_count,
                           .weights = (const float(*)[ALPI_PACKET])cube->weights,
                           .replicates = 1,
                           .coherent = cube->resolution >= COHERENT_FROM};
}
