// SPDX-License-Identifier: MIT
// A page of HTML on its way into a file: markup, text from outside, figures and pictures. What is
// written is well-formed XML too, so that any reader of either can check it.
#ifndef ALPI_REPORT_HTML_WRITER_H
#define ALPI_REPORT_HTML_WRITER_H

#include "base/file.h"
#include "base/image.h"

enum { ALPI_PAGE_BUFFER = 16384 };

/// Failures stick: after the first one nothing more is written, and `result` is looked at once at
/// the end.
typedef struct alpi_page {
    alp_context *context;
    alpi_file_writer *writer;
    alp_result result;
    size_t used;
    char buffer[ALPI_PAGE_BUFFER];
} alpi_page;

/// Markup, as it is.
void alpi_page_put(alpi_page *page, const char *markup);
/// Markup of at most 1,023 bytes. No text from outside, and no floating point: a host's locale
/// would choose the decimal point; alpi_fixed and its like do not ask it.
void alpi_page_format(alpi_page *page, const char *format, ...) ALP_PRINTF(2, 3);
/// Text from outside, for between tags or inside quotes: < > & " ' become references; bytes that
/// are not UTF-8, control characters and what XML does not allow become U+FFFD, line ends and tabs
/// blanks. After `limit` characters an ellipsis ends it.
void alpi_page_text(alpi_page *page, const char *text, size_t limit);
/// An <img> with the picture (8-bit) as a data URI; `alt` is text of ours.
void alpi_page_picture(alpi_page *page, const alp_image *picture, const char *alt);
/// The URI alone: "data:image/png;base64,…".
void alpi_page_data(alpi_page *page, const alp_image *picture);
/// Gives the rest to the file. @return the first failure of all
alp_result alpi_page_flush(alpi_page *page);

/// A number as text, with a decimal point in every locale; "–" when it is not finite.
typedef struct alpi_figure {
    char text[48];
} alpi_figure;
alpi_figure alpi_fixed(double number, int decimals);
/// `digits` significant ones; very large and very small numbers as 1.2e-7.
alpi_figure alpi_significant(double number, int digits);
/// 1234567 with narrow blanks between thousands.
alpi_figure alpi_grouped(uint64_t number);
alpi_figure alpi_bytes(uint64_t bytes);    ///< "12.3 MiB"
alpi_figure alpi_duration(double seconds); ///< "1.25 s", "350 ms"
alpi_figure alpi_percent(double share);    ///< "1.2 %"

#endif
