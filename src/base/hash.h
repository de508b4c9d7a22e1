// SPDX-License-Identifier: MIT
// FNV-1a, 64 bits: a fingerprint of bytes (not for security). Fowler, Noll, Vo; constants from
// draft-eastlake-fnv.
#ifndef ALPI_BASE_HASH_H
#define ALPI_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define ALPI_HASH_START 0xcbf29ce484222325u

/// Continues `hash` (start with ALPI_HASH_START) over bytes.
static inline uint64_t alpi_hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const uint8_t *data = bytes;
    for (size_t i = 0; i < size; i++) {
        // The analyser loses bytes of wider objects. NOLINTNEXTLINE(clang-analyzer-core.*)
        hash = (hash ^ data[i]) * 0x100000001b3u;
    }
    return hash;
}

#endif
