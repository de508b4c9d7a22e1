// SPDX-License-Identifier: MIT
// The record in an asset of what made it.
#ifndef ALPI_BAKE_EXTRAS_H
#define ALPI_BAKE_EXTRAS_H

#include "bake/job.h"

/// Makes the object for asset.extras.alpenglow: version, options, units, stated error, input hash.
/// @return text that the caller releases; NULL without memory
char *alpi_bake_make_extras(const alpi_bake_job *job);

#endif
