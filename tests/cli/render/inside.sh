# SPDX-License-Identifier: MIT
# A camera inside a thing, and one below the floor, see black, and are told why.
inside="alpenglow render builtin:sphere-plane --resolution 16x9 --samples 1 -q --sky 1,1,1"
for camera in 0,0.5,0,3,0.5,0,60 0,-1,0,0,5,0,60 0,2,3,0,0,0,60; do
    for method in reference hemisphere; do
        echo "== $camera $method"
        $inside --with $method --camera $camera -o a.png -f 2>&1
    done
done
alpenglow render builtin:sphere-plane --resolution 16x9 --samples 1 -q --with albedo \
    --camera 0,-1,0,0,5,0,60 -o b.png && echo "the albedo is seen from both sides"
