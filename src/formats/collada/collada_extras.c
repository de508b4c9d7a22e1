// SPDX-License-Identifier: MIT
// <extra>s of other programs that change what a surface shows: Maya, 3ds Max, Blender and FCollada
// write them, each under a profile of its own. The names tell, whatever the profile.
#include "formats/collada/collada_numbers.h"
#include "formats/collada/collada_read.h"

#include <math.h>
#include <string.h>
#include <strings.h>

const xmlNode *alpi_collada_find_extra(const xmlNode *element, const char *name)
{
    const xmlNode *found = NULL;
    const xmlNode *extra = alpi_xml_child(element, "extra");
    for (; extra != NULL && found == NULL; extra = alpi_xml_next(extra, "extra")) {
        const xmlNode *technique = alpi_xml_child(extra, "technique");
        for (; technique != NULL && found == NULL;
             technique = alpi_xml_next(technique, "technique")) {
            found = alpi_xml_child(technique, name);
        }
    }
    return found;
}

/// A number, TRUE or FALSE; false where there is none.
static bool find_value(const xmlNode *element, const char *name, double *value)
{
    const char *at = alpi_xml_text(alpi_collada_find_extra(element, name));
    at += strspn(at, " \t\r\n");
    if (strncasecmp(at, "true", 4) == 0 || strncasecmp(at, "false", 5) == 0) {
        *value = *at == 't' || *at == 'T' ? 1.0 : 0.0;
        return true;
    }
    return alpi_text_number(&at, value) && isfinite(*value);
}

bool alpi_collada_is_double_sided(const xmlNode *element)
{
    double value = 0.0;
    return find_value(element, "double_sided", &value) && value != 0.0;
}

/// wrapU and mirrorU of Maya, over what the sampler says.
static void read_wrap(const xmlNode *texture, const char *wraps, const char *mirrors,
                      alpi_wrap *wrap)
{
    double value = 0.0;
    if (find_value(texture, wraps, &value)) {
        *wrap = value != 0.0 ? ALPI_WRAP_REPEAT : ALPI_WRAP_CLAMP;
    }
    if (find_value(texture, mirrors, &value) && value != 0.0) {
        *wrap = ALPI_WRAP_MIRROR;
    }
}

void alpi_collada_read_placing(const xmlNode *texture, alpi_collada_slot *slot)
{
    static const char *const repeats[] = {"repeatU", "repeatV"};
    static const char *const offsets[] = {"offsetU", "offsetV"};
    for (int k = 0; k < 2; k++) {
        double value = 0.0;
        if (find_value(texture, repeats[k], &value) && value != 0.0) { // as three.js does
            slot->repeat[k] = (float)value;
        }
        if (find_value(texture, offsets[k], &value)) {
            slot->offset[k] = (float)value;
        }
    }
    read_wrap(texture, "wrapU", "mirrorU", &slot->wrap_u);
    read_wrap(texture, "wrapV", "mirrorV", &slot->wrap_v);
}
