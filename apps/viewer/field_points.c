// SPDX-License-Identifier: MIT
#include "field_points.h"

#include <pthread.h>
#include <stdatomic.h>

enum { CHUNK = 1024, WORKER_LIMIT = 64 };

typedef struct point_job {
    const alp_field *field;
    uint32_t count;
    const float (*positions)[3], (*normals)[3];
    float (*irradiance)[3];
    atomic_uint next; // chunk
} point_job;

static void *read_chunks(void *user)
{
    point_job *job = user;
    const uint32_t chunks = job->count / CHUNK + (job->count % CHUNK != 0);
    for (uint32_t c = atomic_fetch_add(&job->next, 1); c < chunks;
         c = atomic_fetch_add(&job->next, 1)) {
        const uint32_t first = c * CHUNK, left = job->count - first;
        alp_field_irradiance(job->field, left < CHUNK ? left : CHUNK, job->positions + first,
                             job->normals + first, job->irradiance + first);
    }
    return NULL;
}

void field_points_read(const alp_field *field, uint32_t workers, uint32_t count,
                       const float (*positions)[3], const float (*normals)[3],
                       float (*irradiance)[3])
{
    pthread_t threads[WORKER_LIMIT];
    point_job job = {field, count, positions, normals, irradiance, 0};
    const uint32_t helpers = workers < WORKER_LIMIT ? workers - 1 : WORKER_LIMIT;
    uint32_t made = 0;
    while (made < helpers && made < count / CHUNK &&
           pthread_create(&threads[made], NULL, read_chunks, &job) == 0) {
        made++;
    }
    read_chunks(&job);
    for (uint32_t i = 0; i < made; i++) {
        pthread_join(threads[i], NULL);
    }
}
