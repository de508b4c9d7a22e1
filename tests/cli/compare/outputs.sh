# SPDX-License-Identifier: MIT
# numbers as JSON, and a heat map
alpenglow render builtin:sphere-plane --with ao --ao-samples 8 --resolution 32x24 --samples 1 -q -o a.exr
alpenglow render builtin:sphere-plane --with ao --ao-samples 8 --seed 3 --resolution 32x24 --samples 1 -q -o b.exr
alpenglow compare a.exr b.exr --heatmap heat.png --json numbers.json
json_shape numbers.json
head -c 4 heat.png | tail -c 3; echo
alpenglow compare a.exr b.exr --heatmap heat.png; echo $?
alpenglow compare a.exr b.exr --heatmap heat.png --json numbers.json -f >/dev/null; echo $?
cp a.exr c.png
alpenglow compare c.png b.exr --heatmap c.png -f; echo $?
alpenglow compare a.exr b.exr --json b.exr -f; echo $?
cmp a.exr c.png
