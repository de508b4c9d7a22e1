// SPDX-License-Identifier: MIT
// Light in an asset: its units, its scales, its encoding.
#ifndef ALPI_BAKE_LIGHT_UNITS_H
#define ALPI_BAKE_LIGHT_UNITS_H

#include "bake/job.h"

/// Encodes the pages of light that go into the asset, if any do.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_bake_make_light_asset(alpi_bake_job *job);
void alpi_bake_release_light_asset(alpi_bake_job *job);
/// Ending of the files of light: ".png", ".ktx2" …
const char *alpi_bake_light_ending(const alp_bake_options *options);
/// Name of the units: "irradiance" …
const char *alpi_bake_light_units_name(const alp_bake_options *options);

#endif
