// SPDX-License-Identifier: MIT
// Sources: arrays of floats, and which of their numbers are the components of an element.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_numbers.h"

/// Which numbers of an element are its components: those whose <param> has a name.
static void read_params(const xmlNode *accessor, alpi_collada_source *source)
{
    uint32_t place = 0;
    const xmlNode *param = alpi_xml_child(accessor, "param");
    for (; param != NULL; param = alpi_xml_next(param, "param"), place++) {
        const char *name = alpi_xml_attribute(param, "name");
        if (name != NULL && name[0] != '\0' && source->components < 4 && place < source->stride) {
            source->place[source->components++] = place;
        }
    }
    while (source->components == 0 || (place == 0 && source->components < source->stride &&
                                       source->components < 4)) { // no names at all: in order
        source->place[source->components] = source->components;
        source->components++;
    }
}

static alp_result read_accessor(const alpi_collada_reader *reader, const xmlNode *element,
                                alpi_collada_source *source, xmlNode **array)
{
    static const char *const way[] = {"technique_common", "accessor", NULL};
    const alpi_collada_document *document = reader->document;
    const xmlNode *accessor = alpi_xml_descend(element, way);
    *array = NULL;
    if (accessor == NULL) {
        return alpi_collada_fail(document, element, "has no <technique_common> with <accessor>");
    }
    ALP_TRY(alpi_collada_count(document, accessor, "stride", 1, 1 << 20, &source->stride));
    ALP_TRY(alpi_collada_count(document, accessor, "offset", 0, ALPI_NONE - 1, &source->first));
    ALP_TRY(alpi_collada_count(document, accessor, "count", 0, ALPI_NONE - 1, &source->count));
    if (source->stride == 0 && source->count == 0) { // an empty one
        source->stride = 1;
    }
    if (source->stride == 0) {
        return alpi_collada_fail(document, accessor, "its stride is 0");
    }
    read_params(accessor, source);
    const char *url = alpi_xml_attribute(accessor, "source");
    if (url == NULL || alpi_collada_find(document, url[0] == '#' ? url + 1 : url) == NULL) {
        *array = alpi_xml_child(element, "float_array"); // as some exporters leave it
        if (*array != NULL) {
            return ALP_OK;
        }
    }
    return alpi_collada_resolve(document, accessor, "source", "float_array", array);
}

/// Elements that the array really holds; one that is short leaves the last ones out.
static void limit_count(alpi_collada_source *source, size_t value_count)
{
    uint32_t last = 0;
    for (uint32_t k = 0; k < source->components; k++) {
        last = source->place[k] > last ? source->place[k] : last;
    }
    const size_t needed = (size_t)source->first + last + 1;
    const size_t held = value_count < needed ? 0 : (value_count - needed) / source->stride + 1;
    source->count = held < source->count ? (uint32_t)held : source->count;
}

/// A <float_array>, read at its first use: many sources may name one.
/// @param array out: its place in the reader's list
static alp_result read_array(alpi_collada_reader *reader, xmlNode *element, uint32_t *array)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot == ALPI_NONE) { // a long one is not read again for each source
        return alpi_collada_fail(reader->document, element, "holds what is no number");
    }
    if (*slot == 0) {
        *slot = ALPI_NONE;
        ALP_TRY(alpi_collada_grow(reader->context, &reader->arrays, &reader->array_capacity,
                                  reader->array_count + 1, sizeof *reader->arrays));
        alpi_collada_array *made = &reader->arrays[reader->array_count++];
        *made = (alpi_collada_array){.element =
                                         element}; // released with the reader, also after a failure
        ALP_TRY(alpi_collada_floats(reader->document, element, &made->values, &made->count));
        *slot = reader->array_count;
    }
    *array = *slot - 1;
    return ALP_OK;
}

alp_result alpi_collada_exact_values(alpi_collada_reader *reader, const alpi_collada_source *source,
                                     const double **values)
{
    alpi_collada_array *array = &reader->arrays[source->array];
    if (array->exact == NULL) {
        ALP_TRY(alpi_collada_exact(reader->document, array->element, &array->exact, &array->count));
    }
    *values = array->exact;
    return ALP_OK;
}

alp_result alpi_collada_read_source(alpi_collada_reader *reader, xmlNode *element, uint32_t *index)
{
    uint32_t *slot = &reader->slots[alpi_xml_index(element)];
    if (*slot != 0) {
        *index = *slot - 1;
        return ALP_OK;
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->sources, &reader->source_capacity,
                              reader->source_count + 1, sizeof *reader->sources));
    alpi_collada_source *source = &reader->sources[reader->source_count];
    *source = (alpi_collada_source){0};
    xmlNode *array = NULL;
    ALP_TRY(read_accessor(reader, element, source, &array));
    if (array == NULL) {
        return alpi_collada_fail(reader->document, element, "has no <float_array>");
    }
    uint32_t place = 0;
    ALP_TRY(read_array(reader, array, &place));
    const alpi_collada_array *values = &reader->arrays[place];
    *index = reader->source_count++;
    source->array = place;
    source->values = values->values; // stays where it is when the list of arrays grows
    const uint32_t stated = source->count;
    limit_count(source, values->count);
    if (source->count < stated) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(reader->document, element, owner);
        alpi_warn(reader->context, "short-array", owner,
                  "its array holds %u of the %u elements that the accessor states", source->count,
                  stated);
    }
    *slot = *index + 1;
    return ALP_OK;
}
