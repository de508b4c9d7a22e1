# SPDX-License-Identifier: MIT
# view: outputs, modes, and options that a mode or an output does not use
. "$(dirname "$0")/helpers.bash"
view="view scene.glb -o out.png"
flight="view scene.glb --path flight.csv --pictures frames"
try view
try view scene.glb --with lightmap
try view scene.glb --with lightmap -o out.jpg
try view scene.glb --with lightmap -o out.png --pictures frames
try view scene.glb --with lightmap --pictures frames
try $view
try $view --with radiosity
try $view --with lightmap --frames 3
try $view --with lightmap --path flight.csv
try $view --with lightmap --resolution 0x10
try $view --with lightmap --camera wrong
try $view --with lightmap --reference-threshold 0.1
try view scene.glb -o out.exr --with lightmap --exposure 1
for option in "--camera 0" "--reference a.png" "--frames 0"; do
    try $flight --with lightmap $option
done
for option in "--size 64" "--atlas charts" "--stitch off" "--texel-samples 4" "--bounces 1" \
    "--lamp 0,0,0,1" "--seed 1"; do
    try $view --with none $option
done
for option in "--sky 1,1,1" "--sun 0,45,1" "--sun-size 1"; do
    try $view --with albedo $option
done
for option in "--direct off" "--bounces 1" "--seed 1" "--size 64"; do
    try $view --with direct $option
done
try $view --with lightmap --direct off
for option in "--read vertex" "--normal-maps on" "--ao-samples 4" "--probes a.probes.json" "--time 1"; do
    try $view --with lightmap $option
done
for option in "--spacing 1" "--grid 8" "--path flight.csv"; do
    try $view --with hemisphere $option
done
try $view --with blend --atlas charts
try $view --with ao --texel-samples 4
try $view --with ambience
try $view --with ambience --path flight.csv --bounces 1
try $flight --with ambience --time 1
try $view --with lpv --bounces 2
try $view --with hemisphere --size 64
try $view --with lightmap --samples 4
capture="view scene.glb --with lightmap --capture"
try $capture 1,2
try $capture 1,2,3 -o out.png
try $capture 1,2,3 --pictures frames
try $capture 1,2,3 --camera 0
try $capture 1,2,3 --resolution 8x8
try $view --with lightmap --convention gltf
try $view --with none --divider 0.5
try $view --with none --beside albedo --divider 2
try $view --with none --beside albedo --size 64
try $capture 1,2,3 --beside albedo
try view scene.glb --with reference --capture 1,2,3
try $view --with reference --size 64
try $view --with lightmap --ssao on
try $view --with hemisphere --ssao-radius 1
try $view --with hemisphere --ssao on --ssao-radius 0
try view scene.glb --with hemisphere --ssao on --capture 1,2,3
for mode in none albedo lightmap ao sh blend; do
    try $view --with $mode --object sphere,0,0,0,1
done
for object in "" cube,0,0,0,1 sphere sphere,0,0,0 sphere,0,0,0,0 teapot,0,0,0,1,2; do
    try $view --with direct --object "$object"
done
try $view --with direct --object sphere,0,0,0,1 --object-path path.csv
try $flight --with direct --object-path path.csv
try $flight --with lightmap --object-path path.csv
try view scene.glb --path - --pictures frames --with direct --object sphere,0,0,0,1 --object-path -
