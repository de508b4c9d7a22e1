# SPDX-License-Identifier: MIT
# a light map of a file that holds baked light: the map of the file is shown, whatever its form; a
# new one where an option asks for it
picture="--resolution 48x27 --samples 4 --progress off"
bake="--size 64 --texel-samples 64"
alpenglow render builtin:cornell --with lightmap $picture --size 64 --quality medium -o plain.exr >/dev/null
forms=("emissive" "moz" "extras" "extras --lightmap-format exr" "extras --units irradiance/pi" "extras --units radiance")
for i in "${!forms[@]}"; do
    alpenglow bake builtin:cornell --lightmap-as ${forms[i]} --size 64 --quality medium -q -o $i.glb
    alpenglow render $i.glb --with lightmap $picture -o $i.exr >/dev/null
    alpenglow compare $i.exr plain.exr | awk -v form="${forms[i]}" '$1 == "relative" {
        print form ": " ($2 <= .02 ? "within 2 % of a new map" : $2)}'
    alpenglow render $i.glb --with albedo --resolution 8x8 --progress off -o none.png -f >/dev/null
done
echo "== a sky is the background alone"
alpenglow render 1.glb --with lightmap $picture --sky 0.5 -q -o sky.exr
alpenglow render 1.glb --with lightmap $picture -q -o again.exr
cmp again.exr 1.exr && cmp -s sky.exr 1.exr || echo "another background"
echo "== options of baking ask for a new map"
for option in "--size 32" "--quality preview" "--error 4" "--gather hemicube --size 8" "--gather paths --size 8 --texel-samples 16" \
    "--lamp 0,0.4,0,1 --size 16" "--quality preview --texel-samples 8" "--quality high --error 1" "--error 2 --gather paths" \
    "--quality preview --bounces 0"; do
    alpenglow render 1.glb --with lightmap $picture $option -f -o other.exr 2>&1 | sed 's/, load.*//; /^Try/d'
done
# Pixels do not depend on options of a new map where surfaces are black.
alpenglow render 0.glb --with lightmap $picture --size 16 --texel-samples 1 -q -o black.exr
cmp 0.exr black.exr && echo "emission alone"
alpenglow render 0.glb --with lightmap $picture --quality preview -f -o other.exr 2>&1 | grep ^note
alpenglow render 1.glb --with lightmap $picture --lamp 0,0.4,0,1 --quality preview -f -o other.exr 2>&1 | grep ^note
echo "== occlusion is no light map"
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 4 -q -o ao.glb
alpenglow render ao.glb --with lightmap $picture -f -o other.exr; echo $?
for words in "--quality preview --gather hemicube" "--error 1 --gather hemicube"; do
    alpenglow render builtin:cornell --with lightmap $picture $words -f -o other.exr; echo $?
done
