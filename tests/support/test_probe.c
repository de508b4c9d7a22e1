// SPDX-License-Identifier: MIT
#include "test_probe.h"

test_probe test_probe_open(alp_context *context, alp_scene *scene,
                           const alp_lighting_options *lighting, uint32_t n)
{
    test_probe p = {.stage = test_stage_open(context, scene, NULL, 0, lighting)};
    ASSERT_OK(context, alpi_hemicube_create(context, n, &p.cube));
    p.options = (alpi_hemicube_options){.context = context,
                                        .from = {.scene = scene,
                                                 .tracer = p.stage.tracer,
                                                 .lighting = p.stage.lighting,
                                                 .emitters = true,
                                                 .sky = true},
                                        .cube = p.cube,
                                        .seed = 1};
    return p;
}

void test_probe_set_resolution(test_probe *p, uint32_t n)
{
    alpi_hemicube_destroy(p->cube);
    ASSERT_OK(p->stage.context, alpi_hemicube_create(p->stage.context, n, &p->cube));
    p->options.cube = p->cube;
}

void test_probe_close(test_probe *p)
{
    alpi_hemicube_destroy(p->cube);
    test_stage_close(&p->stage);
}

alpi_receiver_point test_probe_point(vec3 position, vec3 normal)
{
    return (alpi_receiver_point){position, normal, normal, 1e-6f};
}

double test_probe_gather(const test_probe *p, const alpi_receiver_point *point, uint64_t receiver)
{
    float e[3];
    ASSERT_OK(p->stage.context, alpi_hemicube_gather(&p->options, point, receiver, e));
    return (double)e[0];
}

alp_scene *test_probe_quad(alp_context *context, const vec3 *quad)
{
    static const vec3 below[4] = {{0, -9, 0}, {1e-3f, -9, 0}, {1e-3f, -9, 1e-3f}, {0, -9, 1e-3f}};
    const vec3 black = {0, 0, 0}, one = {1, 1, 1};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "quad");
    alpi_builder_surface(&b, "quad",
                         alpi_builder_material(&b, "quad", black, quad != NULL ? one : black));
    alpi_builder_quad(&b, quad != NULL ? quad : below);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

alp_lighting_options test_sky_of(alp_sky_kind kind)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = kind;
    return o;
}
