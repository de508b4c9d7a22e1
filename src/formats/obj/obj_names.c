// SPDX-License-Identifier: MIT
// Texts numbered in the order in which they first come.
#include "formats/obj/obj_names.h"

#include "base/hash.h"
#include "base/memory.h"
#include "scene/scene.h"

#include <string.h>

alpi_obj_names alpi_obj_names_create(alp_context *context)
{
    return (alpi_obj_names){.context = context, .text = alpi_bytes_create(context)};
}

void alpi_obj_names_destroy(alpi_obj_names *names)
{
    alpi_bytes_destroy(&names->text);
    alpi_release(names->context, names->begins);
    alpi_release(names->context, names->sizes);
    alpi_release(names->context, names->table);
    *names = alpi_obj_names_create(names->context);
}

/// The slot of these bytes, or the free one where they belong.
static size_t find_slot(const alpi_obj_names *names, const void *bytes, size_t size)
{
    size_t mask = names->table_size - 1;
    size_t slot = (size_t)alpi_hash_bytes(ALPI_HASH_START, bytes, size) & mask;
    for (; names->table[slot] != ALPI_NONE; slot = (slot + 1) & mask) {
        uint32_t number = names->table[slot];
        if (names->sizes[number] == size &&
            memcmp(names->text.bytes + names->begins[number], bytes, size) == 0) {
            break;
        }
    }
    return slot;
}

uint32_t alpi_obj_names_find(const alpi_obj_names *names, const void *bytes, size_t size)
{
    return names->table_size == 0 ? ALPI_NONE : names->table[find_slot(names, bytes, size)];
}

static alp_result grow_table(alpi_obj_names *names)
{
    if (names->table_size >= 2 * ((size_t)names->count + 1)) {
        return ALP_OK;
    }
    size_t size = names->table_size == 0 ? 64 : 2 * names->table_size;
    uint32_t *table = ALPI_NEW(names->context, uint32_t, size);
    if (table == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memset(table, 0xff, size * sizeof *table); // ALPI_NONE
    alpi_release(names->context, names->table);
    names->table = table;
    names->table_size = size;
    for (uint32_t i = 0; i < names->count; i++) {
        table[find_slot(names, names->text.bytes + names->begins[i], names->sizes[i])] = i;
    }
    return ALP_OK;
}

alp_result alpi_obj_names_add(alpi_obj_names *names, const void *bytes, size_t size,
                              uint32_t *number, bool *added)
{
    ALP_TRY(grow_table(names));
    size_t slot = find_slot(names, bytes, size);
    *number = names->table[slot];
    *added = *number == ALPI_NONE;
    if (!*added) {
        return ALP_OK;
    }
    void *begins = names->begins, *sizes = names->sizes;
    size_t needed = (size_t)names->count + 1;
    ALP_TRY(
        alpi_grow(names->context, &begins, &names->begin_capacity, needed, sizeof *names->begins));
    names->begins = begins;
    ALP_TRY(alpi_grow(names->context, &sizes, &names->size_capacity, needed, sizeof *names->sizes));
    names->sizes = sizes;
    size_t begin = names->text.size;
    alpi_bytes_add(&names->text, bytes, size);
    alpi_bytes_add(&names->text, "", 1);
    if (names->text.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    names->begins[names->count] = begin;
    names->sizes[names->count] = size;
    *number = names->table[slot] = names->count++;
    return ALP_OK;
}

const char *alpi_obj_name(const alpi_obj_names *names, uint32_t number)
{
    return (const char *)names->text.bytes + names->begins[number];
}
