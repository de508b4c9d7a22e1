// SPDX-License-Identifier: MIT
#include "test_shadows.h"

#include "render/camera_rays.h"
#include "scene/lights/lighting.h"
#include "test_support.h"
#include "transport/paths/hit.h"

static uint32_t lights_at(const alpi_lighting *lighting, const alpi_tracer *tracer,
                          const alpi_receiver_point *p)
{
    const alpi_trace_filter filter = {.panes = alpi_tracer_has_panes(tracer)};
    const uint32_t count = alpi_lighting_light_count(lighting);
    uint32_t reached = 0;
    assert_true(count <= 32);
    for (uint32_t k = 0; k < count; k++) {
        alpi_light_sample s;
        alpi_rays rays;
        alpi_rays_clear(&rays);
        if (!alpi_lighting_sample_light(lighting, k, p->position, (vec2){0.5f, 0.5f}, &s) ||
            vec3_dot(p->shading_normal, s.direction) <= 0.0f) {
            continue;
        }
        alpi_rays_set(&rays, 0, vec3_mad(p->position, p->offset, p->shading_normal), s.direction,
                      s.distance * (1.0f - 1e-5f));
        alpi_trace_occluded(tracer, &rays, 1, 1u, filter, ALPI_RAYS_NEAR);
        reached |= rays.maximum[0] >= 0.0f ? 1u << k : 0u;
    }
    return reached;
}

void test_shadows_trace(const alp_scene *scene, const alp_render_options *o,
                        const alp_camera *camera, uint32_t *reached)
{
    alpi_tracer *tracer = NULL;
    alpi_lighting *lighting = NULL;
    alpi_view view;
    alpi_rays rays;
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(scene->context, alpi_lighting_create(scene, &o->lighting, &lighting));
    ASSERT_OK(scene->context, alpi_view_place(scene->context, camera, o->width, o->height, &view));
    view.centred = true;
    alpi_rays_clear(&rays);
    for (uint32_t i = 0; i < o->width * o->height; i++) {
        alpi_hits hits;
        const alpi_trace_filter filter = {.panes = true};
        view.loops->packet(&view, i, 0, 0, &rays);
        alpi_trace_nearest_coherent(tracer, &rays, 1u, filter, &hits);
        reached[i] = 0;
        if (hits.triangle[0] != ALPI_NONE) {
            const vec3 d = {rays.direction_x[0], rays.direction_y[0], rays.direction_z[0]};
            const alpi_receiver_point p = alpi_hit_point(scene, &hits, 0, d, NULL);
            reached[i] = lights_at(lighting, tracer, &p);
        }
    }
    alpi_lighting_destroy(scene->context, lighting);
}
