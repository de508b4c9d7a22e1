# SPDX-License-Identifier: MIT
# mist of view is that of render: where the camera lies on a bound of the scene
. "$(dirname "$0")/gl.bash"
# Two specks span a box of air from -1 to 1.
cat >air.obj <<'OBJ'
v -1 -1 -1
v -.999 -1 -1
v -1 -.999 -1
v 1 1 1
v .999 1 1
v 1 .999 1
f 1 2 3
f 4 5 6
OBJ
# compare FILE THRESHOLD OPTIONS: prints the exit status
compare() {
    local file=$1 threshold=$2
    shift 2
    alpenglow render "$file" --with lpv --grid 8 -q -f -o rendered.exr --samples 16 "$@" 2>/dev/null
    alpenglow view "$file" --with lpv --grid 8 -q -f -o drawn.exr --reference rendered.exr \
        --reference-threshold "$threshold" "$@" >figures
    echo "exit $?"
}
air="--media .7 --sun 0,20,10 --sun-size 0"
for x in 1 -1; do
    compare air.obj 1e-4 $air --camera $x,0,5,$x,0,0,1 --resolution 3x3
done
