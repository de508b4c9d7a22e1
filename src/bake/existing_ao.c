// SPDX-License-Identifier: MIT
// --existing-ao multiply: the old occlusion map, read at each new texel.
#include "bake/job.h"

void alpi_bake_multiply_existing(const alpi_bake_job *job, float *accessibility)
{
    const alpi_texels *texels = &job->lightmap->texels;
    for (uint32_t i = 0; i < texels->count; i++) {
        float old = 1.0f;
        if (!alpi_bake_is_packed(job, texels->triangles[i]) &&
            alpi_surface_occlusion(job->scene, texels->triangles[i], texels->barycentrics[i][0],
                                   texels->barycentrics[i][1], &old)) {
            accessibility[i] *= old;
        }
    }
}
