# SPDX-License-Identifier: MIT
# a file whose surfaces emit baked light: lightmap and none show the same
. "$(dirname "$0")/gl.bash"
alpenglow bake builtin:cornell --maps light --lightmap-as emissive --size 64 -q -o lit.glb
alpenglow view lit.glb --with none --resolution 48x27 -q -o none.exr
alpenglow view lit.glb --with lightmap --resolution 48x27 --size 32 --texel-samples 8 --progress off -o lightmap.exr >/dev/null
cmp none.exr lightmap.exr && echo "the same"
