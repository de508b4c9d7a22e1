// SPDX-License-Identifier: MIT
// The maps of a bake on its page, each beside the heat map of its errors.
#include "report/report_parts.h"

#include <math.h>

static const struct {
    const char *title, *alt;
    alp_map map;               // that must have been asked for
    alpi_report_picture error; // or COUNT: none
} shown_maps[ALPI_PICTURE_COUNT] = {
    [ALPI_PICTURE_AO] = {"Ambient occlusion", "Map of ambient occlusion", ALP_MAP_AO,
                         ALPI_PICTURE_AO_ERROR},
    [ALPI_PICTURE_BENT] = {"Bent normals", "Map of bent normals", ALP_MAP_BENT, ALPI_PICTURE_COUNT},
    [ALPI_PICTURE_OBSCURANCE] = {"Coloured obscurance", "Map of coloured obscurance",
                                 ALP_MAP_OBSCURANCE, ALPI_PICTURE_COUNT},
    [ALPI_PICTURE_LIGHT] = {"Irradiance", "Map of irradiance", ALP_MAP_LIGHT,
                            ALPI_PICTURE_LIGHT_ERROR}};

static void put_picture(alpi_page *page, const alpi_report_pictures *pictures,
                        alpi_report_picture kind, uint32_t number, const char *alt)
{
    alp_image *picture = NULL;
    if (page->result == ALP_OK) {
        page->result = alpi_report_paint(pictures, kind, number, &picture);
    }
    if (page->result == ALP_OK) {
        alpi_page_put(page, "<figure>");
        alpi_page_picture(page, picture, alt);
        alpi_page_put(page, "\n");
    }
    alp_image_destroy(picture);
}

/// What the colours of a map stand for.
static void put_meaning(alpi_page *page, const alpi_report_pictures *pictures,
                        alpi_report_picture kind)
{
    switch (kind) {
    case ALPI_PICTURE_BENT:
        alpi_page_put(page, "The mean open direction in world space, n\u00A0/\u00A02 + 1/2.");
        break;
    case ALPI_PICTURE_OBSCURANCE:
        alpi_page_put(page, "What occludes counts with its colour; linear values as bytes.");
        break;
    case ALPI_PICTURE_LIGHT:
        alpi_page_format(page,
                         "E in W/m², shown by the film curve 1 − e<sup>−L</sup> in sRGB; exposure: "
                         "L = 2<sup>%s%s</sup>\u00A0E.",
                         pictures->exposure < 0.0 ? "−" : "",
                         alpi_fixed(fabs(pictures->exposure), 2).text);
        break;
    default:
        alpi_page_put(page, "Accessibility: white is open, black is closed; linear values as "
                            "bytes.");
    }
}

static void put_heat_map(alpi_page *page, const alpi_report_pictures *pictures,
                         alpi_report_picture kind, uint32_t number)
{
    if (!(pictures->tops[kind] > 0.0)) {
        return; // no error is known, or the map is black
    }
    put_picture(page, pictures, kind, number, "Heat map of the standard error");
    alpi_plot_heat_scale(page, pictures->tops[kind], ALPI_PICTURE_COUNT * number + kind);
    alpi_page_format(page, "<figcaption><b>Error of %s</b>",
                     kind == ALPI_PICTURE_AO_ERROR ? "ambient occlusion" : "irradiance");
    if (number == 0) {
        alpi_page_format(page, "Standard error of each texel over the mean of the map, %s.",
                         alpi_significant(pictures->means[kind], 4).text);
    }
    alpi_page_put(page, "</figcaption></figure>\n");
}

/// Of each page.
static unsigned count_pictures(unsigned maps, const alpi_report_pictures *pictures)
{
    unsigned count = 0;
    for (alpi_report_picture kind = 0; kind < ALPI_PICTURE_COUNT; kind++) {
        const alpi_report_picture error = shown_maps[kind].error;
        if ((maps & (unsigned)shown_maps[kind].map) != 0) {
            count += error != ALPI_PICTURE_COUNT && pictures->tops[error] > 0.0 ? 2 : 1;
        }
    }
    return count;
}

static void put_page(alpi_page *page, unsigned maps, const alpi_report_pictures *pictures,
                     uint32_t number)
{
    const alp_lightmap *l = pictures->lightmap;
    const bool is_first = number == 0; // says what the colours mean; the others have less room
    if (l->page_count > 1) {
        alpi_page_format(page, "<div><h3>Page %u</h3>\n", number);
    }
    alpi_page_put(page, "<div class=\"plates\">\n");
    for (alpi_report_picture kind = 0; kind < ALPI_PICTURE_COUNT; kind++) {
        if ((maps & (unsigned)shown_maps[kind].map) == 0) {
            continue;
        }
        put_picture(page, pictures, kind, number, shown_maps[kind].alt);
        alpi_page_format(page, "<figcaption><b>%s</b>", shown_maps[kind].title);
        if (is_first) {
            put_meaning(page, pictures, kind);
        }
        alpi_page_put(page, "</figcaption></figure>\n");
        if (shown_maps[kind].error != ALPI_PICTURE_COUNT) {
            put_heat_map(page, pictures, shown_maps[kind].error, number);
        }
    }
    alpi_page_put(page, l->page_count > 1 ? "</div></div>\n" : "</div>\n");
}

void alpi_report_put_maps(alpi_page *page, const alp_bake_report *report,
                          const alpi_report_pictures *pictures)
{
    const alp_lightmap *l = pictures->lightmap;
    const uint32_t longest = l->width > l->height ? l->width : l->height;
    alpi_page_put(page, "<section id=\"maps\"><h2>Maps</h2>\n");
    if (l->page_count > 1) {
        alpi_page_format(
            page,
            "<p class=\"note\">%u pages, numbered from 0 as in the names of files.</p>\n"
            "<div class=\"pages\" style=\"--pictures:%u\">\n",
            l->page_count, count_pictures(report->maps, pictures));
    }
    for (uint32_t i = 0; i < pictures->page_count && page->result == ALP_OK; i++) {
        put_page(page, report->maps, pictures, i);
    }
    alpi_page_put(page, l->page_count > 1 ? "</div>\n" : "");
    if (pictures->page_count < l->page_count) {
        alpi_page_format(page, "<p class=\"note\">The first %u of %u pages are shown.</p>\n",
                         pictures->page_count, l->page_count);
    }
    if (longest > ALPI_REPORT_SIDE) {
        const uint32_t step = (longest + ALPI_REPORT_SIDE - 1) / ALPI_REPORT_SIDE;
        alpi_page_format(page,
                         "<p class=\"note\">Pages have %u × %u texels; a pixel here is the mean "
                         "of the covered ones of %u × %u.</p>\n",
                         l->width, l->height, step, step);
    }
    const bool is_black = (report->maps & ALP_MAP_LIGHT) != 0 && !(report->light_mean > 0.0);
    if (is_black) {
        alpi_page_put(page, "<p class=\"note\">The irradiance is black: nothing lights the scene, "
                            "and its error has no relative value.</p>\n");
    }
    alpi_page_put(page, "</section>\n");
}
