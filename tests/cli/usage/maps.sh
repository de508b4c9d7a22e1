# SPDX-License-Identifier: MIT
# maps that have no place to go, and what cannot stand beside them
. "$(dirname "$0")/helpers.bash"
try bake scene.glb -o out.glb --maps ao,bent
try bake scene.glb -o out.glb --ao-bleed
try bake scene.glb -o out.glb --maps bent --maps-dir maps
try bake scene.glb --maps bent --maps-dir maps --existing-ao multiply
try bake scene.glb --maps-dir maps --ao-bleed --time-limit 5
try bake scene.glb --maps-dir maps --ao-bleed --keep-partial
try bake scene.glb --maps-dir maps --ao-bleed --maps bent,ao
try bake scene.glb --maps-dir maps --maps sh
try bake scene.glb --maps-dir maps --maps ao,direction
try bake scene.glb --maps-dir maps --maps light,sh --gather paths
try bake scene.glb -o out.glb --maps light,sh --atlas vertex
try bake scene.glb --maps-dir maps --maps light,probes
