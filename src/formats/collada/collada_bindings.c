// SPDX-License-Identifier: MIT
// What instances bind to names, sorted: a file may bind a hundred thousand materials for as many
// primitives, and looking through all of them for each would not end.
#include "formats/collada/collada_ids.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

typedef struct alpi_collada_bound {
    uint32_t owner; // the instance, or the <instance_material>
    uint32_t element;
    const char *name; // belongs to the tree
} bound;

/// The instance whose <bind_material><technique_common> this <instance_material> stands in, or the
/// <instance_material> of a <bind_vertex_input>; NULL for other elements.
static const xmlNode *owner_of(const xmlNode *element, const char **name)
{
    const xmlNode *parent = element->parent;
    if (alpi_xml_is(element, "bind_vertex_input") && alpi_xml_is(parent, "instance_material")) {
        *name = alpi_xml_attribute(element, "semantic");
        return parent;
    }
    if (parent == NULL || !alpi_xml_is(element, "instance_material") ||
        !alpi_xml_is(parent, "technique_common") || !alpi_xml_is(parent->parent, "bind_material")) {
        return NULL;
    }
    *name = alpi_xml_attribute(element, "symbol");
    return parent->parent->parent;
}

static int compare_bounds(const void *left, const void *right)
{
    const bound *a = left, *b = right;
    if (a->owner != b->owner) {
        return (a->owner > b->owner) - (a->owner < b->owner);
    }
    const int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->element > b->element) - (a->element < b->element);
}

alp_result alpi_collada_index_bindings(alpi_collada_document *d)
{
    uint32_t count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < d->element_count; i++) {
            const char *name = NULL;
            const xmlNode *owner = owner_of(d->elements[i], &name);
            if (owner == NULL || owner->type != XML_ELEMENT_NODE || name == NULL) {
                continue;
            }
            if (pass == 0) {
                count++;
            } else {
                d->bounds[d->bound_count++] = (bound){alpi_xml_index(owner), i, name};
            }
        }
        if (pass == 0) {
            ALPI_TRY_NEW(d->context, d->bounds, count);
        }
    }
    if (count > 0) {
        qsort(d->bounds, count, sizeof *d->bounds, compare_bounds);
    }
    return ALP_OK;
}

xmlNode *alpi_collada_bound_to(const alpi_collada_document *d, const xmlNode *owner,
                               const char *name)
{
    if (owner == NULL || name == NULL) {
        return NULL;
    }
    const bound wanted = {alpi_xml_index(owner), 0, name}; // before the first of that name
    uint32_t low = 0, high = d->bound_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (compare_bounds(&d->bounds[middle], &wanted) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < d->bound_count && d->bounds[low].owner == wanted.owner &&
                   strcmp(d->bounds[low].name, name) == 0
               ? d->elements[d->bounds[low].element]
               : NULL;
}
