// SPDX-License-Identifier: MIT
// compare_peer OURS OURS THEIRS THEIRS SCALE BIAS RMSE: whether two renderers mean the same light,
// each given as two maps that differ in their seed alone. Ours are multiplied by SCALE. Prints the
// bias of the mean by channel and the root mean square difference over the mean, less what the
// noise of either adds; exits with 1 when one of them is above BIAS or RMSE (both relative).
#include <alpenglow/alpenglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Sums over the texels that all four maps cover.
typedef struct sums {
    double ours[3], theirs[3]; // of the means of the two seeds
    double difference;         // squares, of these means
    double noise[2];           // squares, of half the difference of the seeds: variance of the mean
    uint64_t texels;
} sums;

static sums add_up(float *const maps[4], uint64_t count, double scale)
{
    sums s = {.texels = 0};
    for (uint64_t i = 0; i < count; i++) {
        bool covered = true;
        for (int m = 0; m < 4; m++) {
            covered = covered && maps[m][4 * i + 3] > 0.5f;
        }
        for (uint64_t k = 0; covered && k < 3; k++) {
            const double a = (double)maps[0][4 * i + k] * scale,
                         b = (double)maps[1][4 * i + k] * scale, c = (double)maps[2][4 * i + k],
                         d = (double)maps[3][4 * i + k];
            const double ours = 0.5 * (a + b), theirs = 0.5 * (c + d);
            s.ours[k] += ours;
            s.theirs[k] += theirs;
            s.difference += (ours - theirs) * (ours - theirs);
            s.noise[0] += 0.25 * (a - b) * (a - b);
            s.noise[1] += 0.25 * (c - d) * (c - d);
        }
        s.texels += covered;
    }
    return s;
}

/// @return 0: within the limits
static int report(const sums *s, double bias_limit, double rmse_limit)
{
    const double values = 3.0 * (double)s->texels;
    const double mean = (s->theirs[0] + s->theirs[1] + s->theirs[2]) / values;
    const double ours = s->noise[0] / values, theirs = s->noise[1] / values;
    const double left = s->difference / values - ours - theirs;
    const double rmse = sqrt(fmax(left, 0.0)) / mean;
    int failed = !(rmse <= rmse_limit);
    printf("%llu texels, noise %.2f %% and %.2f %%, rmse without it %.2f %%, bias",
           (unsigned long long)s->texels, 100.0 * sqrt(ours) / mean, 100.0 * sqrt(theirs) / mean,
           100.0 * rmse);
    for (int k = 0; k < 3; k++) {
        const double bias = s->ours[k] / s->theirs[k] - 1.0;
        failed |= !(fabs(bias) <= bias_limit);
        printf(" %+.2f %%", 100.0 * bias);
    }
    printf("\n");
    return failed;
}

int main(int count, char **arguments)
{
    alp_context *context = NULL;
    alp_image *images[4] = {NULL};
    float *maps[4] = {NULL};
    if (count != 8 || alp_context_create(NULL, &context) != ALP_OK) {
        fprintf(stderr, "compare_peer OURS OURS THEIRS THEIRS SCALE BIAS RMSE\n");
        return 2;
    }
    int failed = 0;
    for (int i = 0; i < 4 && !failed; i++) {
        failed = alp_image_load(context, arguments[1 + i], &images[i]) != ALP_OK;
        if (failed) {
            fprintf(stderr, "%s\n", alp_context_message(context));
        } else {
            const alp_image_info a = alp_image_get_info(images[i]),
                                 b = alp_image_get_info(images[0]);
            failed = a.width != b.width || a.height != b.height || a.channels != 4;
            maps[i] = alp_image_floats(images[i]);
            failed = failed || maps[i] == NULL;
        }
    }
    if (!failed) {
        const alp_image_info info = alp_image_get_info(images[0]);
        const sums s = add_up(maps, (uint64_t)info.width * info.height, strtod(arguments[5], NULL));
        failed = report(&s, strtod(arguments[6], NULL), strtod(arguments[7], NULL));
    }
    for (int i = 0; i < 4; i++) {
        alp_image_destroy(images[i]);
    }
    alp_context_destroy(context);
    return failed;
}
