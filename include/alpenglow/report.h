// SPDX-License-Identifier: MIT
// A page about a bake, for people to read.
#ifndef ALPENGLOW_REPORT_H
#define ALPENGLOW_REPORT_H

#include <alpenglow/bake.h>
#include <alpenglow/doctor.h>

ALP_BEGIN_DECLS

typedef struct alp_report_options {
    size_t struct_size;
    const char *command;                ///< how the bake was asked for; NULL (default) = not shown
    const alp_report_finding *findings; ///< [finding_count], what the context's log heard; the
                                        ///< first 200 are shown
    uint32_t finding_count;             ///< default 0
    const alp_diagnosis *diagnosis; ///< of the scene, made with those messages: what it found is
                                    ///< shown in their place, with what is seen and what to do;
                                    ///< NULL (default) = the messages alone
    bool overwrite;                 ///< default false: an existing file is an error
} alp_report_options;
ALP_API alp_report_options alp_report_options_default(void);

/// Writes one self-contained HTML page (which is well-formed XML too) about a bake: figures,
/// findings, the maps, heat maps of their standard errors, change per bounce of a radiosity,
/// time per stage, and the objects on the atlas. It loads nothing and runs no script, and all text
/// from files is escaped; what is not UTF-8 in it shows as U+FFFD.
///
/// Pictures have at most 1024 pixels a side: each is the mean over covered texels of a square of
/// them. Occlusion, bent normals (n / 2 + 1/2) and obscurance are shown as bytes of their linear
/// values; irradiance as 1 − e^(−2^x E) in sRGB, x such that its mean luminance becomes 0.18 (as
/// alp_film_meter says; the page states x). Heat maps show the standard error over the map's mean.
/// The first 16 pages are shown. With ALP_ATLAS_VERTEX there are no pictures.
/// @param lightmap of alp_bake; that of ALP_ATLAS_VERTEX too
/// @param report   of the same call; set seconds_load to have loading among the stages
/// @param options  NULL = defaults
/// @param path     written to a temporary file that is renamed when complete
/// @return ALP_OK; INVALID_ARGUMENT (NULL, options not from the default); IO; OUT_OF_MEMORY
/// Cost: about as much as writing the maps as PNG; memory of one page's pictures.
ALP_API ALP_NODISCARD alp_result alp_bake_write_report(const alp_scene *scene,
                                                       const alp_lightmap *lightmap,
                                                       const alp_bake_report *report,
                                                       const alp_report_options *options,
                                                       const char *path);

ALP_END_DECLS

#endif
