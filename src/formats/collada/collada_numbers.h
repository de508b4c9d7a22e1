// SPDX-License-Identifier: MIT
// Numbers in text, by no locale: lists of floats and of indices as COLLADA writes them.
#ifndef ALPI_FORMATS_COLLADA_NUMBERS_H
#define ALPI_FORMATS_COLLADA_NUMBERS_H

#include "formats/collada/collada_document.h"

/// Reads a number at *at and moves behind it and the white space after it. A comma stands for the
/// point too, as exporters write that print by their locale. "INF", "-INF" and "NaN"
/// are numbers. Right to the last bits of a double, so that as a float it is the nearest one or, of
/// two that lie as near, its neighbour.
/// @return false at what is no number, where *at stays
bool alpi_text_number(const char **at, double *value);

/// All numbers of an element's text. *values is released by the caller.
/// @return ALP_OK; INVALID_DATA (the word that is no number, with its line); OUT_OF_MEMORY
alp_result alpi_collada_floats(const alpi_collada_document *document, const xmlNode *node,
                               float **values, size_t *count);
/// The same in double.
alp_result alpi_collada_exact(const alpi_collada_document *document, const xmlNode *node,
                              double **values, size_t *count);
/// Exactly `count` numbers, which become doubles.
alp_result alpi_collada_doubles(const alpi_collada_document *document, const xmlNode *node,
                                size_t count, double *values);
/// All whole numbers from 0 of an element's text, put behind the *count that are there.
alp_result alpi_collada_indices(const alpi_collada_document *document, const xmlNode *node,
                                uint32_t **values, size_t *count, size_t *capacity);

/// An attribute that is a whole number from 0 to `most`; `absent` without it.
alp_result alpi_collada_count(const alpi_collada_document *document, const xmlNode *node,
                              const char *attribute, uint32_t absent, uint32_t most,
                              uint32_t *value);

#endif
