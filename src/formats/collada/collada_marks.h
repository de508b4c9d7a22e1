// SPDX-License-Identifier: MIT
// Names that mark what a bake added to a COLLADA document.
#ifndef ALPI_FORMATS_COLLADA_MARKS_H
#define ALPI_FORMATS_COLLADA_MARKS_H

/// texcoord="" of textures that a bake made, bound to its coordinate set by each instance.
#define ALPI_COLLADA_BAKED_UV "ALPENGLOW"

#endif
