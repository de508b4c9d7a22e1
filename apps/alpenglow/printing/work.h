// SPDX-License-Identifier: MIT
// The estimated work of a bake, as the command tells it.
#ifndef COMMAND_WORK_H
#define COMMAND_WORK_H

#include <alpenglow/bake.h>

#include <jansson.h>
#include <stdio.h>

/// "about 47,000 texels, 12 Mrays or more, 40 MiB"
void work_print(FILE *stream, const alp_bake_work *work);
/// {"texels", "rays", "rays_at_least", "bytes"}
json_t *work_json(const alp_bake_work *work);

#endif
