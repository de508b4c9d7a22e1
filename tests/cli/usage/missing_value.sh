# SPDX-License-Identifier: MIT
# an option at the end of the line, before another option, or with an empty value
. "$(dirname "$0")/helpers.bash"
for option in -o --output --maps --maps-dir --json --size --texels-per-metre --atlas --padding \
    --block --mips --density \
    --ao-samples --ao-distance --ao-falloff --ao-cone --ao-distribution --existing-ao --seed \
    --threads --progress; do
    try bake scene.glb $option
done
try bake scene.glb -o -f
try bake scene.glb --size --padding 3
try bake scene.glb --size=
try bake scene.glb -o ''
try bake scene.glb --one-sided=yes
for option in -o --with --camera --resolution --samples; do
    try render scene.glb $option
done
for option in --scale --max-rmse --map --points --heatmap --json; do
    try compare a b $option
done
