// SPDX-License-Identifier: MIT
// Lists of texels chart by chart: charts look in different directions, and rays in different
// directions are slow company. Where few texels of a page are listed, eight that follow each other
// would often be of several charts.
#ifndef ALPI_MAPS_CHART_DEAL_H
#define ALPI_MAPS_CHART_DEAL_H

#include "base/context.h"

/// Places of the texels of each chart in a list: clear, count every texel, start, then ask for the
/// place of every texel once more. Texels of a chart keep their order.
typedef struct alpi_chart_deal {
    alp_context *context;
    const uint32_t *charts; // [texels]
    uint32_t first, count;  // charts
    uint32_t *places;       // [count] texels of each, then the next one's place
} alpi_chart_deal;

/// Readies for the charts of some texels: it costs as much as these, and as the numbers
/// from the least of their charts to the greatest.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_chart_deal_open(alp_context *context, const uint32_t *charts,
                                const uint32_t *texels, uint32_t texel_count,
                                alpi_chart_deal *deal);
void alpi_chart_deal_close(alpi_chart_deal *deal); ///< nothing for one that was zeroed

void alpi_chart_deal_clear(alpi_chart_deal *deal);
static inline void alpi_chart_deal_count(alpi_chart_deal *deal, uint32_t texel)
{
    deal->places[deal->charts[texel] - deal->first]++;
}
/// After the last was counted. @return how many there are
uint32_t alpi_chart_deal_start(alpi_chart_deal *deal);
static inline uint32_t alpi_chart_deal_place(alpi_chart_deal *deal, uint32_t texel)
{
    return deal->places[deal->charts[texel] - deal->first]++;
}

#endif
