# SPDX-License-Identifier: MIT
# values at vertices: in the asset, its extras and the report; no map is written
bake() {
    alpenglow bake builtin:cornell --atlas vertex --ao-samples 16 "$@" 2>/dev/null
}
bake -o color.gltf --json color.json -q
grep -o '"COLOR_0"' color.gltf | sort -u
grep -oE '"(atlas|vertex_attribute|size|pages|padding)": ?[^,}]*' color.gltf | tr -d ' ' | sort -u
grep -c '"images"' color.gltf
json_shape color.json | grep -E 'objects|atlas'
bake -o own.gltf --vertex-attribute occlusion | sed -n 2p
grep -oE '"(COLOR_0|_OCCLUSION)"' own.gltf | sort -u
ls
# a floor of two triangles is too coarse, and said to be
alpenglow bake builtin:torus-plane --atlas vertex -o warned.glb --warnings-as-errors -q 2>&1 |
    sed 's/errs by [0-9.]*/errs by X/; s/about [0-9.]* m/about X m/' | head -1
