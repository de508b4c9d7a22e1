# SPDX-License-Identifier: MIT
# a light map of a file that holds baked light: emission is shown, other maps are baked anew
picture="--resolution 48x27 --samples 4 --size 32 --texel-samples 8 --progress off"
alpenglow render builtin:cornell --with lightmap $picture -o plain.exr >/dev/null
for form in emissive moz extras; do
    alpenglow bake builtin:cornell --maps light --lightmap-as $form --size 64 -q -o $form.glb
    alpenglow render $form.glb --with lightmap $picture -o $form.exr >/dev/null
    alpenglow render $form.glb --with albedo --resolution 8x8 --progress off -o none.png -f >/dev/null
done
# Pixels do not depend on the new map where surfaces are black.
alpenglow render emissive.glb --with lightmap $picture --size 16 --texel-samples 1 -q -o other.exr
cmp emissive.exr other.exr && echo "emission alone"
alpenglow render emissive.glb --with lightmap $picture -q -f -o quiet.exr
