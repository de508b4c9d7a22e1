# SPDX-License-Identifier: MIT
# every option of the contract that is not built yet is refused by name
. "$(dirname "$0")/helpers.bash"
for option in --bounces --direct --gather --samples --units \
    --sky --sky-turn --sky-strength --sun --sun-size --lightmap-as \
    --denoise --checkpoint; do
    try bake scene.glb -o out.glb $option
    try bake scene.glb -o out.glb $option=1
done
for option in --bounces; do
    try render scene.glb -o out.png --with ao $option 1
done
try info scene.glb --pictures folder
