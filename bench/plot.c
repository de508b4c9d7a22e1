// SPDX-License-Identifier: MIT
#include "plot.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 720, LEFT = 52, RIGHT = WIDTH - 12, TOP = 48, AXES = 190, PANEL = 280 };
enum { LETTER = 7 /* width of one, about */, COLUMNS = RIGHT - LEFT };

/// Round numbers of an axis.
typedef struct scale {
    double low, high, step;
} scale;

/// @param parts about so many
static scale find_scale(double low, double high, int parts)
{
    const double rough = fmax(high - low, 1e-9) / parts;
    const double decade = pow(10.0, floor(log10(rough))), times = rough / decade;
    const double step = decade * (times > 5.0 ? 10.0 : times > 2.0 ? 5.0 : times > 1.0 ? 2.0 : 1.0);
    return (scale){floor(low / step) * step, ceil(high / step) * step, step};
}

static scale find_heights(const plot_panel *p)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < p->line_count; i++) {
        for (int k = 0; k < p->lines[i].count; k++) {
            low = fmin(low, (double)p->lines[i].values[k]);
            high = fmax(high, (double)p->lines[i].values[k]);
        }
    }
    return find_scale(low, high, 4);
}

static double height(const scale *s, double value)
{
    return TOP + AXES * (s->high - value) / (s->high - s->low);
}

static void put_axes(FILE *file, const plot_panel *p, const scale *up)
{
    const scale across = find_scale(p->low, p->high, 8);
    fprintf(file, "<text x=\"%d\" y=\"18\" class=\"title\">%s</text>\n", LEFT, p->title);
    for (int i = 0; up->low + i * up->step < up->high + 0.5 * up->step; i++) {
        const double value = up->low + i * up->step, y = height(up, value);
        fprintf(file,
                "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" class=\"grid\"/>"
                "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.6g</text>\n",
                LEFT, y, RIGHT, y, LEFT - 6, y + 4.0, value);
    }
    for (int i = 0; across.low + i * across.step <= p->high; i++) {
        const double value = across.low + i * across.step;
        const double x = LEFT + COLUMNS * (value - p->low) / (p->high - p->low);
        if (value >= p->low) {
            fprintf(file, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.6g</text>\n", x,
                    TOP + AXES + 15, value);
        }
    }
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>\n", RIGHT, TOP + AXES + 31,
            p->across);
}

/// Dots, or a line. If values are closer than a pixel, their least and their most are drawn, so
/// that no jump is lost.
static void put_line(FILE *file, const plot_line *line, const scale *up, int color)
{
    const int last = line->count - 1;
    const double apart = (double)COLUMNS / last;
    if (line->dots) {
        for (int k = 0; k <= last; k++) {
            fprintf(file, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.2\" class=\"dot%d\"/>\n",
                    LEFT + k * apart, height(up, (double)line->values[k]), color);
        }
        return;
    }
    fprintf(file, "<polyline class=\"line%d\" points=\"", color);
    const int bunch = apart < 0.5 ? (int)ceil(1.0 / apart) : 1;
    for (int first = 0; first <= last; first += bunch) {
        int least = first, most = first;
        for (int k = first; k < first + bunch && k <= last; k++) {
            least = line->values[k] < line->values[least] ? k : least;
            most = line->values[k] > line->values[most] ? k : most;
        }
        const int order[2] = {least < most ? least : most, least < most ? most : least};
        for (int i = 0; i < (least != most ? 2 : 1); i++) {
            fprintf(file, "%.1f,%.1f ", LEFT + order[i] * apart,
                    height(up, (double)line->values[order[i]]));
        }
    }
    fprintf(file, "\"/>\n");
}

static void put_panel(FILE *file, const plot_panel *p)
{
    const scale up = find_heights(p);
    double x = LEFT;
    put_axes(file, p, &up);
    for (int i = 0; i < p->line_count; i++) {
        int letters = 0;
        put_line(file, &p->lines[i], &up, i);
        fprintf(file, "<circle cx=\"%.0f\" cy=\"34\" r=\"4\" class=\"dot%d\"/>", x + 4.0, i);
        fprintf(file, "<text x=\"%.0f\" y=\"38\">%s</text>\n", x + 13.0, p->lines[i].name);
        while (p->lines[i].name[letters] != '\0') {
            letters++;
        }
        x += 30.0 + LETTER * letters;
    }
}

bool plot_write(const char *path, const char *label, const plot_panel *panels, int count)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        fprintf(stderr, "alpenglow bench: %s: cannot be written\n", path);
        return false;
    }
    fprintf(
        file,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" "
        "aria-label=\"%s\" font-family=\"sans-serif\" font-size=\"12\">\n"
        "<style>\n"
        "svg { background: #fff; color: #222; --a: #1565c0; --b: #d9480f; --c: #666; }\n"
        "@media (prefers-color-scheme: dark) {\n"
        "svg { background: #15181c; color: #ddd; --a: #64b5ff; --b: #ff9457; --c: #aaa; }\n"
        "}\n"
        "text { fill: currentColor; }\n"
        ".title { font-weight: bold; }\n"
        ".grid { stroke: currentColor; stroke-opacity: .18; }\n"
        "polyline { fill: none; stroke-width: 1.3; stroke-linejoin: round; }\n"
        ".line0 { stroke: var(--a); } .line1 { stroke: var(--b); } .line2 { stroke: var(--c); }\n"
        ".dot0 { fill: var(--a); } .dot1 { fill: var(--b); } .dot2 { fill: var(--c); }\n"
        "</style>\n",
        WIDTH, count * PANEL, label);
    for (int i = 0; i < count; i++) {
        fprintf(file, "<g transform=\"translate(0 %d)\">\n", i * PANEL);
        put_panel(file, &panels[i]);
        fprintf(file, "</g>\n");
    }
    fprintf(file, "</svg>\n");
    const bool bad = ferror(file) != 0;
    if (fclose(file) != 0 || bad) {
        fprintf(stderr, "alpenglow bench: %s: cannot be written\n", path);
        return false;
    }
    return true;
}
