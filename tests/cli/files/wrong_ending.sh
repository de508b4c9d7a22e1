# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../usage/helpers.bash"
try bake scene.glb -o out.blend
try bake scene.glb -o out
try bake scene.glb -o glb
try bake scene.glb -o out.glb --report page.txt
try render scene.glb --with ao -o out.jpg
try render scene.glb --with ao -o out
