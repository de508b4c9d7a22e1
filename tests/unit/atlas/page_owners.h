// SPDX-License-Identifier: MIT
// Pages by who has their texels.
#ifndef PAGE_OWNERS_H
#define PAGE_OWNERS_H

#include "test_support.h"

#include "atlas/stages.h"

enum { FREE = 0xffff };

/// Fails unless the owners of a page keep the rules: padding, blocks, and a mip chain that is
/// really built.
/// @param page [size][size] a number of an owner, or FREE
void check_page(const uint16_t *page, const alpi_pack_rules *rules);

#endif
