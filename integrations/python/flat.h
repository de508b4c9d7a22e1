// SPDX-License-Identifier: MIT
// Calls and fields with rows of three floats, as flat arrays: cffi has no pointers to const rows.
#include <alpenglow/alpenglow.h>

static const float *flat_positions(const alp_scene *scene)
{
    return (const float *)alp_scene_get_geometry(scene).positions;
}

static const float *flat_normals(const alp_scene *scene)
{
    return (const float *)alp_scene_get_geometry(scene).normals;
}

static const uint32_t *flat_triangles(const alp_scene *scene)
{
    return (const uint32_t *)alp_scene_get_geometry(scene).triangles;
}

static void flat_set_positions(alp_probe_options *options, const float *positions, uint32_t count)
{
    options->positions = (const float(*)[3])positions;
    options->position_count = count;
}

static void flat_irradiance(const alp_field *field, uint32_t count, const float *positions,
                            const float *normals, float *irradiance)
{
    alp_field_irradiance(field, count, (const float(*)[3])positions, (const float(*)[3])normals,
                         (float(*)[3])irradiance);
}
