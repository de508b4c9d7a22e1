# SPDX-License-Identifier: MIT
# bent normals and coloured obscurance: which files, and the same bits for any number of threads
bake() {
    alpenglow bake builtin:cornell --size 48 --ao-samples 16 "$@" || echo "failed: $*"
}
bake --maps ao,bent --ao-bleed --maps-dir all --threads 1 | head -1
ls all
bake --maps bent --maps-dir bent -q
ls bent
bake --maps ao,bent --ao-bleed --maps-dir again -o out.glb -q --threads 5
for file in all/*; do
    cmp "$file" "again/${file#all/}"
done
cmp all/bent.exr bent/bent.exr
bake --maps bent,ao --ao-bleed --maps-dir seed -q --seed 1
for map in ao bent obscurance; do
    cmp -s all/$map.exr seed/$map.exr && echo "$map: the seed changes nothing"
done
true
