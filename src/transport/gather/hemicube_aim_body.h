// SPDX-License-Identifier: MIT
// Rays of a hemicube's packet, included once for each instruction set: loops over the eight lanes
// that become a few vector instructions. No fused operations in either: the same bits.
#include "transport/gather/hemicube.h"

void ALPI_VARIANT(alpi_hemicube_aim)(const alpi_hemicube_packet *packet, vec3 start,
                                     const alpi_hemicube_frame *f, alpi_rays *rays)
{
    alpi_rays_start(rays, start);
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float x = packet->x[i], y = packet->y[i], z = packet->z[i];
        rays->direction_x[i] = x * f->right.x + y * f->up.x + z * f->forward.x;
        rays->direction_y[i] = x * f->right.y + y * f->up.y + z * f->forward.y;
        rays->direction_z[i] = x * f->right.z + y * f->up.z + z * f->forward.z;
    }
}
