// SPDX-License-Identifier: MIT
// Files of probes, behind the public calls.
#include "base/memory.h"
#include "fields/probes/probes.h"
#include "formats/formats.h"

alp_result alp_probes_save(const alp_probes *probes, const char *path, bool overwrite)
{
    if (probes == NULL || path == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    return alpi_probes_save(&probes->volume, path, overwrite);
}

alp_result alp_probes_load(alp_context *context, const char *path, alp_probes **probes)
{
    if (context == NULL || path == NULL || probes == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *probes = NULL;
    alp_probes *loaded = ALPI_NEW(context, alp_probes, 1);
    if (loaded == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    loaded->context = context;
    const alp_result result = alpi_probes_load(context, path, &loaded->volume);
    if (result != ALP_OK) {
        alp_probes_destroy(loaded);
        return result;
    }
    *probes = loaded;
    return ALP_OK;
}

alp_result alp_probes_export_three(const alp_probes *probes, const char *path, double scale,
                                   bool overwrite)
{
    if (probes == NULL || path == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    return alpi_probes_export_three(&probes->volume, path, scale, overwrite);
}
