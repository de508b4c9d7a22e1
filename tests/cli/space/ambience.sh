# SPDX-License-Identifier: MIT
# render and sample with the ambience volume after a flight
printf '0,.1,.45,.4,.28,.27,0\n2,.45,.45,.4,.28,.27,0\n' >flight.csv
flight="--with ambience --path flight.csv --fps 10 --budget 40 --anchors 300 -q"
printf '.28,.27,.28,0,1,0\n.28,.27,.28,0,-1,0\n' >points.csv
alpenglow sample builtin:cornell $flight --at points.csv |
    awk -F , 'NR == 2 {up = $7} NR == 3 {print (up > $7 ? "up" : "down"), NF}'
alpenglow sample builtin:cornell $flight --at points.csv --direct on --lamp .28,.3,.28,9 --time 1 | wc -l
render="alpenglow render builtin:cornell $flight --resolution 32x24 --samples 4"
$render -o view.exr || echo "exit $?"
$render -o same.exr --camera .45,.45,.4,.28,.27,0,60
$render -o scene.exr --camera 0
alpenglow compare view.exr same.exr --max-rmse 1e-3 >/dev/null && echo "the flight's camera"
alpenglow compare view.exr scene.exr --max-rmse 1e-3 >/dev/null 2>&1 || echo "the scene's camera"
$render -o between.exr --fps 2 --time 1.3
$render -o there.exr --fps 2 --time 1.3 --camera .3275,.45,.4,.28,.27,0,60
alpenglow compare between.exr there.exr --max-rmse 1e-3 >/dev/null && echo "between two frames"
$render -o early.exr --time 1 --object sphere,.28,.3,.28,.05 && ls ./*.exr
printf '1,2,3\n' >bad.csv
alpenglow sample builtin:cornell --with ambience --path bad.csv --at points.csv || echo "exit $?"
