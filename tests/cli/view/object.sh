# SPDX-License-Identifier: MIT
# an object in a picture as in one of render, and on a path of its own
. "$(dirname "$0")/gl.bash"
scene="builtin:cornell --with hemisphere --direct off --sky 1,1,1 --resolution 64x36"
object="--object teapot,0.28,0.2,0.3,0.1"
alpenglow render $scene $object --samples 1 -q -o render.exr
alpenglow view $scene $object -q -o view.exr
alpenglow compare view.exr render.exr --max-rmse 0.0001 >/dev/null && echo "as in render"
alpenglow view $scene -q -o without.exr
alpenglow compare view.exr without.exr --max-rmse 0.005 >/dev/null 2>&1 || echo "exit $?: the object is seen"
printf '%s\n' t,px,py,pz,tx,ty,tz 0,0.28,0.27,1.5,0.28,0.27,0 2,0.28,0.27,1.5,0.28,0.27,0 >flight.csv
fly() { # name, lines of a path
    printf '%s\n' t,px,py,pz "${@:2}" >path.csv
    alpenglow view $scene $object --path flight.csv --object-path path.csv --frames 3 \
        --pictures "$1" -q --exposure 0
    echo "$1: exit $?"
}
fly moves 0,0.1,0.2,0.3 2,0.4,0.2,0.3
fly stands 0,0.25,0.2,0.3
same() { # frame of the object that moves
    alpenglow compare "moves/frame_000$1.png" "stands/frame_000$1.png" --max-rmse 0 \
        >/dev/null 2>&1
    echo "$1: exit $?"
}
same 1
same 2 # half-way
fly bad 0,0.1,0.2
fly long 0,0.1,0.2,0.3,0.4
fly back 1,0,0,0 1,1,0,0
fly nothing
