# SPDX-License-Identifier: MIT
# Lights with values that are none: refused by name, or set right with a word.
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
for light in '"type":"point","intensity":-5' '"type":"point","intensity":NaN' \
    '"type":"point","intensity":1e400' '"type":"point","intensity":1e300' \
    '"type":"point","intensity":"5"' '"type":"point","color":[1,-1,1]' \
    '"type":"point","color":[1,1]' '"type":"point","range":-1' \
    '"type":"spot","spot":{"innerConeAngle":-1,"outerConeAngle":9}' '"type":"lamp"' \
    '"type":"directional","intensity":-1'; do
    room "$grey" "$(lamp 0 0 1 0)" "{$light}" >a.gltf
    echo "== $light"
    alpenglow info a.gltf 2>&1 | grep -E '^(light  |warning|alpenglow)'
done
