# SPDX-License-Identifier: MIT
# every option reaches the library: each changes the map, or the shape of the output
bake() {
    alpenglow bake builtin:sphere-plane --ao-samples 16 -q --maps-dir "$@" || echo "failed: $*"
}
bake plain --size 32
changed() {
    local name=$1
    shift
    bake "$name" "$@"
    if cmp -s plain/ao.exr "$name/ao.exr"; then echo "$name: same"; else echo "$name: changed"; fi
}
changed same --size 32
changed size --size 33
changed density --size 32 --texels-per-metre 1.5
changed padding --size 32 --padding 5
changed block --size 32 --block 8
changed mips --size 32 --mips 3
changed factor --size 32 --density 'ground=0.5'
changed samples --size 32 --ao-samples 32
changed distance --size 32 --ao-distance 0.3
changed infinite --size 32 --ao-distance inf
changed linear --size 32 --ao-falloff linear
changed cone --size 32 --ao-cone 40
changed uniform --size 32 --ao-distribution uniform
changed seed --size 32 --seed 5
# defaults that are given change nothing
changed defaults --size 32 --padding 2 --block 1 --mips 0 --ao-distance auto --ao-falloff smooth \
    --ao-cone 90 --ao-distribution cosine --seed 0 --maps ao --atlas auto --texels-per-metre auto
# what was used stands in the asset, in the library's units
alpenglow bake builtin:sphere-plane -q -o out.gltf --size 40 --padding 3 --ao-samples 8 \
    --ao-distance 0.75 --ao-falloff exp --ao-cone 45 --ao-distribution uniform --one-sided --seed 11
grep -oE '"(samples|distance_m|falloff|cone_rad|distribution|one_sided|seed|atlas|size|padding)": ?[^,}]*' \
    out.gltf | tr -d ' ' | sort -u
