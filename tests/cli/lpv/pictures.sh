# SPDX-License-Identifier: MIT
# lpv: slices of each grid, and a view beside the reference
light="alpenglow lpv builtin:cornell --grid 8 --frames 1 --reference-samples 16 -q --pictures pictures"
$light --resolution 32x18 --cascades 2 || echo "exit $?"
ls pictures
for name in slice_x slice_y_1 view; do
    od -A n -t u1 -j 16 -N 8 pictures/$name.png | awk '{print $3 * 256 + $4, $7 * 256 + $8}'
done
$light 2>&1 || echo "exit $?"
$light -f --resolution 32x18 && echo "overwritten"
echo text >file
alpenglow lpv builtin:cornell --frames 1 --pictures file 2>&1 || echo "exit $?"
