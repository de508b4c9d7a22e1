# SPDX-License-Identifier: MIT
# what is baked and what is gathered, beside the reference; options that they alone have
plain="alpenglow render builtin:cornell --resolution 32x24 -q"
$plain --with reference --samples 256 -o reference.exr
$plain --with lightmap --samples 64 --size 64 --texel-samples 64 -o lightmap.exr
$plain --with radiosity --samples 256 --size 64 -o radiosity.exr
for method in lightmap radiosity; do
    alpenglow compare $method.exr reference.exr --max-rmse 0.15 >/dev/null && echo "$method is near"
done
$plain --with lightmap --samples 4 --size 32 --threads 1 -o one.exr &&
    $plain --with lightmap --samples 4 --size 32 --threads 7 -o seven.exr &&
    cmp one.exr seven.exr && echo "same bits"
alpenglow render builtin:sphere-plane --resolution 16x12 --with lightmap --size 16 -o dark.exr 2>&1 |
    grep -c "nothing lights the scene"; ls dark.exr 2>/dev/null || true
alpenglow render builtin:furnace --resolution 16x12 --samples 2 --size 16 --texel-samples 8 -q \
    --with lightmap -o picture.png && head -c 4 picture.png | tail -c 3; echo
