# SPDX-License-Identifier: MIT
# ambience: the light of a flight is that of render at pixels, and near it at vertices and objects;
# the pictures of a flight end with that of its last moment
. "$(dirname "$0")/gl.bash"
. "$(dirname "$0")/relative.bash"
printf '%s\n' t,px,py,pz,tx,ty,tz 0,.1,.45,.4,.28,.27,0 1,.45,.45,.4,.28,.27,0 >flight.csv
common="builtin:cornell --with ambience --path flight.csv --fps 4 --budget 400 --anchors 300 --resolution 96x54 -q -f"
for options in "" "--sun 160,40,20 --day 3" "--lamp .3,.4,.4,3 --direct off"; do
    alpenglow render $common $options --samples 1 -o rendered.exr
    for read in pixel vertex object; do
        alpenglow view $common $options --read $read -o drawn.exr
        limit=.0001
        [ $read = pixel ] || limit=.5
        relative "$options $read" $limit drawn.exr rendered.exr
    done
done
sun="--sun 180,20,200 --exposure 0"
alpenglow view $common $sun --day 3 --pictures frames --frames 2
alpenglow view $common $sun --day 3 -o last.png
alpenglow view $common $sun -o noon.png
relative "last frame" .0001 frames/frame_0002.png last.png
relative "first frame" .1 frames/frame_0001.png last.png
relative "noon" .05 noon.png last.png
