# SPDX-License-Identifier: MIT
# lpv: what it needs, what cannot stand beside it, numbers out of range, options that do not apply
. "$(dirname "$0")/helpers.bash"
light() { try lpv scene.glb "$@"; }
try lpv
try lpv scene.glb other.glb
light --grid 0
light --grid 513
light --grid 32x32
light --cell 0
light --cell -1
light --cell nan
light --cascades 0
light --cascades 9
light --iterations 0
light --iterations 4097
light --mode paper
light --blockers on
light --frames 0
light --frames 1.5
light --bounces 0
light --bounces 2
light --bounces converge --blockers off
light --bounces=converge --blockers=views --cell 0
light --sun-turn 1
light --sun 0,45,1000 --sun-turn 361
light --sun 0,45
light --sky 1,1,1
light --direct on
light --with lpv
light --camera 1,2
light --resolution 64x36
light --resolution 0x9 --pictures slices
light --reference-samples 64
light --json scene.glb -f
light --pictures
light --grids 16
light -o out.png
for command in "render scene.glb -o out.png" "sample scene.glb --at points.csv"; do
    try $command --with lpv --bounces 0
    try $command --with lpv --grid 0
    try $command --with lpv --path flight.csv
    try $command --with lpv --spacing 1
    try $command --with lpv --frames 2
    try $command --with lpv --sun-turn 1
    try $command --with constant --blockers off
    try $command --with probes --cell 1
    try $command --with reference --mode accurate
done
try render scene.glb -o out.png --with lpv --media -1
try render scene.glb -o out.png --with lpv --media thick
try render scene.glb -o out.png --with lpv --gloss 1
try render scene.glb -o out.png --with probes --gloss
try render scene.glb -o out.png --with reference --media 1
try sample scene.glb --at points.csv --with lpv --media 1
try sample scene.glb --at points.csv --with lpv --sky 1,1,1
try sample scene.glb --at points.csv --with lpv --direct on
