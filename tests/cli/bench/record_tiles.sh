# SPDX-License-Identifier: MIT
# Costs of tiles that scripts/replay_scale.py reads: every tile once, a row for each loop; and the
# replay of costs that are known.
folder=$(dirname "$(command -v alpenglow)")
replay=$(dirname "${BASH_SOURCE[0]}")/../../../scripts/replay_scale.py
"$folder/alpenglow-bench" record-tiles builtin:cornell costs.csv --size 64 --samples 64
head -1 costs.csv | sed 's/ *$//'
sed -n 2p costs.csv
# 64 rays a texel, 16 texels a tile: tiles of all texels
awk -F, 'NR > 2 && $2 == "" {loops++; bytes += $4} NR > 2 && $2 != "" {tiles++}
    END {print loops, "loops,", tiles, "tiles,", bytes, "bytes"}' costs.csv
"$folder/alpenglow-bench" record-tiles builtin:cornell costs.csv --sise 64 2>&1
echo "no such word: $?"
"$folder/alpenglow-bench" record-tiles nothing.glb other.csv 2>/dev/null
echo "no such scene: $?"
# 1,280 tiles of 1 s, and an exchange of 10 GB: 640 s and 0.5 s for two ranks
{
    echo "# even, light, texels 100, error 0, samples 1"
    echo "loop,block,seconds,bytes"
    for block in $(seq 0 127); do printf '1,%s,0.1,\n' "$block"; done
    echo "1,,0.5,1000000000"
} >even.csv
python3 "$replay" even.csv --texels 1000 --ranks 1,2,128
