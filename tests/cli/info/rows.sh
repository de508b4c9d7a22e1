# SPDX-License-Identifier: MIT
# tables end after 20 rows, behind the findings; JSON has all of them
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
nodes() { printf ',{"mesh":0,"name":"n%d","translation":[%d,0,0]}' $(for i in $(seq "$1"); do echo "$i" "$i"; done); }
for count in 19 20 22; do # beside "walls"
    more=$(nodes $count)
    room "$grey" "${more#,}" "" >many.gltf
    alpenglow info many.gltf 2>/dev/null | sed -n '/^ triangles/,/^$/p' | tail -n 3
    alpenglow info many.gltf --json 2>/dev/null | grep -c '"triangles": 12,$'
done
alpenglow info many.gltf 2>/dev/null | grep -n -E '^(findings|  *triangles)' | cut -d: -f2 | cut -c 1-20
