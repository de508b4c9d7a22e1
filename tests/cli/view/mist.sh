# SPDX-License-Identifier: MIT
# mist of view is that of render: at a bound of the scene, and behind panes
. "$(dirname "$0")/gl.bash"
. "$(dirname "$0")/relative.bash"
# Two specks span a box of air from -1 to 1.
cat >air.obj <<'OBJ'
mtllib panes.mtl
v -1 -1 -1
v -.999 -1 -1
v -1 -.999 -1
v 1 1 1
v .999 1 1
v 1 .999 1
f 1 2 3
f 4 5 6
OBJ
cat >panes.mtl <<'MTL'
newmtl red
Kd .8 .4 .2
d .6
newmtl blue
Kd .1 .3 .9
d .5
MTL
# A red pane across its middle, and behind it a blue one in the right half of the picture.
cp air.obj panes.obj
cat >>panes.obj <<'OBJ'
v -.5 -.5 0
v .5 -.5 0
v .5 .5 0
v -.5 .5 0
v 0 -.5 -.5
v .5 -.5 -.5
v .5 .5 -.5
v 0 .5 -.5
usemtl red
f 7 8 9 10
usemtl blue
f 11 12 13 14
OBJ
# compare NAME SCENE OPTIONS: prints whether the RMSE is below a hundredth of the mean
compare() {
    local name=$1 scene=$2
    shift 2
    alpenglow render "$scene" --with lpv --grid 8 -q -f -o rendered.exr --samples 64 "$@" 2>/dev/null
    alpenglow view "$scene" --with lpv --grid 8 -q -f -o drawn.exr "$@" 2>/dev/null
    relative "$name" .01 drawn.exr rendered.exr
}
mist="--media .7 --sun 90,20,10 --sun-size 0" # along the panes, which get none of it
compare "camera on the upper bound" air.obj $mist --camera 1,0,5,1,0,0,1 --resolution 3x3
compare "camera on the lower bound" air.obj $mist --camera -1,0,5,-1,0,0,1 --resolution 3x3
compare "two panes" panes.obj $mist --camera 0,0,5,0,0,0,2 --resolution 16x16
compare "a sky behind them" panes.obj $mist --sky 1,1,1 --camera 0,0,5,0,0,0,2 --resolution 16x16
compare "from between them" panes.obj $mist --camera 0,0,-.2,0,0,-1,2 --resolution 16x16
sed 's/Kd .8 .4 .2/&\nKe .5 .5 .5/' panes.mtl >glow.mtl
sed 's/panes.mtl/glow.mtl/' panes.obj >glow.obj
compare "a pane that glows" glow.obj $mist --camera 0,0,5,0,0,0,2 --resolution 16x16
