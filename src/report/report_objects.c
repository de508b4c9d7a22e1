// SPDX-License-Identifier: MIT
// Where the objects of a bake lie: their rectangles over pictures of the pages, and a table.
#include "report/report_parts.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/// What a surface has on a page.
typedef struct placement {
    uint32_t surface, page;
    uint32_t texels;      // whose representative point is on it
    float u0, v0, u1, v1; // bounds of its triangles
} placement;

typedef struct placements {
    alp_context *context;
    placement *items;
    size_t count, capacity;
} placements;

static int by_page(const void *a, const void *b)
{
    const placement *p = a, *q = b;
    if (p->page != q->page) {
        return p->page < q->page ? -1 : 1;
    }
    return (p->surface > q->surface) - (p->surface < q->surface);
}

/// Most texels first.
static int by_size(const void *a, const void *b)
{
    const placement *p = a, *q = b;
    if (p->texels != q->texels) {
        return p->texels > q->texels ? -1 : 1;
    }
    return by_page(a, b);
}

static void grow(placement *p, const float uvs[3][2])
{
    for (int corner = 0; corner < 3; corner++) {
        p->u0 = fminf(p->u0, uvs[corner][0]);
        p->u1 = fmaxf(p->u1, uvs[corner][0]);
        p->v0 = fminf(p->v0, uvs[corner][1]);
        p->v1 = fmaxf(p->v1, uvs[corner][1]);
    }
}

/// Finds every pair of a surface and a page; triangles of a surface lie together.
/// @param slots [pages] scratch: 1 + the last placement on that page
static alp_result find(const alp_scene *scene, const alp_atlas *atlas, size_t *slots, placements *p)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t page = atlas->triangle_pages[t], surface = scene->triangle_surface[t];
        if (page >= atlas->info.pages) {
            continue; // not chosen
        }
        const size_t slot = slots[page];
        if (slot == 0 || p->items == NULL || p->items[slot - 1].surface != surface) {
            ALP_TRY(alpi_grow(p->context, (void **)&p->items, &p->capacity, p->count + 1,
                              sizeof *p->items));
            p->items[p->count++] =
                (placement){surface, page, 0, INFINITY, INFINITY, -INFINITY, -INFINITY};
            slots[page] = p->count;
        }
        grow(&p->items[slots[page] - 1], (const float(*)[2])atlas->corner_uvs[t]);
    }
    return ALP_OK;
}

/// @param slots [surfaces] scratch, zero
static void count_texels(const alp_lightmap *l, size_t *slots, placements *p)
{
    const alpi_texels *texels = &l->texels;
    for (size_t first = 0, end = 0; first < p->count; first = end) {
        const uint32_t page = p->items[first].page;
        for (; end < p->count && p->items[end].page == page; end++) {
            slots[p->items[end].surface] = end + 1;
        }
        for (uint32_t i = texels->page_first[page]; i < texels->page_first[page + 1]; i++) {
            const size_t slot = slots[l->scene->triangle_surface[texels->triangles[i]]];
            if (slot > 0) {
                p->items[slot - 1].texels++;
            }
        }
        for (size_t i = first; i < end; i++) {
            slots[p->items[i].surface] = 0;
        }
    }
}

static alp_result find_placements(const alp_lightmap *l, placements *p)
{
    const alp_scene *scene = l->scene;
    size_t *of_pages = ALPI_NEW(p->context, size_t, l->page_count);
    size_t *of_surfaces = ALPI_NEW(p->context, size_t, scene->surface_count);
    alp_result result = of_pages != NULL && of_surfaces != NULL ? find(scene, l->atlas, of_pages, p)
                                                                : ALP_ERROR_OUT_OF_MEMORY;
    if (result == ALP_OK && p->count > 0) {
        qsort(p->items, p->count, sizeof *p->items, by_page);
        count_texels(l, of_surfaces, p);
        qsort(p->items, p->count, sizeof *p->items, by_size);
    }
    alpi_release(p->context, of_pages);
    alpi_release(p->context, of_surfaces);
    return result;
}

// --- on the page ---------------------------------------------------------------------------------

/// A rectangle in texels.
typedef struct rectangle {
    double x, y, width, height;
} rectangle;

static rectangle rectangle_of(const placement *p, const alp_lightmap *l)
{
    const double x = fmax(0.0, (double)p->u0) * l->width, y = fmax(0.0, (double)p->v0) * l->height;
    return (rectangle){x, y, fmin(1.0, (double)p->u1) * l->width - x,
                       fmin(1.0, (double)p->v1) * l->height - y};
}

static void put_rectangle(alpi_page *page, const alpi_report_pictures *pictures, const placement *p,
                          size_t number)
{
    const alp_lightmap *l = pictures->lightmap;
    const rectangle r = rectangle_of(p, l);
    const double size = fmax(l->width, l->height) / 38.0; // of letters
    alpi_page_format(page, "<rect x=\"%s\" y=\"%s\" width=\"%s\" height=\"%s\"><title>%zu: ",
                     alpi_fixed(r.x, 2).text, alpi_fixed(r.y, 2).text,
                     alpi_fixed(fmax(r.width, 0.0), 2).text,
                     alpi_fixed(fmax(r.height, 0.0), 2).text, number);
    alpi_page_text(page, l->scene->surfaces[p->surface].name, ALPI_REPORT_NAME);
    alpi_page_put(page, "</title></rect>");
    if (r.width > 2.2 * size && r.height > 1.3 * size) {
        alpi_page_format(page, "<text x=\"%s\" y=\"%s\" font-size=\"%s\">%zu</text>",
                         alpi_fixed(r.x + 0.3 * size, 2).text, alpi_fixed(r.y + size, 2).text,
                         alpi_fixed(size, 2).text, number);
    }
    alpi_page_put(page, "\n");
}

static void put_layout(alpi_page *page, const alpi_report_pictures *pictures, const placements *p,
                       size_t shown, uint32_t number)
{
    const alp_lightmap *l = pictures->lightmap;
    alp_image *picture = NULL;
    if (page->result == ALP_OK) {
        page->result = alpi_report_paint(pictures, ALPI_PICTURE_LAYOUT, number, &picture);
    }
    if (page->result == ALP_OK) {
        alpi_page_format(page,
                         "<figure><svg class=\"layout\" viewBox=\"0 0 %u %u\" role=\"img\" "
                         "aria-label=\"Layout of page %u\"><image width=\"%u\" height=\"%u\" "
                         "preserveAspectRatio=\"none\" href=\"",
                         l->width, l->height, number, l->width, l->height);
        alpi_page_data(page, picture);
        alpi_page_put(page, "\"/>\n");
        for (size_t i = 0; i < shown; i++) {
            if (p->items[i].page == number) {
                put_rectangle(page, pictures, &p->items[i], i + 1);
            }
        }
        alpi_page_put(page, "</svg><figcaption><b>Layout");
        if (l->page_count > 1) {
            alpi_page_format(page, " of page %u", number);
        }
        alpi_page_put(page, "</b>");
        if (number == 0) {
            alpi_page_put(page, "A colour for each object, lighter and darker for its charts; "
                                "rectangles are numbered as in the table.");
        }
        alpi_page_put(page, "</figcaption></figure>\n");
    }
    alp_image_destroy(picture);
}

static void put_row(alpi_page *page, const alp_lightmap *l, const placement *p, size_t number)
{
    const alpi_surface *surface = &l->scene->surfaces[p->surface];
    const rectangle r = rectangle_of(p, l);
    uint8_t tint[3];
    alpi_surface_tint(p->surface, tint);
    alpi_page_format(page,
                     "<tr><td>%zu</td><th scope=\"row\"><i class=\"swatch\" "
                     "style=\"background:#%02x%02x%02x\"></i><bdi>",
                     number, tint[0], tint[1], tint[2]);
    alpi_page_text(page, surface->name, ALPI_REPORT_NAME);
    alpi_page_put(page, "</bdi></th><td class=\"wide\"><bdi>");
    alpi_page_text(page, alp_scene_get_surface(l->scene, p->surface).material, ALPI_REPORT_NAME);
    alpi_page_format(page, "</bdi></td><td>%u</td><td>%s</td><td class=\"wide\">%s, %s</td>",
                     p->page, p->texels > 0 ? alpi_grouped(p->texels).text : "shared",
                     alpi_fixed(r.x, 0).text, alpi_fixed(r.y, 0).text);
    alpi_page_format(page, "<td class=\"wide\">%s × %s</td></tr>\n", alpi_fixed(r.width, 0).text,
                     alpi_fixed(r.height, 0).text);
}

void alpi_report_put_objects(alpi_page *page, const alpi_report_pictures *pictures)
{
    const alp_lightmap *l = pictures->lightmap;
    placements p = {.context = page->context};
    if (page->result == ALP_OK) {
        page->result = find_placements(l, &p);
    }
    const size_t shown = p.count < ALPI_REPORT_OBJECTS ? p.count : ALPI_REPORT_OBJECTS;
    const bool is_one = l->page_count == 1; // then the table has room beside it
    alpi_page_format(page, "<div%s>\n<div class=\"plates layouts%s\">\n",
                     is_one ? " class=\"beside\"" : "", is_one ? " one" : "");
    for (uint32_t i = 0; i < pictures->page_count; i++) {
        put_layout(page, pictures, &p, shown, i);
    }
    alpi_page_put(page, "</div>\n<div class=\"scroll\"><table class=\"objects\"><thead><tr>"
                        "<th>No.</th><th>Object</th><th class=\"wide\">Material</th><th>Page</th>"
                        "<th>Texels</th><th class=\"wide\">Left, top</th>"
                        "<th class=\"wide\">Size</th></tr></thead><tbody>\n");
    for (size_t i = 0; i < shown && page->result == ALP_OK; i++) {
        put_row(page, l, &p.items[i], i + 1);
    }
    alpi_page_put(page, "</tbody></table></div>\n</div>\n");
    if (shown < p.count) {
        alpi_page_format(page,
                         "<p class=\"note\">The %zu largest of %s; the rest lie on the pages too, "
                         "and --json lists all.</p>\n",
                         shown, alpi_grouped(p.count).text);
    }
    alpi_release(page->context, p.items);
}
