// SPDX-License-Identifier: MIT
// Occlusion at points of your own, in a scene made from arrays: no file is read or written.
//
//     cc 01_occlusion_at_points.c -o points $(pkg-config --cflags --libs alpenglow) -lm
//
// A wall of height h stands on the ground and has no ends. At a distance d from it the share of the
// sky that is open, counted by the cosine, is known: A = (1 + d / sqrt(d^2 + h^2)) / 2.
#include <alpenglow/alpenglow.h>
#include <math.h>
#include <stdio.h>

enum { POINTS = 5 };

static const float wall_height = 1.0f; // metres

/// A wall so long that its ends do not count, as two triangles in the plane x = 0.
static alp_result make_wall(alp_context *context, alp_scene **scene)
{
    const float far = 1000.0f;
    const float positions[4][3] = {
        {0, 0, far}, {0, 0, -far}, {0, wall_height, -far}, {0, wall_height, far}};
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
    alp_mesh mesh = {
        .name = "wall",
        .vertex_count = 4,
        .positions = positions[0],
        .triangle_count = 2,
        .indices = indices[0],
        .base_color = {0.5f, 0.5f, 0.5f},
    };
    return alp_scene_create_from_meshes(context, &mesh, 1, scene);
}

static alp_result ask(const alp_scene *scene)
{
    float positions[POINTS][3], normals[POINTS][3], open[POINTS];
    for (int i = 0; i < POINTS; i++) {
        positions[i][0] = 0.25f * (float)(1 << i); // metres from the wall
        positions[i][1] = positions[i][2] = 0.0f;
        normals[i][0] = normals[i][2] = 0.0f;
        normals[i][1] = 1.0f; // up
    }
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = 4096;
    options.distance = INFINITY;
    options.falloff = ALP_FALLOFF_NONE; // the only one that means something without a limit
    alp_result result =
        alp_occlusion_at_points(scene, POINTS, positions[0], NULL, normals[0], &options, open);
    if (result != ALP_OK) {
        return result;
    }
    printf("distance   rays     closed form  difference\n");
    for (int i = 0; i < POINTS; i++) {
        double d = positions[i][0], h = wall_height;
        double exact = 0.5 * (1.0 + d / sqrt(d * d + h * h));
        printf("%5.2f m   %.5f  %.5f      %+.5f\n", d, open[i], exact, open[i] - exact);
    }
    return ALP_OK;
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = make_wall(context, &scene);
    }
    if (result == ALP_OK) {
        result = ask(scene);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result),
                context ? alp_context_message(context) : "no context");
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
