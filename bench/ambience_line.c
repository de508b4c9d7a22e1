// SPDX-License-Identifier: MIT
#include "ambience_line.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = LINE_STEPS + 1 };

void ambience_line_open(const ambience_world *world, double time, ambience_line *line)
{
    *line = (ambience_line){.positions = bench_allocate(COUNT, sizeof *line->positions),
                            .normals = bench_allocate(COUNT, sizeof *line->normals),
                            .ours = bench_allocate(COUNT, sizeof *line->ours),
                            .conformance = bench_allocate(COUNT, sizeof *line->conformance)};
    for (int i = 0; i < COUNT; i++) {
        const double metres = LINE_METRES * ((double)i / LINE_STEPS - 0.5);
        alp_ambience_camera camera;
        ambience_world_fly(world, 0, time + metres / WORLD_SPEED, &camera);
        const double length = hypot(camera.forward[0], camera.forward[2]);
        for (int k = 0; k < 3; k++) {
            line->positions[i][k] = camera.position[k];
        }
        line->normals[i][0] = (float)(-camera.forward[2] / length);
        line->normals[i][2] = (float)(camera.forward[0] / length);
    }
}

void ambience_line_close(ambience_line *line)
{
    free(line->positions);
    free(line->normals);
    free(line->ours);
    free(line->conformance);
    *line = (ambience_line){0};
}

static float mean(const float e[3])
{
    return (e[0] + e[1] + e[2]) / 3.0f;
}

void ambience_line_read(const alp_ambience_snapshot *snapshot, ambience_line *line)
{
    float(*values)[3] = bench_allocate(COUNT, sizeof *values);
    for (int view = 0; view < 2; view++) {
        float *to = view == 0 ? line->ours : line->conformance;
        ambience_view_read(snapshot, view == 0 ? VIEW_OURS : VIEW_CONFORMANCE, COUNT,
                           (const double(*)[3])line->positions, (const float(*)[3])line->normals,
                           values);
        for (int i = 0; i < COUNT; i++) {
            to[i] = mean(values[i]);
        }
    }
    free(values);
}

bool ambience_line_trace(const ambience_world *world, uint32_t paths, ambience_line *line)
{
    float places[LINE_TRUTHS][3], normals[LINE_TRUTHS][3], truth[LINE_TRUTHS][3];
    alp_reference_options o = alp_reference_options_default();
    o.lighting = world->light;
    o.samples = paths;
    for (int i = 0; i < LINE_TRUTHS; i++) {
        const int at = i * LINE_STEPS / (LINE_TRUTHS - 1);
        for (int k = 0; k < 3; k++) {
            places[i][k] = (float)line->positions[at][k];
            normals[i][k] = line->normals[at][k];
        }
    }
    const alp_result result =
        alp_reference_irradiance(world->scene.scene, &o, LINE_TRUTHS, (const float(*)[3])places,
                                 (const float(*)[3])normals, truth, NULL);
    for (int i = 0; i < LINE_TRUTHS && result == ALP_OK; i++) {
        line->truth[i] = mean(truth[i]);
    }
    return bench_good(&world->scene, result);
}

double ambience_line_jump(const float *values)
{
    double most = 0.0;
    for (int i = 0; i < LINE_STEPS; i++) {
        most = fmax(most, fabs((double)values[i + 1] - (double)values[i]));
    }
    return most;
}
