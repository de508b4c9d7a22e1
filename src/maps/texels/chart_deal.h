// SPDX-License-Identifier: MIT
// Sorts lists of texels by chart. Charts face different directions, and packets of rays in
// different directions are slow.
#ifndef ALPI_MAPS_CHART_DEAL_H
#define ALPI_MAPS_CHART_DEAL_H

#include "base/context.h"

/// A counting sort: clear, count each texel, start, then read the place of each texel once. Texels
/// of a chart keep their order.
typedef struct alpi_chart_deal {
    alp_context *context;
    const uint32_t *charts; // [texels]
    uint32_t first, count;  // charts
    uint32_t *places;       // [count] texels of each chart, then the place of its next one
} alpi_chart_deal;

/// Allocates for the charts of some texels. Time and memory grow with these texels, and with the
/// difference between their least and greatest chart.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_chart_deal_open(alp_context *context, const uint32_t *charts,
                                const uint32_t *texels, uint32_t texel_count,
                                alpi_chart_deal *deal);
void alpi_chart_deal_close(alpi_chart_deal *deal); ///< zeroed: does nothing

void alpi_chart_deal_clear(alpi_chart_deal *deal);
static inline void alpi_chart_deal_count(alpi_chart_deal *deal, uint32_t texel)
{
    deal->places[deal->charts[texel] - deal->first]++;
}
/// Begins the places, after all texels are counted. @return their number
uint32_t alpi_chart_deal_start(alpi_chart_deal *deal);
static inline uint32_t alpi_chart_deal_place(alpi_chart_deal *deal, uint32_t texel)
{
    return deal->places[deal->charts[texel] - deal->first]++;
}

#endif
