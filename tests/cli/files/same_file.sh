# SPDX-License-Identifier: MIT
# -f overwrites what was there, never what the same command reads or writes
quick="--size 16 --ao-samples 4 --progress off -q -f"
alpenglow bake builtin:sphere-plane $quick -o scene.glb
cp scene.glb before.glb
alpenglow bake scene.glb $quick -o out.glb --json out.glb; echo $?
alpenglow bake scene.glb $quick -o out.glb --json scene.glb; echo $?
alpenglow bake scene.glb $quick -o out.glb --json ./scene.glb; echo $?
cmp scene.glb before.glb && ls
alpenglow bake scene.glb $quick -o out.glb --json page.html --report ./page.html; echo $?
: >page.html
alpenglow bake scene.glb $quick -o out.glb --json page.html --report ./page.html; echo $?
alpenglow compare a.exr b.exr --heatmap x.png --json x.png; echo $?
