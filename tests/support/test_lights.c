// SPDX-License-Identifier: MIT
#include "test_lights.h"

#include "base/random.h"

#include <math.h>

test_draw test_draw_at(uint32_t seed, uint32_t i)
{
    uint64_t a = alpi_hash64(((uint64_t)seed << 32) | i), b = alpi_hash64(a);
    return (test_draw){alpi_unit_float((uint32_t)a),
                       {alpi_unit_float((uint32_t)b), alpi_unit_float((uint32_t)(b >> 32))}};
}

test_estimate test_light_estimate(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                  uint32_t count, uint32_t seed)
{
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        test_draw draw = test_draw_at(seed, i);
        alpi_light_sample s;
        double value = 0.0;
        if (alpi_lighting_sample(lighting, point, normal, draw.pick, draw.u, &s)) {
            value = (double)s.light.x * (double)vec3_dot(s.direction, normal) / (double)s.density;
        }
        sum += value;
        squares += value * value;
    }
    double mean = sum / count;
    double variance = fmax(squares / count - mean * mean, 0.0);
    return (test_estimate){mean, sqrt(variance / count), variance};
}

alp_scene *test_emitter_scene(alp_context *context, const vec3 (*triangles)[3], uint32_t count,
                              vec3 emission)
{
    alpi_builder builder;
    alp_scene *scene = NULL;
    alpi_builder_start(&builder, context, "emitters");
    alpi_builder_surface(
        &builder, "emitters",
        alpi_builder_material(&builder, "glow", (vec3){0.5f, 0.5f, 0.5f}, emission));
    for (uint32_t t = 0; t < count; t++) {
        vec3 normal = vec3_triangle_normal(triangles[t][0], triangles[t][1], triangles[t][2],
                                           (vec3){0.0f, 1.0f, 0.0f});
        uint32_t v[3];
        for (int k = 0; k < 3; k++) {
            v[k] = alpi_builder_vertex(&builder, triangles[t][k], normal);
        }
        alpi_builder_triangle(&builder, v[0], v[1], v[2]);
    }
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}
