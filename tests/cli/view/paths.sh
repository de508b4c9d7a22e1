# SPDX-License-Identifier: MIT
# the reference of 16 paths is that of render; frames of a flight have paths of their own
. "$(dirname "$0")/gl.bash"
common="builtin:cornell --with reference --samples 16 --resolution 32x18 -q"
alpenglow render $common -o rendered.exr
alpenglow view $common -o drawn.exr --reference rendered.exr --reference-threshold 1e-6 | cut -c1-15
echo "exit ${PIPESTATUS[0]}"
printf '%s\n' t,px,py,pz,tx,ty,tz 0,0.28,0.4,0.5,0.28,0.2,0 2,0.28,0.4,0.5,0.28,0.2,0 >flight.csv
alpenglow view $common --path flight.csv --frames 2 --exposure 0 --pictures frames
cmp -s frames/frame_0001.png frames/frame_0002.png || echo "frames differ"
