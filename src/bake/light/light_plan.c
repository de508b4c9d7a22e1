// SPDX-License-Identifier: MIT
#include "bake/light/light_plan.h"

#include <math.h>

/// How many times the samples there are, added to them, bring an error down to what is wanted: it
/// falls with a power of their number.
static double more_samples(double error, double wanted, double power)
{
    return error > wanted ? fmax(1.1 * pow(error / wanted, 1.0 / power) - 1.0, 0.25) : 0.0;
}

double alpi_light_power(double had, double foreseen, double error)
{
    const double least = 0.5, most = 0.75;
    const bool shown = foreseen > 0.0 && foreseen < 0.9 && error > 0.0;
    return shown ? fmin(fmax(had * log(error) / log(foreseen), least), most) : had;
}

/// @param share of the squared error, that bounced light may have
static alpi_light_plan plan_for(const alpi_light_effort *e, const alpi_light_noise *noise,
                                double aim, double share)
{
    // A bounced ray takes as long as two or three of shadow (measured: 1.9 to 5).
    const double dear = 2.5 / e->draw;
    const double falls[2] = {e->direct_power, e->rays_power};
    alpi_light_plan p = {.for_direct = sqrt(1.0 - share) * aim, .noisy = noise->noisy};
    p.direct = more_samples(noise->direct, p.for_direct, falls[0]) * e->direct;
    p.rays = more_samples(noise->bounced, sqrt(share) * aim, falls[1]) * e->rays;
    p.cost = noise->noisy * e->texels * p.direct + dear * e->traced * p.rays;
    p.direct = fmin(p.direct, fmin(15.0 * e->direct, e->most - e->direct));
    p.rays = fmin(p.rays, fmin(15.0 * e->rays, e->most - e->rays));
    return p;
}

alpi_light_plan alpi_light_cheapest(const alpi_light_effort *effort, const alpi_light_noise *noise,
                                    double aim)
{
    // Many ways to share it out, and those in which one has as much of it as it has already.
    enum { WAYS = 32 };
    const double b = noise->bounced / aim, d = noise->direct / aim;
    const double as_they_are[2] = {b * b, 1.0 - d * d};
    alpi_light_plan best = plan_for(effort, noise, aim, 0.5);
    for (int i = 1; i < WAYS + 2; i++) {
        const double share = i < WAYS ? (double)i / WAYS : as_they_are[i - WAYS];
        if (share > 0.0 && share < 1.0) {
            const alpi_light_plan p = plan_for(effort, noise, aim, share);
            best = p.cost < best.cost ? p : best;
        }
    }
    return best;
}
