// SPDX-License-Identifier: MIT
// What a bake will take, as the command tells it: two digits, as it is a guess.
#include "work.h"

#include "output.h"

#include <math.h>

/// 47,000; 2,100,000
static void print_count(FILE *stream, double count)
{
    if (count >= 1e6) {
        fprintf(stream, "%.0f,%03.0f,000", floor(count / 1e6), fmod(count, 1e6) / 1e3);
    } else if (count >= 1e3) {
        fprintf(stream, "%.0f,%03.0f", floor(count / 1e3), fmod(count, 1e3));
    } else {
        fprintf(stream, "%.0f", count);
    }
}

void work_print(FILE *stream, const alp_bake_work *work)
{
    fputs("about ", stream);
    print_count(stream, two_digits((double)work->texels));
    fprintf(stream, " texels, %g Mrays, %.0f MiB, ", two_digits(1e-6 * (double)work->rays),
            ceil(two_digits((double)work->bytes / 0x1p20)));
    if (work->seconds < 1.0) {
        fputs("under 1 s\n", stream);
    } else {
        fprintf(stream, "%g s\n", two_digits(work->seconds));
    }
}

json_t *work_json(const alp_bake_work *work)
{
    return json_pack("{s:I, s:I, s:I, s:o}", "texels", (json_int_t)work->texels, "rays",
                     (json_int_t)work->rays, "bytes", (json_int_t)work->bytes, "seconds",
                     json_number(work->seconds));
}
