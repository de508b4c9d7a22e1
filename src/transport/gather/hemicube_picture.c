// SPDX-License-Identifier: MIT
#include "transport/gather/hemicube_picture.h"

#include "base/tasks.h"

static alp_result create_cross(alp_context *context, const alpi_hemicube *cube, alp_image **image)
{
    const uint32_t side = 2 * cube->resolution;
    return alp_image_create(context, (alp_image_info){side, side, 4, ALP_COMPONENT_FLOAT}, image);
}

static void put_pixel(alp_image *image, const alpi_hemicube_packet *packet, int lane, vec3 color)
{
    const size_t at = (size_t)packet->row[lane] * image->info.width + packet->column[lane];
    float *rgba = alp_image_floats(image) + 4 * at;
    vec3_store(rgba, color);
    rgba[3] = 1.0f;
}

static float multiplier(const alpi_hemicube *cube, uint32_t number, int lane, alpi_hemicube_map map)
{
    const alpi_hemicube_packet *packet = &cube->packets[number];
    const float n = (float)cube->resolution;
    const float x = fabsf(packet->x[lane]), y = fabsf(packet->y[lane]), z = packet->z[lane];
    const float axis = fmaxf(fmaxf(x, y), z); // the face is the one the ray leaves by
    switch (map) {
    case ALPI_HEMICUBE_MAP_PERSPECTIVE:
        return axis * axis * axis;
    case ALPI_HEMICUBE_MAP_LAMBERT:
        return z;
    case ALPI_HEMICUBE_MAP_WEIGHT:
        break;
    }
    return cube->weights[number][lane] * n * n * (float)(ALPI_PI / 4.0);
}

alp_result alpi_hemicube_draw_map(const alpi_hemicube *cube, alpi_hemicube_map map,
                                  alp_image **image)
{
    ALP_TRY(create_cross(cube->context, cube, image));
    for (uint32_t k = 0; k < cube->packet_count; k++) {
        const alpi_hemicube_packet *packet = &cube->packets[k];
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((packet->active >> i & 1u) != 0) {
                const float m = multiplier(cube, k, i, map);
                put_pixel(*image, packet, i, (vec3){m, m, m});
            }
        }
    }
    return ALP_OK;
}

static void draw_packet(const alpi_hemicube *cube, uint32_t number, const vec3 *radiance,
                        bool weighted, alp_image *image)
{
    const alpi_hemicube_packet *packet = &cube->packets[number];
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((packet->active >> i & 1u) != 0) {
            const float m = weighted ? multiplier(cube, number, i, ALPI_HEMICUBE_MAP_WEIGHT) : 1.0f;
            put_pixel(image, packet, i, vec3_scale(radiance[i], m));
        }
    }
}

alp_result alpi_hemicube_draw_view(const alpi_hemicube_options *options,
                                   const alpi_receiver_point *point,
                                   const alpi_hemicube_frame *frame, bool weighted,
                                   alp_image **image)
{
    const alpi_hemicube *cube = options->cube;
    ALP_TRY(create_cross(options->context, cube, image));
    for (uint32_t k = 0; k < cube->packet_count; k++) {
        vec3 radiance[ALPI_PACKET];
        if (!alpi_loop_goes_on(options->context)) {
            alp_image_destroy(*image);
            *image = NULL;
            return ALP_ERROR_CANCELLED;
        }
        alpi_hemicube_trace(options, point, frame, k, radiance);
        draw_packet(cube, k, radiance, weighted, *image);
    }
    return ALP_OK;
}
