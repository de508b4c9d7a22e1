// SPDX-License-Identifier: MIT
// Names by which the COLLADA writer and reader know what a bake added.
#ifndef ALPI_FORMATS_COLLADA_WRITE_H
#define ALPI_FORMATS_COLLADA_WRITE_H

#include "formats/formats.h"

/// texcoord="" of textures that a bake made, bound to its coordinate set by each instance.
#define ALPI_COLLADA_BAKED_UV "ALPENGLOW"

#endif
