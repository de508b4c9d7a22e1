# SPDX-License-Identifier: MIT
# nodes that an animation moves: a flight passes the poses of --animation-time
. "$(dirname "$0")/gl.bash"
. "$(dirname "$0")/../scenes.bash"
slide >slide.gltf
camera=-2,1.5,4,0,0.7,0,45
printf '%s\n' t,px,py,pz,tx,ty,tz,vfov "0,$camera" "2,$camera" >flight.csv
view="alpenglow view slide.gltf --resolution 64x36 -q"
fly() { # folder, options
    $view --path flight.csv --frames 3 --exposure 0 --pictures "$@"
    echo "$1: exit $?"
}
same() { # two pictures
    alpenglow compare "$1" "$2" --max-rmse 0 >/dev/null 2>&1 && echo "$1 is $2" || echo "$1 is not $2"
}
for mode in direct lpv reference; do
    fly $mode --with $mode
    $view --with $mode --camera $camera --animation-time 1 --exposure 0 -o $mode.png
done
same direct/frame_0001.png direct/frame_0002.png
same direct/frame_0002.png direct.png
same reference/frame_0001.png reference/frame_0002.png
echo "== light propagation has the cells of the file's pose"
alpenglow compare lpv/frame_0002.png lpv.png --max-rmse 0.02 >/dev/null && echo "about the same"
echo "== maps keep the light of --animation-time"
$view --path flight.csv --frames 3 --pictures map --with ao --animation-time 1
$view --with ao --camera $camera --animation-time 1 -o ao.png
same map/frame_0002.png ao.png
same map/frame_0001.png map/frame_0003.png
echo "== another animation, and none"
fly turn --with direct --animation turn
same turn/frame_0002.png direct.png
fly none --with direct --animation none
same none/frame_0001.png none/frame_0003.png
fly absent --with direct --animation absent
fly both --with direct --animation none --animation-time 1
$view --with direct --animation turn -o turn.png
echo "exit $?"
alpenglow render slide.gltf --with reference --samples 16 --camera $camera --resolution 64x36 -q \
    --animation-time 1 -o render.exr
$view --with direct --camera $camera --animation-time 1 -o direct.exr
alpenglow compare direct.exr render.exr --max-rmse 0.2 >/dev/null && echo "about as render"
