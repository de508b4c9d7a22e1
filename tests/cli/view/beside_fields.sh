# SPDX-License-Identifier: MIT
# two modes that read fields: an option is taken if one of them reads it, and either may fly
. "$(dirname "$0")/gl.bash"
printf '%s\n' t,px,py,pz,tx,ty,tz 0,.1,.45,.4,.28,.27,0 1,.45,.45,.4,.28,.27,0 >flight.csv
view="alpenglow view builtin:cornell --resolution 48x27 -q -f"
fly="--path flight.csv --cell .2"
# status NAME COMMAND...
status() {
    local name=$1
    shift
    "$@"
    echo "$name: exit $?"
}
status "probes, lpv" $view --with probes --beside lpv --grid 12 --spacing .2 -o two.png
status "none, ambience" $view --with none --beside ambience $fly -o two.png
status "none, ambience, no flight" $view --with none --beside ambience -o two.png
status "lpv, ambience, no flight" $view --with lpv --beside ambience -o two.png
status "lpv, ambience, no day" $view --with lpv --beside ambience $fly --day 2 -o two.png
status "constant, ambience" $view --with constant --beside ambience $fly --bounces 1 -o two.png
status "none, probes, grid" $view --with none --beside probes --grid 12 -o two.png
status "none, ambience, bounces" $view --with none --beside ambience $fly --bounces 1 -o two.png
status "lpv, probes, sky" $view --with lpv --beside probes --grid 12 --spacing .2 --sky 1,1,1 -o two.png
# The right part is the picture of its own mode, with the camera at the end of the flight.
$view --with ambience $fly -o alone.exr
status "right as alone" $view --with none --beside ambience $fly --divider 0 -o two.exr \
    --reference alone.exr --reference-threshold 1e-6 | tail -1
view="alpenglow view builtin:cornell --resolution 128x72 --exposure 0 -q"
$view --with ambience $fly --pictures alone --frames 2
$view --with none --beside ambience $fly --divider 0 --pictures two --frames 2
for frame in 1 2; do # the line between them is less than 1 % of the pixels
    alpenglow compare alone/frame_000$frame.png two/frame_000$frame.png |
        awk '$1 == "p99" { print "p99 below .01:", $2 < .01 } $1 == "means" { print ($2 > .05 ? "lit" : "dark") }'
done
