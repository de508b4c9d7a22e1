# SPDX-License-Identifier: MIT
# sky FILE: an even sky of radiance 1 over black ground, as a Radiance picture of 4 x 2 pixels.
sky() {
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n' >"$1"
    printf '\200\200\200\201%.0s' 1 2 3 4 >>"$1"
    printf '\0\0\0\0%.0s' 1 2 3 4 >>"$1"
}
