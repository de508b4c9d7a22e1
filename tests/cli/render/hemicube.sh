# SPDX-License-Identifier: MIT
# pictures of hemicubes: sizes, what each shows, and a place on a wall
cube="alpenglow render builtin:cornell --with hemicube --camera 0,0.25,0.28,0.5,0.25,0.28,60"
$cube --hemicube 16 --size 64 -o seen.png --progress off | sed 's/, load.*//; s/exposure.*/exposure/'
for show in seen product weight perspective lambert; do
    $cube --hemicube 16 --size 64 --show $show -q -o $show.exr || echo "failed: $show"
done
$cube --hemicube 16 --size 64 --show weight -o weight.png --progress off | sed 's/, load.*//'
alpenglow compare seen.exr product.exr | head -1
alpenglow compare weight.exr product.exr --max-rmse 0 >/dev/null 2>&1 || echo "not the same"
# what a texel of that wall gathers is 4 / (N N) times the sum of the product
alpenglow render builtin:furnace --with hemicube --camera 0,0,0,0,0,1,60 --hemicube 8 --size 32 -q \
    --bounces 3 -o furnace.exr && alpenglow compare furnace.exr furnace.exr | grep pixels
