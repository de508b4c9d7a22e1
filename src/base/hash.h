// SPDX-License-Identifier: MIT
// FNV-1a, 64 bits (Fowler, Noll, Vo): tells inputs apart, no protection against an adversary.
#ifndef ALPI_BASE_HASH_H
#define ALPI_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define ALPI_HASH_START UINT64_C(0xcbf29ce484222325)

/// Goes on hashing; start with ALPI_HASH_START. NULL with size 0 is allowed.
static inline uint64_t alpi_hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const uint8_t *b = bytes;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ b[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

#endif
