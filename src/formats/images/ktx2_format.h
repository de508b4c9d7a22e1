// SPDX-License-Identifier: MIT
// Numbers of the KTX2 format that its reader and its writer share.
#ifndef ALPI_FORMATS_KTX2_FORMAT_H
#define ALPI_FORMATS_KTX2_FORMAT_H

#include "formats/images/images.h"

enum {
    ALPI_KTX2_IDENTIFIER_SIZE = 12,
    ALPI_KTX2_HEADER_SIZE = 104, // identifier 12, header 36, index 32, one level 24
    ALPI_KTX2_RG16F = 83,        // VK_FORMAT_R16G16_SFLOAT
    ALPI_KTX2_RGBA16F = 97,      // VK_FORMAT_R16G16B16A16_SFLOAT
    ALPI_KTX2_PLAIN = 0,         // schemes of supercompression
    ALPI_KTX2_ZSTANDARD = 2,
    ALPI_KTX2_ALIGNMENT = 8 // of a plain level: a multiple of the size of a texel
};

static const uint8_t alpi_ktx2_identifier[ALPI_KTX2_IDENTIFIER_SIZE] = {
    0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};

static inline uint32_t alpi_ktx2_format(uint32_t channels)
{
    return channels == 2 ? ALPI_KTX2_RG16F : ALPI_KTX2_RGBA16F;
}

/// Bytes of the data format descriptor: its size, a head and a sample a channel.
static inline uint32_t alpi_ktx2_descriptor_size(uint32_t channels)
{
    return 4 + 24 + 16 * channels;
}

#endif
