# SPDX-License-Identifier: MIT
# Ten thousand lamps within a millimetre, and as many in one place, are as one of their sum.
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
lamps() { # apart by so many micrometres
    local i
    printf '{"name":"no lamp"}' # a comma goes before each that follows
    for ((i = 0; i < 10000; i++)); do
        printf ',{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[%se-6,1,%se-6]}' \
            $((i % 100 * $1)) $((i / 100 * $1))
    done
}
room "$grey" "$(lamps 10)" '{"type":"point","intensity":0.001}' >near.gltf
room "$grey" "$(lamps 0)" '{"type":"point","intensity":0.001}' >same.gltf
room "$grey" "$(lamp 0 0 1 0)" '{"type":"point","intensity":10}' >one.gltf
alpenglow info near.gltf --json | grep -c candela
for scene in near same one; do
    timeout 60 alpenglow bake $scene.gltf --maps light --maps-dir $scene --size 32 --samples 64 \
        --bounces 0 -q || echo "$scene: $?"
done
# In one place: rounding of sums of 10,000. Near: irradiance is up to 10 under the ceiling, a metre
# away, of which a millimetre is 0.002.
alpenglow compare one/irradiance.exr same/irradiance.exr --max-rmse 1e-5 >same.txt && echo "as one"
alpenglow compare one/irradiance.exr near/irradiance.exr --max-rmse 0.02 >near.txt && echo "as one"
