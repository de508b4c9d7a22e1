# SPDX-License-Identifier: MIT
# a picture equals that of render by one sample a pixel, and says how it was made
. "$(dirname "$0")/gl.bash"
common="builtin:cornell --with lightmap --size 64 --texel-samples 8 --resolution 96x54 -q"
alpenglow render $common --samples 1 -o rendered.exr
alpenglow view $common -o drawn.exr --reference rendered.exr --reference-threshold 0.1 >figures
cut -c1-15 figures
alpenglow render $common --samples 1 -o rendered.png
alpenglow view $common -o "it's drawn.png" --reference rendered.png --reference-threshold 0.01 |
    cut -c1-15
grep -a -o "alpenglow view builtin:cornell --with lightmap.* -q" "it's drawn.png"
grep -a -o "Command\|Camera\|Exposure\|OpenGL" "it's drawn.png"
alpenglow view $common -o drawn.hdr && head -c 10 drawn.hdr
