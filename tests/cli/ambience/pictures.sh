# SPDX-License-Identifier: MIT
# ambience: pictures of each second, and an object at moments of the flight
printf '0,.1,.45,.4,.28,.27,0\n3,.45,.45,.4,.28,.27,0\n' >flight.csv
fly="alpenglow ambience builtin:cornell --path flight.csv --fps 5 --budget 20 --anchors 300 --errors off -q --pictures frames"
$fly --preview sphere --resolution 32x18 || echo "exit $?"
ls frames
for name in frame_0001 frame_0003 preview; do
    od -A n -t u1 -j 16 -N 8 frames/$name.png | awk '{print $3 * 256 + $4, $7 * 256 + $8}'
done
$fly 2>&1 || echo "exit $?"
echo text >file
alpenglow ambience builtin:cornell --path flight.csv --pictures file 2>&1 || echo "exit $?"
