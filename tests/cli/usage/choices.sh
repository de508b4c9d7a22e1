# SPDX-License-Identifier: MIT
# words that are none of the choices, and choices of the contract that are not built yet
. "$(dirname "$0")/helpers.bash"
for option in --maps --atlas --ao-falloff --ao-distribution --existing-ao --progress; do
    try bake scene.glb -o out.glb $option wrong
done
for map in light direction sh probes ao,light bent,sh ao, ,ao AO; do
    try bake scene.glb -o out.glb --maps $map
done
for mode in blend; do
    try bake scene.glb -o out.glb --atlas $mode
done
for method in reference radiosity lightmap probes ambience lpv hemisphere cube raytrace; do
    try render scene.glb -o out.png --with $method
done
try render scene.glb -o out.png --with ao --tone aces
for option in "--exposure auto" "--tone film" "--white-balance off"; do
    try render scene.glb -o out.exr --with ao $option
done
try bake scene.glb -o out.glb --ao-distance inf --ao-falloff linear
try bake scene.glb -o out.glb --ao-distance=inf --ao-falloff=exp
