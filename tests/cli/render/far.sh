# SPDX-License-Identifier: MIT
# coordinates of a national grid: cameras and lamps stand where they are given, in double
square() { # x, z of the middle
    printf 'v %s.25 0 %s.25\nv %s.75 0 %s.25\nv %s.75 0 %s.75\nv %s.25 0 %s.75\nf 4 3 2 1\n' \
        "$1" "$2" "$1" "$2" "$1" "$2" "$1" "$2"
}
square 0 0 >near.obj
square 500000 4000000 >far.obj
picture() { # name, x, z of the middle
    alpenglow render "$1.obj" --with reference --samples 64 --resolution 32x24 -q -o "$1.exr" \
        --camera "$2.5,0.6,$3.9,$2.5,0,$3.5,40" --lamp "$2.4,0.3,$3.4,0.2"
}
picture near 0 0 && picture far 500000 4000000
alpenglow compare near.exr far.exr --max-rmse 0.003 >/dev/null && echo "the same picture"
alpenglow info far.obj | grep bounds
alpenglow bake far.obj --size 16 --ao-samples 16 -q -o baked.obj && grep '^v ' baked.obj
