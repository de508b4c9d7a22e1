// SPDX-License-Identifier: MIT
// Between the parts of fuzz_seeds.
#ifndef SEEDS_H
#define SEEDS_H

#include "base/context.h"

/// Writes FOLDER/TARGET/NAME.
void seed_put(const char *target, const char *name, const void *bytes, size_t size);
_Noreturn void seed_fail(const char *what);

void seeds_checkpoint(alp_context *context);
void seeds_images(alp_context *context);
void seeds_packed(void);
void seeds_probes(alp_context *context);

#endif
