# SPDX-License-Identifier: MIT
# --lamp and --spot: where they have no meaning, what is none, and how many there may be
. "$(dirname "$0")/helpers.bash"
bake() { try bake scene.glb --maps-dir maps --maps light "$@"; }
try bake scene.glb -o out.glb --lamp 0,1,0,5
try bake scene.glb -o out.glb --spot 0,1,0,0,0,0,5,10,20
for method in ao albedo; do
    try render scene.glb -o out.png --with $method --lamp 0,1,0,5
done
try render scene.glb -o out.png --with ao --spot 0,1,0,0,0,0,5,10,20
try info scene.glb --lamp 0,1,0,5
for lamp in 0,1,0 0,1,0,5,1 0,1,0,5,1,1 0,1,0,5,1,1,1,1 0,1,0,5, 0,1,0,5/1,1,1 x,1,0,5 nan,1,0,5 \
    0,inf,0,5 0,1,0,nan 0,1,0,-5 0,1,0,inf 0,1,0,1e10 1e10,1,0,5 0,1,0,5,-1,1,1 0,1,0,5,1,nan,1 '' \
    '0, 1,0,5'; do
    bake --lamp "$lamp"
done
place=0,1,0,0,0,0
for spot in 1 $place,5,10 $place,5,10,20,1 $place,5,10,20,1,1,1,1 $place,-5,10,20 $place,nan,10,20 \
    $place,5,-1,20 $place,5,20,20 $place,5,30,20 $place,5,20,20.0000000001 $place,5,10,91 \
    $place,5,nan,20 $place,5,10,inf $place,5,10,20,1,1,-1 0,1,0,0,1,0,5,10,20 nan,1,0,0,0,0,5,10,20; do
    bake --spot "$spot"
done
bake --lamp 0,1,0,5 --lamp 1 # each of them is looked at
bake --lamp --spot
bake --lamp 0,1,0,0 --lamp=-1,-2.5,1e3,5,0,0,0 --spot -$place,5,0,90 # these are good
many=$(printf ' --lamp %s,1,0,5' {1..32})$(printf " --spot %s,1,0,0,0,0,5,10,20" {1..32})
(bake $many) | sed 's/.* | /64 | /'
(bake $many --lamp 65,1,0,5) | sed 's/.* | /65 | /'
