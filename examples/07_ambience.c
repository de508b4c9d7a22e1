// SPDX-License-Identifier: MIT
// A small game loop: light that follows the camera through a landscape, for an object that moves.
// Prints a line a second: E on top of the object, by the library and by its shader's vectors.
//
//     cc 07_ambience.c -o ambience $(pkg-config --cflags --libs alpenglow)
#include <alpenglow/alpenglow.h>

#include <stdio.h>

enum { SECONDS = 3, FRAMES = 60, SAMPLES = 20, SIDE = 16, BOUNCES = 3 };

/// Answers one request by the host's own renderer, in place of alp_ambience_sample. Here a bright
/// sky over dark ground, seen from anywhere, stands for its six pictures.
static alp_result sample_by_faces(alp_ambience *ambience, const alp_ambience_camera *camera)
{
    static float pixels[6][SIDE * SIDE][3]; // rows of the sides run from the top down
    const float *faces[6];
    alp_ambience_request request;
    const alp_result result = alp_ambience_next(ambience, camera, &request);
    if (result != ALP_OK || request.id == 0) { // 0: nothing is wanted
        return result;
    }
    for (int face = 0; face < 6; face++) {
        faces[face] = pixels[face][0];
        for (int i = 0; i < SIDE * SIDE; i++) {
            const int above =
                face == ALP_CUBE_POSITIVE_Y || (face != ALP_CUBE_NEGATIVE_Y && i < SIDE * SIDE / 2);
            pixels[face][i][0] = pixels[face][i][1] = pixels[face][i][2] = above ? 8e3f : 1e3f;
        }
    }
    return alp_ambience_submit_faces(ambience, request.id, SIDE, faces);
}

/// Lights the top of an object: E by the library, and by its shader. Any thread may.
static void light_object(alp_ambience *ambience, const double object[1][3], float e[2][3])
{
    static const float up[1][3] = {{0.0f, 1.0f, 0.0f}};
    float vectors[12][4]; // uniforms of a shader
    alp_sh9 light;
    const alp_ambience_snapshot *now = alp_ambience_begin_read(ambience);
    alp_ambience_irradiance(now, 1, object, up, e);
    alp_ambience_coefficients(now, object[0], &light);
    alp_ambience_end_read(ambience, now);
    alp_sh_shader_vectors(&light, vectors);
    alp_sh_shader_irradiance(vectors[0], up[0], e[1]);
}

static alp_result play(alp_camera view, alp_ambience *ambience, alp_ambience_sampler *sampler)
{
    alp_ambience_camera camera = {.vfov = (double)view.vertical_fov};
    alp_result result = ALP_OK;
    for (int frame = 0; frame <= SECONDS * FRAMES && result == ALP_OK; frame++) {
        const double time = (double)frame / FRAMES;
        double object[1][3];
        float e[2][3];
        for (int k = 0; k < 3; k++) { // a twentieth of the way to the target each second
            camera.forward[k] = (double)view.target[k] - (double)view.position[k];
            camera.velocity[k] = 0.05 * camera.forward[k];
            camera.position[k] = (double)view.position[k] + time * camera.velocity[k];
            object[0][k] = camera.position[k] + 0.02 * camera.forward[k];
        }
        result = frame == 0 ? alp_ambience_sampler_warm(sampler, &camera, time, BOUNCES)
                            : alp_ambience_update(ambience, time);
        result = result       ? result // one anchor by pictures, for show; the others by rays
                 : frame == 1 ? sample_by_faces(ambience, &camera)
                              : alp_ambience_sample(sampler, &camera, SAMPLES, 0.0, NULL);
        light_object(ambience, (const double(*)[3])object, e);
        if (frame > 0 && frame % FRAMES == 0) {
            printf("%.0f s: %u anchors, object lit by %.0f lux, in the shader %.0f lux\n", time,
                   alp_ambience_get_info(ambience).anchors, (double)e[0][1], (double)e[1][1]);
        }
    }
    return result;
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_ambience *volume = NULL;
    alp_ambience_sampler *rays = NULL;
    alp_ambience_sampler_options options = alp_ambience_sampler_options_default();
    options.lighting.sky.kind = ALP_SKY_CLEAR;
    options.lighting.sun.elevation = 0.6f; // radians
    options.lighting.sun.illuminance = 60000.0f;
    alp_result result = alp_context_create(NULL, &context);
    result = result ? result : alp_scene_load(context, "builtin:terrain", &scene);
    result = result ? result : alp_ambience_create(context, NULL, &volume);
    result = result ? result : alp_ambience_sampler_create(volume, scene, &options, &rays);
    result = result ? result : play(alp_scene_get_camera(scene, 0), volume, rays);
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(context));
    }
    alp_ambience_sampler_destroy(rays);
    alp_ambience_destroy(volume);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
