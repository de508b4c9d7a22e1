# SPDX-License-Identifier: MIT
# outputs that cannot be written are told before the work (the rays asked for would take hours)
: >file
mkdir folder folder.glb folder.png
bake="alpenglow bake builtin:sphere-plane --size 2048 --ao-samples 1048576 --progress off"
render="alpenglow render builtin:sphere-plane --with ao --ao-samples 1048576 --progress off"
check() {
    "$@" >/dev/null
    echo "$?: ${*##* --progress off }"
}
check timeout 20 $bake -o missing/out.glb
check timeout 20 $bake -o file/out.glb
check timeout 20 $bake -o folder.glb
check timeout 20 $bake --maps-dir file
check timeout 20 $bake --maps-dir missing/deeper/maps
check timeout 20 $bake -o out.glb --json missing/report.json
check timeout 20 $bake -o out.glb --json folder
check timeout 20 $render -o missing/out.png
check timeout 20 $render -o folder.png
check timeout 20 alpenglow compare a b --heatmap missing/heat.png
check timeout 20 alpenglow compare a b --heatmap heat.jpg
check timeout 20 alpenglow compare a b --json missing/numbers.json
find . | sort
