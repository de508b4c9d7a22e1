// SPDX-License-Identifier: MIT
// Texts numbered in the order in which they first come.
#ifndef ALPI_FORMATS_OBJ_NAMES_H
#define ALPI_FORMATS_OBJ_NAMES_H

#include "formats/text/text_edits.h"

typedef struct alpi_obj_names {
    alp_context *context;
    alpi_bytes text; // each ended by a zero
    size_t *begins;  // [count]
    size_t *sizes;   // [count] without the zero
    uint32_t count;
    size_t begin_capacity, size_capacity, table_size;
    uint32_t *table; // open addressing, ALPI_NONE = free
} alpi_obj_names;

alpi_obj_names alpi_obj_names_create(alp_context *context);
void alpi_obj_names_destroy(alpi_obj_names *names);
/// The number of these bytes, a new one (*added) where they were not there.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_obj_names_add(alpi_obj_names *names, const void *bytes, size_t size,
                              uint32_t *number, bool *added);
/// The number of these bytes, ALPI_NONE where they are not there.
uint32_t alpi_obj_names_find(const alpi_obj_names *names, const void *bytes, size_t size);
const char *alpi_obj_name(const alpi_obj_names *names, uint32_t number);

#endif
