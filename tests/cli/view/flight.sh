# SPDX-License-Identifier: MIT
# the pictures of a flight; an existing one stops it
. "$(dirname "$0")/gl.bash"
printf '%s\n' t,px,py,pz,tx,ty,tz 0,0.28,0.27,1.5,0.28,0.27,0 2,0.4,0.3,1,0.2,0.2,0 >flight.csv
view="alpenglow view builtin:cornell --with albedo --path flight.csv --resolution 32x18"
$view --frames 3 --pictures frames | head -1 | cut -d, -f1-2
ls frames
cmp -s frames/frame_0001.png frames/frame_0003.png && echo "the camera stands still"
$view --frames 1 --pictures frames
echo "exit $?"
$view --frames 1 --pictures frames -f -q
echo "exit $?"
