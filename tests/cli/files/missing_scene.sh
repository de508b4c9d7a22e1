# SPDX-License-Identifier: MIT
# the message names the file; nothing is written
for command in "bake missing.glb -o out.glb" "render missing.glb -o out.png --with ao" \
    "info missing.glb" "info missing.gltf" "bake builtin:nothing -o out.glb" "info ." "info notes.txt"; do
    echo "alpenglow $command" >&2
    echo "just text" >notes.txt
    alpenglow $command
    echo $?
done
rm notes.txt
ls
