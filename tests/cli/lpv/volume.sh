# SPDX-License-Identifier: MIT
# lpv --volume: the fluence of all cells, which is what alpenglow sample finds; faults leave no file
. "$(dirname "$0")/../usage/helpers.bash"
light="alpenglow lpv builtin:cornell --frames 1 -q"
$light --grid 8 --volume one.lpv.json
json_shape one.lpv.json
# A surface reads the cell half a side above itself. Its two sides receive half of the fluence there.
read -r cell x y z < <(sed -n 's/.*"cell":\([^,]*\),"corner":\[\([^]]*\)\].*/\1 \2/p' one.lpv.json | tr ',' ' ')
for at in "4 4 2" "2 5 3" "6 6 1"; do
    read -r i j k <<<"$at"
    written=$(tail -n +9 one.lpv.json | sed -n $((1 + j + 8 * k))p | cut -d, -f$((3 * i + 1)))
    awk -v c="$cell" -v x="$x" -v y="$y" -v z="$z" -v i="$i" -v j="$j" -v k="$k" 'BEGIN {
        for (s = 1; s >= -1; s -= 2)
            printf "%.9f,%.9f,%.9f,0,%d,0\n", x + (i + .5) * c, y + (j + .5 - s / 2) * c, z + (k + .5) * c, s
    }' | alpenglow sample builtin:cornell --with lpv --grid 8 --at - -q | tail -2 |
        awk -F, -v f="$written" '{sum += 2 * $7} END {print (f > 0 && sum / f > .999 && sum / f < 1.001 ? "as sampled" : "not: " sum " and " f)}'
done
$light --grid 4 --cascades 3 --volume three.lpv.json
grep -o '"size":[^]]*]' three.lpv.json
echo '== faults'
cp one.lpv.json there.json
try lpv builtin:cornell --volume there.json
try lpv builtin:cornell --volume volume.ktx2
try lpv scene.json --volume scene.json -f
try lpv builtin:cornell --volume same.json --json same.json
try lpv builtin:cornell --grid 129 --volume large.json
try lpv builtin:cornell --grid 64 --cascades 8 --volume missing/large.json
try lpv builtin:cornell --volume missing/large.json
try sample builtin:cornell --with lpv --at - --volume volume.json
cmp one.lpv.json there.json && ls
