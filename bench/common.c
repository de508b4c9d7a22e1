// SPDX-License-Identifier: MIT
// Tables and clocks of the benches.
#include "bench.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// --- tables --------------------------------------------------------------------------------------

/// Splits `text` at its bars into a row.
static int split_cells(char *text, char cells[BENCH_COLUMN_LIMIT][BENCH_CELL_SIZE])
{
    int count = 0;
    for (char *at = text; at != NULL && count < BENCH_COLUMN_LIMIT; count++) {
        char *bar = strchr(at, '|');
        if (bar != NULL) {
            *bar = '\0';
        }
        snprintf(cells[count], BENCH_CELL_SIZE, "%.*s", BENCH_CELL_SIZE - 1, at);
        at = bar != NULL ? bar + 1 : NULL;
    }
    return count;
}

void bench_table_start(bench_table *table, const char *title, const char *note, const char *header)
{
    memset(table, 0, sizeof *table);
    table->title = title;
    table->note = note;
    char text[BENCH_COLUMN_LIMIT * BENCH_CELL_SIZE];
    snprintf(text, sizeof text, "%s", header);
    table->columns = split_cells(text, table->cells[0]);
    table->rows = 1;
}

void bench_table_add(bench_table *table, const char *format, ...)
{
    char text[BENCH_COLUMN_LIMIT * BENCH_CELL_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (table->rows < BENCH_ROW_LIMIT) {
        split_cells(text, table->cells[table->rows++]);
    }
}

/// Characters of UTF-8.
static int text_width(const char *text)
{
    int width = 0;
    for (; *text != '\0'; text++) {
        width += (*text & 0xc0) != 0x80;
    }
    return width;
}

static void print_cell(const char *text, int width, bool left)
{
    const int blanks = width > text_width(text) ? width - text_width(text) : 0;
    printf("%*s%s%*s", left ? 0 : blanks, "", text, left ? blanks : 0, "");
}

static void print_rule(const int *widths, int columns)
{
    for (int c = 0; c < columns; c++) {
        printf("|%s", c == 0 ? ":" : "-");
        for (int i = 0; i < widths[c]; i++) {
            putchar('-');
        }
        printf("%s", c == 0 ? "-" : ":");
    }
    printf("|\n");
}

void bench_table_print(const bench_table *table, const bench_options *options)
{
    int widths[BENCH_COLUMN_LIMIT] = {0};
    for (int r = 0; r < table->rows; r++) {
        for (int c = 0; c < table->columns; c++) {
            const int width = text_width(table->cells[r][c]);
            widths[c] = width > widths[c] ? width : widths[c];
        }
    }
    printf(options->markdown ? "### %s\n\n" : "%s\n", table->title);
    if (options->markdown && table->note != NULL) {
        printf("%s\n\n", table->note);
    }
    for (int r = 0; r < table->rows; r++) {
        for (int c = 0; c < table->columns; c++) {
            printf("%s", options->markdown ? "| " : "  ");
            print_cell(table->cells[r][c], widths[c], c == 0);
            printf("%s", options->markdown ? " " : "");
        }
        printf(options->markdown ? "|\n" : "\n");
        if (r == 0 && options->markdown) {
            print_rule(widths, table->columns);
        }
    }
    printf("\n");
    fflush(stdout);
}

// --- measuring -----------------------------------------------------------------------------------

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median(const double *values, int count)
{
    double sorted[BENCH_ROUND_LIMIT];
    count = count < BENCH_ROUND_LIMIT ? count : BENCH_ROUND_LIMIT;
    if (count < 1) {
        return 0.0;
    }
    memcpy(sorted, values, sizeof *sorted * (size_t)count);
    qsort(sorted, (size_t)count, sizeof *sorted, compare_doubles);
    return 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
}

static double read_clock(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bench_thread_seconds(void)
{
    return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

double bench_process_seconds(void)
{
    return read_clock(CLOCK_PROCESS_CPUTIME_ID);
}

double bench_seconds(uint32_t workers)
{
    return read_clock(workers == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC);
}

void *bench_allocate(size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) {
        fprintf(stderr, "alpenglow bench: out of memory\n");
        exit(1);
    }
    return memory;
}
