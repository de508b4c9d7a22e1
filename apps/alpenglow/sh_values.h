// SPDX-License-Identifier: MIT
// Nine spherical harmonics as lines of text.
#ifndef COMMAND_SH_VALUES_H
#define COMMAND_SH_VALUES_H

#include <alpenglow/sh.h>

/// Prints a line of R, G and B for each row of a convention. Values below 1e-7 of the largest are
/// rounding, and print as 0.
alp_result sh_values_print(const alp_sh9 *radiance, alp_sh_convention convention);

#endif
