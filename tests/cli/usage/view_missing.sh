# SPDX-License-Identifier: MIT
# without its program, view says what is missing
cp "$(command -v alpenglow)" .
PATH=/usr/bin ./alpenglow view scene.glb -o out.png --with albedo
