# SPDX-License-Identifier: MIT
# --only, --occluders and --ao-self reach the library, and what was chosen is told
bake() {
    alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -q -f "$@"
}
bake --maps-dir plain
changed() {
    local name=$1
    shift
    bake --maps-dir "$name" "$@" || echo "failed: $*"
    if cmp -s plain/ao.exr "$name/ao.exr"; then echo "$name: same"; else echo "$name: changed"; fi
}
changed all --only '*' --occluders 'ground,sphere'
changed only --only 'gr*'
changed occluders --occluders '[!g]*'
changed self --ao-self
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 --only 'gro?nd' --ao-self -o out.gltf \
    --json out.json --progress off | grep -E '^(surfaces|occlusion)' |
    sed 's/rays per texel.*diagonal/rays … diagonal/; s/;.*//'
grep -oE '"surfaces(_baked)?": [0-9]+' out.json
grep -oE '"name": "[^"]*"' out.json
grep -oE '"(only|self|surfaces|distance_m|occluders)": ?("[^"]*"|true|\[[^]]*\])' out.gltf | tr -d ' '
bake --maps-dir no --only 'gruond,sphere'
echo $?
bake --maps-dir no --occluders cube
echo $?
ls -d no 2>/dev/null
alpenglow render builtin:sphere-plane --with ao --resolution 16x9 --samples 1 -q -o a.exr
alpenglow render builtin:sphere-plane --with ao --resolution 16x9 --samples 1 -q -o b.exr \
    --occluders sphere
cmp -s a.exr b.exr || echo "render: changed"
alpenglow render builtin:sphere-plane --with ao -q -o c.exr --occluders cube
echo $?
