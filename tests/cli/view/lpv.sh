# SPDX-License-Identifier: MIT
# light propagation on the card equals that of render; mist and mirrors need --read pixel
. "$(dirname "$0")/gl.bash"
. "$(dirname "$0")/relative.bash"
common="builtin:cornell --with lpv --grid 12 --map-size 32 --resolution 96x54 -q -f"
lamp="--lamp .3,.4,.4,3"
for options in "" "--media 1" "--gloss" "--cascades 2 --blockers views" "--mode conformance" \
    "$lamp --direct off --map-size 256" "--sun 180,30,200 --direct off --map-size 256" \
    "$lamp --spot .1,.5,.3,.1,0,.3,5,20,40 --direct off --map-size 256" \
    "$lamp --sun 180,30,200 --direct off --map-size 256"; do
    alpenglow render $common $options --samples 1 -o rendered.exr
    alpenglow view $common $options -o drawn.exr
    relative "$options" .01 drawn.exr rendered.exr
done
alpenglow view $common -o without.exr
alpenglow render $common --media 1 --samples 1 -o misty.exr
relative "the other" .01 without.exr misty.exr
for options in "--gloss --read vertex" "--media 1 --read object" "--grid 0"; do
    alpenglow view $common $options -o refused.png || echo "exit $?"
done
alpenglow view builtin:cornell --with direct --gloss -o refused.png || echo "exit $?"
