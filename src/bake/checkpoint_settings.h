// SPDX-License-Identifier: MIT
// All that changes a bit of a bake's result, as text. A checkpoint is read only by a bake with the
// same text.
#ifndef ALPI_BAKE_CHECKPOINT_SETTINGS_H
#define ALPI_BAKE_CHECKPOINT_SETTINGS_H

#include "bake/job.h"
#include "base/bytes.h"

/// Lines "name value\n": version, instruction set, scene, options. Options have the names that the
/// command gives them.
alpi_bytes alpi_bake_settings(const alpi_bake_job *job);

#endif
