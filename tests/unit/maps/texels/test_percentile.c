// SPDX-License-Identifier: MIT
// Percentiles of values at texels, against a sort.
#include "base/context.h"
#include "maps/texels/relative_error.h"
#include "test_support.h"

#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    return *(const float *)a < *(const float *)b ? -1 : *(const float *)a > *(const float *)b;
}

TEST_WITH_CONTEXT(percentiles_are_those_of_a_sort, 1)
{
    enum { COUNT = 1000 };
    float values[COUNT], sorted[COUNT];
    uint32_t order[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        values[i] = i % 7 == 0 ? 0.0f : (float)(i * 37 % 1009) * 1e-4f;
        sorted[i] = values[i];
        order[i] = COUNT - 1 - i;
    }
    qsort(sorted, COUNT, sizeof *sorted, ascending);
    const double shares[] = {0.0, 0.1, 0.5, 0.99, 1.0};
    for (int i = 0; i < 5; i++) {
        double value = -1.0;
        ASSERT_OK(context, alpi_percentile(context, values, order, COUNT, shares[i], &value));
        ASSERT_NEAR(value, sorted[(int)(shares[i] * (COUNT - 1))], 0.0);
    }
    double none = -1.0;
    ASSERT_OK(context, alpi_percentile(context, values, order, 0, 0.99, &none));
    ASSERT_NEAR(none, 0.0, 0.0);
}
