# SPDX-License-Identifier: MIT
# --report writes a page with the command as it was given, the warnings and all maps; at vertices
# it has none
quick="--size 32 --ao-samples 16 --samples 16 --progress off -q"
alpenglow bake builtin:sphere-plane $quick --maps ao,bent,light --sky 1,1,1 --maps-dir 'it'\''s <maps>' \
    --report page.html --ao-distance inf; echo $?
head -c 15 page.html; echo
grep -o '<code class="command">.*</code>' page.html
grep -o '<h[12]>[^/]*</' page.html
grep -o 'alt="[^"]*"' page.html
grep -c 'src="data:image/png;base64,iVBOR' page.html
alpenglow bake builtin:furnace --size 32 --ao-samples 16 -o dark.glb --report dark.html --ao-distance inf \
    -q 2>/dev/null; echo $?
sed -n '/id="findings"/,/<.ul>/p' dark.html
alpenglow bake builtin:furnace --atlas vertex --ao-samples 16 -o vertex.glb --report vertex.html -q \
    2>/dev/null; echo $?
grep -o '<h[12]>[^/]*</' vertex.html
ls
