# SPDX-License-Identifier: MIT
# What the doctor tells: by severity, with what is seen and what to do; many of a kind are counted.
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
room "$grey" "$(lamp 0 0 1 0)" '{"type":"point","name":"bulb","intensity":3e6,"range":0.1}' >strong.gltf
room "$grey" "$(for i in {1..10}; do printf '%s,' "$(lamp 0 0 1 0)"; done)$(lamp 0 0 1 0)" \
    '{"type":"point","name":"bulb","intensity":0}' >off.gltf
for scene in strong off; do
    echo "== $scene"
    alpenglow info $scene.gltf | sed -n '/^findings/,/^$/p'
    alpenglow info $scene.gltf --json 2>/dev/null >$scene.json
    grep -E '"(code|severity)"' $scene.json | sort | uniq -c
done
json_shape strong.json | grep -E '^.(findings|uv_sets|pictures|warnings)'
echo "== nothing to bake is an error of the scene, not of info"
echo '{"asset":{"version":"2.0"},"scene":0,"scenes":[{}]}' >empty.gltf
alpenglow info empty.gltf | sed -n '/^findings/,/^$/p'
echo "${PIPESTATUS[0]}"
echo "== what the reader warned of is told where it fails"
room "$grey" "$(lamp 0 0 1 0),$(lamp 1 0 1 0)" \
    '{"type":"point","intensity":-1},{"type":"lamp"}' >bad.gltf
alpenglow info bad.gltf
echo $?
