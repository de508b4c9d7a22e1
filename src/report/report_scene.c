// SPDX-License-Identifier: MIT
// The picture of the scene with its maps, at the top of the page about a bake.
#include "report/report_parts.h"

#include <alpenglow/film.h>
#include <alpenglow/render.h>

enum { WIDTH = 800, HEIGHT = 450, OPEN_RAYS = 64 };

static alp_result draw(const alp_scene *scene, const alp_lightmap *lightmap,
                       alp_render_method method, uint32_t samples, alp_image **picture)
{
    alp_render_options options = alp_render_options_default();
    alp_film_options film = alp_render_film_options(method);
    alp_image *linear = NULL;
    options.method = method;
    options.width = WIDTH;
    options.height = HEIGHT;
    options.samples = samples;
    options.occlusion.samples = OPEN_RAYS; // of surfaces that were not baked
    options.lightmap = lightmap;
    alp_result result = alp_render(scene, &options, &linear);
    if (result == ALP_OK) {
        result = alp_film_develop(linear, &film, picture, NULL);
    }
    alp_image_destroy(linear);
    return result;
}

void alpi_report_put_scene(alpi_page *page, const alp_scene *scene, const alp_lightmap *lightmap,
                           uint32_t samples)
{
    const bool lit = lightmap->irradiance_pages != NULL;
    const alp_render_method method = lit ? ALP_RENDER_LIGHTMAP : ALP_RENDER_AO;
    alp_image *picture = NULL;
    if (samples == 0) {
        return;
    }
    if (page->result == ALP_OK) {
        page->result = draw(scene, lightmap, method, samples, &picture);
    }
    if (page->result == ALP_OK) {
        alpi_page_put(page, "<section id=\"scene\"><h2>Scene</h2>\n<figure>");
        alpi_page_picture(page, picture, "Picture of the scene");
        alpi_page_format(page, "<figcaption>With %s, from %s.</figcaption></figure>\n</section>\n",
                         lit ? "baked light" : "baked occlusion",
                         scene->camera_count > 0 ? "its first camera" : "an automatic camera");
    }
    alp_image_destroy(picture);
}
