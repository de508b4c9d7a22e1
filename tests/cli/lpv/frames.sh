# SPDX-License-Identifier: MIT
# lpv: figures of frames as table and JSON; the same light by any number of threads; warnings
light="alpenglow lpv builtin:cornell --grid 8 --progress off"
light_of() { grep -v -E '"(median|worst)"'; } # without times
$light --frames 3 | awk '{print $1, NF}'
$light --frames 2 --json frames.json -q
json_shape frames.json
$light --frames 2 --json - --threads 1 | light_of | cmp - <(light_of <frames.json) && echo "threads agree"
options() { $light --frames 1 --json - "$@" | sed -n '/"options"/,/}/p' | tr -d ' \n'; echo; }
options --cell .2 --cascades 2 --map-size 16 --mode conformance --blockers off --bounces 1
options --sun 0,45,1000 --iterations 4 --blockers views
options --sun 0,45,1000 --sun-turn -2 --blockers points
options --blockers off
for options in "" "--cascades 2" "--blockers off" "--sun 0,45,10"; do
    $light --frames 1 $options | awk -v options="$options" '/^flux/ {print options, ($2 > 0 ? "light" : "none")}'
done
$light --frames 1 --json frames.json 2>&1 || echo "exit $?"
$light --frames 1 --json frames.json -f -q && ls
alpenglow lpv builtin:sphere-plane --frames 1 2>&1 || echo "exit $?"
alpenglow lpv builtin:cornell --grid 512 --frames 1 2>/dev/null || echo "exit $?"
alpenglow lpv builtin:cornell --camera 7 --grid 8 2>&1 || echo "exit $?"
alpenglow lpv missing.glb 2>&1 || echo "exit $?"
for grid in 1 2 3; do
    alpenglow lpv builtin:cornell --grid $grid --frames 1 -q || echo "exit $?"
done
warned() { "$@" 2>&1 >/dev/null || echo "exit $?"; }
warned alpenglow lpv builtin:sphere-plane --sun 0,-30,1000 --grid 8 --frames 2
warned alpenglow lpv builtin:cornell --sun 0,-30,1000 --cell .0001 --grid 4 --frames 2
warned alpenglow lpv builtin:cornell --grid 5 --frames 1
echo "x,y,z,nx,ny,nz
.2,.2,.2,0,1,0" >points.csv
warned alpenglow sample builtin:cornell --at points.csv --with lpv --grid 8 --blockers views
warned alpenglow sample builtin:cornell --at points.csv --with lpv --grid 8 --blockers views --lamp .28,.45,.28,1
