# SPDX-License-Identifier: MIT
# light in the asset: what it needs, what cannot stand beside it
. "$(dirname "$0")/helpers.bash"
bake() { try bake scene.glb "$@"; }
bake -o out.glb --lightmap-as emissive
bake -o out.glb --maps ao --lightmap-as moz
bake --maps light --maps-dir maps --lightmap-as extras
bake -o out.glb --maps ao --units radiance
bake -o out.glb --maps ao,light --maps-dir maps --units irradiance
bake -o out.glb --maps light --maps-dir maps --lightmap-format exr
bake -o out.glb --maps light --lightmap-as emissive --units irradiance
bake -o out.glb --maps light --lightmap-as moz --units radiance
bake -o out.glb --maps light --lightmap-as moz --units E
bake -o out.glb --maps light --lightmap-as moz --lightmap-format exr
bake -o out.glb --maps ao,light --lightmap-as moz --ao-into orm
bake -o out.glb --maps light --lightmap-as emissive --direct off
bake -o out.glb --maps light --lightmap-as three
bake -o out.json --maps light --lightmap-as babylon
bake -o out.json --maps light --lightmap-as three --units irradiance
bake -o out.json --maps ao,light --lightmap-as three
bake -o out.json --maps light --lightmap-as three --lightmap-format exr
bake -o out.json
bake -o out.glb --maps light
bake -o out.glb --maps bent,light --lightmap-as moz
