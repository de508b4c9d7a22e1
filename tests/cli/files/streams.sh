# SPDX-License-Identifier: MIT
# what is printed and does not arrive is a failure; a stream that is closed is no place for files,
# and no file is a place for messages
quick="--size 16 --ao-samples 4 --progress off"
alpenglow bake builtin:sphere-plane $quick -q -o a.glb --maps-dir maps
alpenglow render builtin:sphere-plane --with albedo --resolution 8x8 -q -o r.png
full() {
    alpenglow "$@" >/dev/full 2>messages
    echo "full $?: $(tail -n 1 messages)"
    alpenglow "$@" >&- 2>messages
    echo "closed $?: $(tail -n 1 messages)"
}
full --version
full --help
full help bake
full --man
full --man render
full --completion bash
full info builtin:cornell
full info builtin:cornell --json
full compare maps/ao.exr maps/ao.exr
full compare maps/ao.exr maps/ao.exr --json -
full bake builtin:sphere-plane $quick -o b.glb -f
full bake builtin:sphere-plane $quick -q -o b.glb --json - -f
full render builtin:sphere-plane --with albedo --resolution 8x8 -o s.png -f
cmp a.glb b.glb && cmp r.png s.png
# with nothing open at all the files are the same
alpenglow bake builtin:sphere-plane $quick -o c.glb --report c.html --json c.json >&- 2>&- <&-
echo $?
alpenglow bake builtin:sphere-plane --size 16 --ao-samples 4 --progress plain -o d.glb 2>&- | grep -c texels
cmp a.glb c.glb && cmp a.glb d.glb && head -c 15 c.html && head -c 1 c.json
rm messages
ls
