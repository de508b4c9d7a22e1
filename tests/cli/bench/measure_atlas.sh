# SPDX-License-Identifier: MIT
# What tests/truth/atlas_table.py reads: figures of an atlas, of coordinates that are there, and
# triangles for other unwrappers. The hash does not change with the number of workers.
bench=$(dirname "$(command -v alpenglow)")/alpenglow-bench
hash_of() { sed 's/.*"hash": "\([0-9a-f]*\)".*/\1/'; }
"$bench" measure-atlas hills:200 --size 64 | tr ',' '\n' | sed -E 's/"[0-9a-f]{16}"/HASH/; s/[0-9.]+/0/'
[ "$("$bench" measure-atlas hills:2000 --size 64 --threads 1 | hash_of)" = \
    "$("$bench" measure-atlas hills:2000 --size 64 --threads 3 | hash_of)" ] && echo same
"$bench" measure-atlas pieces:100 --size 64 | grep -oE '"(charts|uncovered|flipped|overlapping)": [0-9]+'
"$bench" measure-atlas builtin:furnace --obj furnace.obj && grep -c '^f ' furnace.obj
cat >square.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0.25 0.25
vt 0.75 0.25
vt 0.75 0.75
vt 0.25 0.75
f 1/1 2/2 3/3
f 1/1 3/3 4/4
OBJ
# covered 32², and with two texels of padding 36² of 64²
"$bench" measure-atlas square.obj --set 0 --size 64 |
    grep -oE '"(charts|texels|utilisation|flipped|stretch_worst)": [0-9.e-]+'
"$bench" measure-atlas square.obj --sise 64 2>&1
echo "no such word: $?"
"$bench" measure-atlas nothing.glb 2>/dev/null
echo "no such scene: $?"
