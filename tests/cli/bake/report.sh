# SPDX-License-Identifier: MIT
# the report has every key of the contract
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -o out.glb --json out.json -q --seed 7 --threads 3
echo $?
json_shape out.json
grep -E '"(threads|seed|pages|width|height)"' out.json
