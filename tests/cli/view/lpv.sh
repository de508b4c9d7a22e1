# SPDX-License-Identifier: MIT
# light propagation on the card equals that of render; mist and mirrors need --read pixel
. "$(dirname "$0")/gl.bash"
common="builtin:cornell --with lpv --grid 12 --map-size 32 --resolution 96x54 -q"
for options in "" "--media 1" "--gloss" "--cascades 2 --blockers views" "--mode conformance" \
    "--lamp .3,.4,.4,3 --direct off --map-size 256"; do
    alpenglow render $common $options --samples 1 -o rendered.exr -f
    alpenglow view $common $options -o drawn.exr -f --reference rendered.exr \
        --reference-threshold 0.005 | cut -c1-15
    echo "$options: exit ${PIPESTATUS[0]}"
done
alpenglow view $common --media 1 -o drawn.exr -f --reference rendered.exr --reference-threshold 0.001 |
    cut -c1-15
echo "the other: exit ${PIPESTATUS[0]}"
for options in "--gloss --read vertex" "--media 1 --read object" "--grid 0"; do
    alpenglow view $common $options -o refused.png || echo "exit $?"
done
alpenglow view builtin:cornell --with direct --gloss -o refused.png || echo "exit $?"
