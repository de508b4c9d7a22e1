// SPDX-License-Identifier: MIT
// The HTML page about a bake.
#ifndef ALPENGLOW_REPORT_H
#define ALPENGLOW_REPORT_H

#include <alpenglow/bake.h>
#include <alpenglow/doctor.h>

ALP_BEGIN_DECLS

typedef struct alp_report_options {
    size_t struct_size;
    const char *command; ///< command line of the bake; NULL (default): not printed
    /// Messages of the context's log, [finding_count]. The first 200 are printed.
    const alp_report_finding *findings;
    uint32_t finding_count; ///< default 0
    /// Diagnosis of the scene, made with the same messages. Its findings then replace them, each
    /// with its visible effect and its remedy. NULL (default): the messages alone.
    const alp_diagnosis *diagnosis;
    bool overwrite; ///< default false: an existing file is an error
    /// Samples of each pixel in the picture of the scene; 0: no such picture. Default 8.
    uint32_t picture_samples;
} alp_report_options;
ALP_API alp_report_options alp_report_options_default(void);

/// Writes one self-contained HTML page about a bake, which is well-formed XML too. It holds
/// figures, a picture of the scene with its maps, findings, the maps, heat maps of their standard
/// errors and the objects on the atlas. It also has the change of each bounce of a radiosity and
/// the time of each stage.
///
/// The page loads nothing and runs no script. All text from files is escaped. Bytes that are not
/// UTF-8 become U+FFFD.
///
/// Pictures have at most 1024 pixels a side. Each pixel is the mean over the covered texels of a
/// square. Occlusion, bent normals (n / 2 + 1/2) and obscurance are bytes of linear values.
/// Irradiance is 1 − e^(−2^x E) in sRGB. The exposure x makes its mean luminance 0.18, as
/// alp_film_meter measures it; the page states x. Heat maps hold the standard error over the map's
/// mean. The first 16 pages are printed; with ALP_ATLAS_VERTEX there are no pictures of maps.
/// @param lightmap of alp_bake; vertex values too
/// @param report   of the same call; set seconds_load to list loading among the stages
/// @param options  NULL = defaults
/// @param path     written under a temporary name and renamed when complete
/// @return ALP_OK; INVALID_ARGUMENT (NULL, options not from the default); IO; OUT_OF_MEMORY
/// Cost: about that of writing the maps as PNG, 2.9 million camera rays, and memory for the
/// pictures of one page.
ALP_API ALP_NODISCARD alp_result alp_bake_write_report(const alp_scene *scene,
                                                       const alp_lightmap *lightmap,
                                                       const alp_bake_report *report,
                                                       const alp_report_options *options,
                                                       const char *path);

ALP_END_DECLS

#endif
