// SPDX-License-Identifier: MIT
// The estimated work of a bake, in two digits.
#include "printing/work.h"

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
    fprintf(stream, " texels, %g Mrays%s, %.0f MiB\n", two_digits(1e-6 * (double)work->rays),
            work->rays_at_least ? " or more" : "", ceil(two_digits((double)work->bytes / 0x1p20)));
}

json_t *work_json(const alp_bake_work *work)
{
    return json_pack("{s:I, s:I, s:b, s:I}", "texels", (json_int_t)work->texels, "rays",
                     (json_int_t)work->rays, "rays_at_least", (int)work->rays_at_least, "bytes",
                     (json_int_t)work->bytes);
}
