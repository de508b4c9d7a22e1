# SPDX-License-Identifier: MIT
# options that do not apply to values at vertices, or only to them, are refused and never ignored
. "$(dirname "$0")/helpers.bash"
try bake scene.glb -o out.glb --atlas vertex --size 64
try bake scene.glb -o out.glb --atlas vertex --texels-per-metre 3
try bake scene.glb -o out.glb --atlas vertex --padding 2
try bake scene.glb -o out.glb --atlas vertex --block 4
try bake scene.glb -o out.glb --atlas vertex --mips 1
try bake scene.glb -o out.glb --atlas vertex --density 'a*=2'
try bake scene.glb -o out.glb --atlas keep --block 4
try bake scene.glb -o out.glb --atlas keep --density 'a*=2'
try bake scene.glb -o out.glb --atlas vertex --existing-ao multiply
try bake scene.glb -o out.glb --atlas vertex --maps-dir maps
try bake scene.glb --atlas vertex --maps-dir maps
try bake scene.glb -o out.glb --atlas vertex --maps ao,bent
try bake scene.glb -o out.glb --atlas vertex --ao-bleed
try bake scene.glb -o out.glb --atlas vertex --error 1
try bake scene.glb -o out.glb --atlas vertex --quality high
try bake scene.glb -o out.glb --atlas vertex --time-limit 5
try bake scene.glb -o out.glb --atlas vertex --keep-partial
try bake scene.glb -o out.glb --atlas vertex --adaptive off
try bake scene.glb -o out.glb --atlas vertex --only 'a*'
try bake scene.glb -o out.glb --atlas vertex --ao-self
try bake scene.glb -o out.glb --ao-self --occluders 'a*'
try bake scene.glb -o out.glb --only ''
try bake scene.glb --atlas vertex
try bake scene.glb -o out.glb --vertex-attribute color
try bake scene.glb -o out.glb --atlas charts --vertex-attribute occlusion
try bake scene.glb -o out.glb --atlas vertex --vertex-attribute COLOR_0
