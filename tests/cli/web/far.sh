# SPDX-License-Identifier: MIT
# Light in space has a place in the world of the file: in a room 500 km away the page takes the probes
# and the volume of this room, and refuses those of a room elsewhere.
. "$(dirname "$0")/../usage/helpers.bash"
. "$(dirname "$0")/../scenes.bash"
at() { # x, name: a room about (x, 0, 0), baked, with its light in space
    room '{"pbrMetallicRoughness":{"metallicFactor":0}}' "$(lamp 0 "$1" 1 0)" '{"type":"point","intensity":20}' |
        sed "s/\"name\":\"walls\"/&,\"translation\":[$1,0,0]/" >"$2.gltf"
    alpenglow bake "$2.gltf" -q -o "$2.glb" --maps light --samples 16 --size 16
    alpenglow lpv "$2.gltf" -q --grid 4 --frames 1 --volume "$2.lpv.json"
    alpenglow probes "$2.gltf" -q -o "$2.probes.json" --spacing 2
}
at 500000.25 far 2>/dev/null
at 500100 farther 2>/dev/null
if alpenglow web far.glb -q -o page.html 2>&1 | grep -q 'built without'; then
    echo "the page is not built, three.js is absent" >&2
    exit 77
fi
try web far.glb -q -f -o page.html --volume far.lpv.json --probes far.probes.json
grep -o '"cell":.*"size":[^]]*]' far.lpv.json
grep -o '"corner": [^]]*]' page.html
try web far.glb -q -f -o page.html --volume farther.lpv.json
try web far.glb -q -f -o page.html --probes farther.probes.json
