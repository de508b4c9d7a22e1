// SPDX-License-Identifier: MIT
#include "maps/radiosity/acceleration.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

alp_result alpi_acceleration_create(alp_context *context, size_t patches, alpi_acceleration *a)
{
    *a = (alpi_acceleration){0};
    for (int d = 0; d < ALPI_ACCELERATION_DEPTH; d++) {
        ALPI_TRY_NEW(context, a->results[d], patches);
        ALPI_TRY_NEW(context, a->residuals[d], patches);
    }
    return ALP_OK;
}

void alpi_acceleration_destroy(alp_context *context, alpi_acceleration *a)
{
    for (int d = 0; d < ALPI_ACCELERATION_DEPTH; d++) {
        alpi_release(context, a->results[d]);
        alpi_release(context, a->residuals[d]);
    }
    *a = (alpi_acceleration){0};
}

typedef struct products_job {
    const alpi_acceleration *a;
    const alpi_radiosity *radiosity;
} products_job;

/// Sums of products of the residual f and dᵢ = f − fᵢ, by area: f·d₀, f·d₁, d₀·d₀, d₀·d₁,
/// d₁·d₁.
static void sum_products(const void *user, uint32_t begin, uint32_t end,
                         double sums[ALPI_SUM_LIMIT])
{
    const products_job *job = user;
    const alpi_radiosity *r = job->radiosity;
    const uint32_t fronts = r->patches.patch_count;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t b = r->receivers[i];
        const double area = r->patches.patch_areas[b >= fronts ? b - fronts : b];
        for (int k = 0; k < 3; k++) {
            const double f = (double)r->bounced[b].mean[k] - (double)r->before[b][k];
            const double d0 = f - (double)job->a->residuals[0][b][k];
            const double d1 = f - (double)job->a->residuals[1][b][k];
            sums[0] += area * f * d0;
            sums[1] += area * f * d1;
            sums[2] += area * d0 * d0;
            sums[3] += area * d0 * d1;
            sums[4] += area * d1 * d1;
        }
    }
}

/// Shares γ of the earlier passes that minimize |f − γ₀ d₀ − γ₁ d₁|.
static void find_shares(const double sums[ALPI_SUM_LIMIT], uint32_t count, double shares[2])
{
    const double determinant = sums[2] * sums[4] - sums[3] * sums[3];
    shares[0] = shares[1] = 0.0;
    if (count > 1 && determinant > 1e-6 * sums[2] * sums[4]) {
        shares[0] = (sums[0] * sums[4] - sums[1] * sums[3]) / determinant;
        shares[1] = (sums[1] * sums[2] - sums[0] * sums[3]) / determinant;
    } else if (count > 0 && sums[2] > 0.0) {
        shares[0] = sums[0] / sums[2];
    }
}

alp_result alpi_acceleration_mix(alpi_acceleration *a, alpi_radiosity *radiosity,
                                 const alpi_task_progress *progress)
{
    alpi_radiosity *r = radiosity;
    const products_job job = {a, r};
    double sums[ALPI_SUM_LIMIT] = {0.0}, shares[2];
    ALP_TRY(alpi_parallel_sum(r->options.context, r->receiver_count, sum_products, &job, progress,
                              sums));
    find_shares(sums, a->count, shares);
    for (uint32_t i = 0; i < r->receiver_count; i++) {
        const uint32_t b = r->receivers[i];
        for (int k = 0; k < 3; k++) {
            const float g = r->bounced[b].mean[k], f = g - r->before[b][k];
            const double older[2] = {(double)(g - a->results[0][b][k]),
                                     (double)(g - a->results[1][b][k])};
            const double next = (double)g - shares[0] * older[0] - shares[1] * older[1];
            a->results[1][b][k] = a->results[0][b][k];
            a->residuals[1][b][k] = a->residuals[0][b][k];
            a->results[0][b][k] = g;
            a->residuals[0][b][k] = f;
            r->bounced[b].mean[k] = (float)fmax(next, 0.0);
        }
    }
    a->count += a->count < ALPI_ACCELERATION_DEPTH ? 1 : 0;
    return ALP_OK;
}
