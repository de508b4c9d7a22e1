// SPDX-License-Identifier: MIT
// Plots of the page about a bake, as SVG. Only lines and areas are stretched with the page; words
// stand beside them as text wherever they can, so that they stay readable on a narrow one.
#include "report/report_parts.h"

#include <math.h>

// --- time per stage ------------------------------------------------------------------------------

void alpi_plot_stages(alpi_page *page, const alpi_report_stage *stages, size_t count, double total)
{
    double left = 0.0;
    alpi_page_put(page, "<svg class=\"bar\" viewBox=\"0 0 1000 20\" preserveAspectRatio=\"none\" "
                        "role=\"img\" aria-label=\"Time per stage\">\n");
    for (size_t i = 0; i < count; i++) {
        const double width = total > 0.0 ? 1000.0 * stages[i].seconds / total : 0.0;
        alpi_page_format(page,
                         "<rect x=\"%s\" y=\"0\" width=\"%s\" height=\"20\" fill=\"%s\">"
                         "<title>%s</title></rect>\n",
                         alpi_fixed(left, 2).text, alpi_fixed(width, 2).text, stages[i].color,
                         stages[i].name);
        left += width;
    }
    alpi_page_put(page, "</svg>\n<table class=\"stages\"><tbody>\n");
    for (size_t i = 0; i < count; i++) {
        const double share = total > 0.0 ? stages[i].seconds / total : 0.0;
        alpi_page_format(page,
                         "<tr><th scope=\"row\"><i class=\"swatch\" style=\"background:%s\"></i>"
                         "%s</th><td>%s</td><td>%s\u00A0%%</td></tr>\n",
                         stages[i].color, stages[i].name, alpi_duration(stages[i].seconds).text,
                         alpi_fixed(100.0 * share, 1).text);
    }
    alpi_page_format(page,
                     "<tr class=\"sum\"><th scope=\"row\">Total</th><td>%s</td><td></td></tr>\n"
                     "</tbody></table>\n",
                     alpi_duration(total).text);
}

// --- convergence ---------------------------------------------------------------------------------

enum { PLOT_WIDTH = 520, PLOT_HEIGHT = 250, PLOT_LEFT = 74, PLOT_TOP = 14 };
enum { PLOT_RIGHT = PLOT_WIDTH - 14, PLOT_BOTTOM = PLOT_HEIGHT - 44 };

/// Decades that hold all changes.
typedef struct decades {
    int low, high;
} decades;

static decades find_decades(const float *changes, uint32_t count)
{
    double least = HUGE_VAL, most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double change = (double)changes[i];
        if (change > 0.0 && isfinite(change)) {
            least = fmin(least, change);
            most = fmax(most, change);
        }
    }
    if (!(most > 0.0)) {
        return (decades){-3, 0};
    }
    decades d = {(int)floor(log10(least)), (int)ceil(log10(most))};
    d.high = d.high > d.low ? d.high : d.low + 1;
    d.low = d.low > d.high - 16 ? d.low : d.high - 16;
    return d;
}

static double plot_x(uint32_t pass, uint32_t count)
{
    const double share = count > 1 ? (double)pass / (double)(count - 1) : 0.5;
    return PLOT_LEFT + 8 + share * (PLOT_RIGHT - PLOT_LEFT - 16);
}

static double plot_y(double change, decades d)
{
    const double least = pow(10.0, d.low);
    const double share = (log10(fmax(change, least)) - d.low) / (d.high - d.low);
    return PLOT_BOTTOM - fmin(share, 1.0) * (PLOT_BOTTOM - PLOT_TOP);
}

static void put_axes(alpi_page *page, decades d, uint32_t count)
{
    const int step = (d.high - d.low + 5) / 6;
    for (int decade = d.low; decade <= d.high; decade += step) {
        const double y = plot_y(pow(10.0, decade), d);
        const bool is_percent = decade >= -4 && decade <= 1;
        alpi_page_format(page,
                         "<line class=\"grid\" x1=\"%d\" x2=\"%d\" y1=\"%s\" y2=\"%s\"/>"
                         "<text x=\"%d\" y=\"%s\" text-anchor=\"end\">%s\u00A0%%</text>\n",
                         PLOT_LEFT, PLOT_RIGHT, alpi_fixed(y, 1).text, alpi_fixed(y, 1).text,
                         PLOT_LEFT - 8, alpi_fixed(y + 4.5, 1).text,
                         (is_percent
                              ? alpi_fixed(pow(10.0, decade + 2), decade < -2 ? -2 - decade : 0)
                              : alpi_significant(pow(10.0, decade + 2), 1))
                             .text);
    }
    const uint32_t every = (count + 9) / 10;
    for (uint32_t pass = 0; pass < count; pass += every) {
        alpi_page_format(page, "<text x=\"%s\" y=\"%d\" text-anchor=\"middle\">%u</text>\n",
                         alpi_fixed(plot_x(pass, count), 1).text, PLOT_BOTTOM + 19, pass + 1);
    }
    alpi_page_format(page, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">bounce</text>\n",
                     PLOT_RIGHT, PLOT_HEIGHT - 6);
}

void alpi_plot_passes(alpi_page *page, const float *changes, uint32_t count)
{
    enum { DOTS = 64 }; // more would be a band
    const decades d = find_decades(changes, count);
    alpi_page_format(page,
                     "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" "
                     "aria-label=\"Mean change of the light by bounce\">\n",
                     PLOT_WIDTH, PLOT_HEIGHT);
    put_axes(page, d, count);
    alpi_page_put(page, "<polyline class=\"curve\" points=\"");
    for (uint32_t i = 0; i < count; i++) {
        alpi_page_format(page, "%s%s,%s", i > 0 ? " " : "", alpi_fixed(plot_x(i, count), 1).text,
                         alpi_fixed(plot_y((double)changes[i], d), 1).text);
    }
    alpi_page_put(page, "\"/>\n");
    for (uint32_t i = 0; i < count && count <= DOTS; i++) {
        alpi_page_format(page,
                         "<circle cx=\"%s\" cy=\"%s\" r=\"3.5\"><title>bounce %u: %s</title>"
                         "</circle>\n",
                         alpi_fixed(plot_x(i, count), 1).text,
                         alpi_fixed(plot_y((double)changes[i], d), 1).text, i + 1,
                         alpi_percent((double)changes[i]).text);
    }
    alpi_page_put(page, "</svg>\n");
}

// --- the colours of a heat map -------------------------------------------------------------------

void alpi_plot_heat_scale(alpi_page *page, double top, uint32_t id)
{
    enum { STOPS = 20 };
    alpi_page_format(page,
                     "<div class=\"scale\"><svg viewBox=\"0 0 100 10\" "
                     "preserveAspectRatio=\"none\" aria-hidden=\"true\"><defs>"
                     "<linearGradient id=\"heat%u\">",
                     id);
    for (int i = 0; i <= STOPS; i++) {
        uint8_t rgb[3];
        alpi_heat_color((float)i / STOPS, rgb);
        alpi_page_format(page, "<stop offset=\"%d%%\" stop-color=\"#%02x%02x%02x\"/>",
                         100 * i / STOPS, rgb[0], rgb[1], rgb[2]);
    }
    alpi_page_format(page,
                     "</linearGradient></defs><rect width=\"100\" height=\"10\" "
                     "fill=\"url(#heat%u)\"/></svg>"
                     "<p><span>0</span><span>%s</span><span>≥\u00A0%s</span></p></div>\n",
                     id, alpi_percent(0.5 * top).text, alpi_percent(top).text);
}
