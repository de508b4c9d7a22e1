# SPDX-License-Identifier: MIT
# The numbers of docs/conventions.md, of a sky of radiance 1 over black ground: +Y is the brightest
# in every convention.
. "$(dirname "$0")/sky.bash"
sky sky.hdr
alpenglow sh sky.hdr
for convention in three filament gltf godot unity ambient-cube; do
    echo "== $convention"
    alpenglow sh sky.hdr --convention $convention
done
