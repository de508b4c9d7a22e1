# SPDX-License-Identifier: MIT
# direct light and a model of ambient light equal those of render; direct light without a light warns
. "$(dirname "$0")/gl.bash"
common="builtin:cornell --with ambient-cube --lamp 0.3,0.4,0.05,0.1 --resolution 96x54 -q"
for direct in on off; do
    alpenglow render $common --direct $direct --samples 1 -o rendered_$direct.exr
    alpenglow view $common --direct $direct -o drawn.exr -f --reference rendered_$direct.exr \
        --reference-threshold 0.005 | cut -c1-15
    echo "$direct: exit ${PIPESTATUS[0]}"
done
alpenglow view $common -o drawn.exr -f --reference rendered_off.exr --reference-threshold 0.1 |
    cut -c1-15
echo "the other: exit ${PIPESTATUS[0]}"
alpenglow view builtin:cornell --with direct --resolution 96x54 -q -o dark.png
