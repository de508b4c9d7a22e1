// SPDX-License-Identifier: MIT
// Plots of lines as SVG, readable on light and on dark pages.
#ifndef PLOT_BENCH_H
#define PLOT_BENCH_H

#include <stdbool.h>

enum { PLOT_LINES = 3 };

/// Values at even distances over the width of its panel.
typedef struct plot_line {
    const char *name;
    const float *values; // [count]
    int count;           // ≥ 2
    bool dots;           // a dot for each value, instead of a line through them
} plot_line;

/// One pair of axes. The vertical one fits the values.
typedef struct plot_panel {
    const char *title, *across; // across: name of the horizontal axis, with its unit
    double low, high;           // of the horizontal axis
    plot_line lines[PLOT_LINES];
    int line_count;
} plot_panel;

/// Writes panels below each other. @return false after a message
bool plot_write(const char *path, const char *label, const plot_panel *panels, int count);

#endif
