# SPDX-License-Identifier: MIT
# outputs that cannot be written are told before the work (the rays asked for would take hours)
: >file
mkdir folder folder.glb folder.png
bake="alpenglow bake builtin:sphere-plane --size 2048 --ao-samples 1048576 --progress off"
render="alpenglow render builtin:sphere-plane --with ao --ao-samples 1048576 --progress off"
check() {
    local code=0 words="$*"
    timeout 20 "$@" >/dev/null || code=$?
    echo "$code: ${words##*--progress off }"
}
check $bake -o missing/out.glb
check $bake -o file/out.glb
check $bake -o folder.glb
check $bake --maps-dir file
check $bake -o out.glb --json missing/report.json
check $bake -o out.glb --json folder
check $bake -o out.glb --report missing/page.html
check $bake -o out.glb --report file/page.html
check $render -o missing/out.png
check $render -o folder.png
check alpenglow compare a b --heatmap missing/heat.png
check alpenglow compare a b --heatmap heat.jpg
check alpenglow compare a b --json missing/numbers.json
find . | sort
