// SPDX-License-Identifier: MIT
// The error that probes state, against that to 2^16 rays in the same solved light.
#include "field_scenes.h"

TEST_CONTEXT(2);

static alp_probes *bake(const alp_scene *scene, float spacing, uint32_t rays, uint64_t seed)
{
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    o.spacing = spacing;
    o.rays = rays;
    o.seed = seed;
    o.atlas_size = 64;
    o.visibility = false;
    for (int k = 0; k < 3; k++) { // far from the lamp, whose light few probes would dominate
        o.bounds_min[k] = 0.05f;
        o.bounds_max[k] = k == 1 ? 0.25f : 0.5f;
    }
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    return probes;
}

/// Mean over normals of the squared difference of E: Σ A_l² Δc² / 4π.
static double square_of(const float *a, const float *b)
{
    static const double cosine[9] = {1.0, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    double sum = 0.0;
    for (int i = 0; i < 27; i++) {
        const double apart = (double)(a[i] - b[i]) * cosine[i / 3] * FIELD_PI;
        sum += apart * apart / (4.0 * FIELD_PI) / 3.0;
    }
    return sum;
}

static void check(const char *name, float spacing, uint32_t seeds)
{
    alp_scene *scene = test_load(context, name);
    double squares = 0.0, stated = 0.0;
    for (uint64_t seed = 0; seed < seeds; seed++) {
        alp_probes *quick = bake(scene, spacing, 1536, seed);
        alp_probes *exact = bake(scene, spacing, 1u << 16, seed);
        const alp_probes_info info = alp_probes_get_info(quick);
        const double error = (double)info.error * (double)info.mean;
        uint32_t count = 0;
        double sum = 0.0;
        for (uint32_t i = 0; i < info.count; i++) {
            if (alp_probes_states(quick)[i] <= ALP_PROBE_MOVED) {
                sum += square_of(field_coefficient(quick, i, 0), field_coefficient(exact, i, 0));
                count++;
            }
        }
        squares += sum / count / seeds;
        stated += error * error / seeds;
        alp_probes_destroy(quick);
        alp_probes_destroy(exact);
    }
    const double ratio = sqrt(stated / squares);
    print_message("accuracy: probes of %s, stated over true error: %.3f\n", name, ratio);
    ASSERT_NEAR(ratio, 1.0, 0.15);
    alp_scene_destroy(scene);
}

TEST_SLOW(cornell_states_its_error)
{
    check("builtin:cornell", 0.1f, 8);
}

TEST_SLOW(a_furnace_states_its_error)
{
    check("builtin:furnace", 0.15f, 2);
}
