// SPDX-License-Identifier: MIT
// The parts of the page about a bake: pictures of the maps, plots, and where objects lie.
#ifndef ALPI_REPORT_REPORT_PARTS_H
#define ALPI_REPORT_REPORT_PARTS_H

#include "maps/lightmap.h"
#include "report/html_writer.h"

#include <alpenglow/bake.h>

enum { ALPI_REPORT_PAGES = 16, ALPI_REPORT_SIDE = 1024, ALPI_REPORT_OBJECTS = 200 };
enum { ALPI_REPORT_NAME = 120 }; // characters of a name that are shown

/// What is shown of a page of the atlas.
typedef enum alpi_report_picture {
    ALPI_PICTURE_AO,
    ALPI_PICTURE_AO_ERROR,
    ALPI_PICTURE_BENT,
    ALPI_PICTURE_OBSCURANCE,
    ALPI_PICTURE_LIGHT,
    ALPI_PICTURE_LIGHT_ERROR,
    ALPI_PICTURE_LAYOUT, // the tint of each texel's surface, charts of it lighter and darker
    ALPI_PICTURE_COUNT
} alpi_report_picture;

typedef struct alpi_report_pictures {
    const alp_scene *scene;
    const alp_lightmap *lightmap;
    uint32_t page_count; // that are shown
    double exposure;     // of irradiance: its picture shows 1 − e^(−2^exposure E)
    // Of every map with errors: its mean over texels and channels, and the error over it that the
    // brightest colour stands for; that is 0 where there is nothing to show.
    double means[ALPI_PICTURE_COUNT], tops[ALPI_PICTURE_COUNT];
} alpi_report_pictures;

/// Finds exposure, means and tops. @param pictures with scene, lightmap and page_count filled in
alp_result alpi_report_measure(const alp_bake_report *report, alpi_report_pictures *pictures);
/// 8-bit RGBA, transparent where no texel is covered; the caller destroys it.
alp_result alpi_report_paint(const alpi_report_pictures *pictures, alpi_report_picture kind,
                             uint32_t page, alp_image **picture);

/// Colour of a heat map at [0, 1]: from dark to bright, so that grey prints keep the order.
void alpi_heat_color(float share, uint8_t rgb[3]);
/// Colour of a surface in the layout.
void alpi_surface_tint(uint32_t surface, uint8_t rgb[3]);

/// The sheet of styles, without its tags.
void alpi_report_put_style(alpi_page *page);
/// A picture of the scene with its maps, from its first camera or an automatic one.
/// @param samples of a pixel; 0: none
void alpi_report_put_scene(alpi_page *page, const alp_scene *scene, const alp_lightmap *lightmap,
                           uint32_t samples);
/// Name and value for every figure there is, as a list.
void alpi_report_put_facts(alpi_page *page, const alp_scene *scene, const alp_bake_report *report);
/// The maps and the heat maps of their errors.
void alpi_report_put_maps(alpi_page *page, const alp_bake_report *report,
                          const alpi_report_pictures *pictures);

typedef struct alpi_report_stage {
    const char *name;
    double seconds;
    const char *color; // of CSS
} alpi_report_stage;
/// A bar of the stages' shares of `total`, and a table of them below.
void alpi_plot_stages(alpi_page *page, const alpi_report_stage *stages, size_t count, double total);
/// Change by pass (one a bounce), logarithmic. @param count at least 1
void alpi_plot_passes(alpi_page *page, const float *changes, uint32_t count);
/// The colours of a heat map from 0 to `top`, a share of the mean. @param id unique on the page
void alpi_plot_heat_scale(alpi_page *page, double top, uint32_t id);

/// Where surfaces lie: a picture of each page shown with their rectangles, and a table. Failures
/// end in page->result.
void alpi_report_put_objects(alpi_page *page, const alpi_report_pictures *pictures);

#endif
