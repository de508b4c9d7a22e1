# SPDX-License-Identifier: MIT
# what cannot be compared: 1 and where it is; what means nothing: 2
alpenglow bake builtin:sphere-plane --size 64 --ao-samples 4 -q -o ao.glb
alpenglow bake builtin:sphere-plane --size 64 --samples 4 --sky 1,1,1 --maps light --lightmap-as moz -q -o light.glb
try() { alpenglow compare "$@"; echo "$* | $?"; }
try ao.glb builtin:cornell
try ao.glb builtin:sphere-plane
try ao.glb light.glb
try ao.glb light.glb --map ao
try ao.glb light.glb --map light
try ao.glb missing.glb
try ao.glb missing.png
try missing.png missing.png --map ao
try missing.png missing.png --points 3
try ao.glb ao.glb --heatmap heat.png
try ao.glb ao.glb --points 0
try ao.glb ao.glb --map bent
