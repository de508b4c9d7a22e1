# SPDX-License-Identifier: MIT
# ambience: what it needs, what cannot stand beside it, numbers out of range, options that do not apply
. "$(dirname "$0")/helpers.bash"
fly() { try ambience scene.glb --path flight.csv "$@"; }
try ambience
try ambience scene.glb
try ambience builtin:terrains
try ambience scene.glb other.glb --path flight.csv
fly --budget 0
fly --budget -1
fly --budget 65537
fly --budget 10 --budget-ms 2
fly --budget-ms 0
fly --budget-ms nan
fly --budget-ms -1
fly --budget-ms 10001
fly --budget-ms fast
fly --budget-ms
fly --detail -1
fly --detail auto
fly --fps 0
fly --fps nan
fly --time inf
fly --cell 0
fly --depth 0
fly --depth 11
fly --anchors 63
fly --lifetime 0
fly --fade -1
fly --flat maybe
fly --lookup three
fly --prediction guess
fly --day 20
fly --day 0 --sun 0,45,1
fly --day 9 --sun 0,-5,1000
fly --sky clear
fly --bounces 2
fly --preview teapot
fly --preview cube --pictures frames
fly --errors off --reference-samples 64
fly --resolution 0x9
fly --csv - --json -
fly --csv out --json out
fly --csv flight.csv -f
fly --json ./flight.csv -f
fly --json scene.glb -f
fly --resolution 64x36
fly --path
fly --flat
fly --pat flight.csv
fly -o out.png
for command in "render scene.glb -o out.png" "sample scene.glb --at points.csv"; do
    try $command --with ambience
    try $command --with ambience --path flight.csv --bounces 2
    try $command --with ambience --path flight.csv --spacing 1
    try $command --with ambience --path flight.csv --budget 5 --budget-ms 1
    try $command --with ambience --path flight.csv --csv -
    try $command --with constant --path flight.csv
    try $command --with constant --detail 1
    try $command --with probes --lifetime 5
done
try sample scene.glb --at - --with ambience --path -
try sample scene.glb --at points.csv --with ambience --path flight.csv --samples 9
