# SPDX-License-Identifier: MIT
# light: what it needs, what cannot stand beside it, what is no sky and no sun
. "$(dirname "$0")/helpers.bash"
bake() { try bake scene.glb --maps-dir maps --maps light "$@"; }
render() { try render scene.glb -o out.png "$@"; }
try bake scene.glb -o out.glb --sky 1,1,1
try bake scene.glb -o out.glb --bounces 2
try bake scene.glb -o out.glb --maps light --maps-dir maps
try bake scene.glb -o out.glb --maps ao,light --maps-dir maps --ao-self
bake --time-limit 5
bake --keep-partial
for sky in 1 1,1 1,1,1,1 1,1,-1 1,1,1/ 1,1,1/1,1 a,b,c 1,1,x "" sky.png nan,1,1 1,1,inf 1,1,1e10; do bake --sky "$sky"; done
for sun in 1 1,2 1,2,3,4 361,0,1 0,91,1 0,0,-1 x,0,1 0,45,nan 0,45,inf 0,45,1e10; do bake --sun "$sun"; done
bake --sky-turn 5
for strength in -1 nan inf; do bake --sky 1,1,1 --sky-strength $strength; done
for size in 91 -1 nan; do bake --sun 0,45,1 --sun-size $size; done
bake --bounces -1
bake --bounces 1001
bake --bounces many
bake --samples 0
bake --samples 65537
try bake scene.glb -o out.glb --metals black
bake --metals shiny
bake --metals black
try bake scene.glb --maps-dir maps --ao-bleed --metals black
render --with ao --metals black
render --with albedo --metals black
render --with ao --sky 1,1,1
render --with albedo --bounces 3
render --with reference --size 64
render --with radiosity --texel-samples 64
render --with ao --texel-samples 64
render --with lightmap --ao-samples 64
render --with radiosity --occluders a
render --with radiosity --size 0
render --with lightmap --size 16385
render --with lightmap --texel-samples 0
render --with lightmap --gather paths
render --with lightmap --bounces -1
render --with hemisphere --sun 0,45,1
render --with hemisphere --sky clear
render --with hemisphere --sky sky.hdr
