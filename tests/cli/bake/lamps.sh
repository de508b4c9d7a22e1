# SPDX-License-Identifier: MIT
# --lamp and --spot are the lights of a file in the same places, in the same bits: without bounces,
# with one, and in a picture; more than one of each, and beside those of the file
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
lights='{"type":"point","intensity":40,"color":[1,0.5,0.25]},
{"type":"spot","intensity":20,"spot":{"innerConeAngle":0.5235987755982988,
"outerConeAngle":0.7853981633974483}}'
room "$grey" "$(lamp 0 0 1 0),$(lamp 1 1 1.5 0),$(lamp 0 1 0 0.5)" "$lights" >lit.gltf
room "$grey" "$(lamp 0 0 1 0)" "$lights" >one.gltf
room "$grey" "" "$lights" >dark.gltf
first='--lamp 0,1,0,40,1,0.5,0.25'
spot='--spot 1,1.5,0,1,1.5,-1,20,30,45' # along -Z, as the file's
last='--lamp=1,0,0.5,40,1,0.5,0.25'
bake() { # scene, folder, options
    local scene=$1 folder=$2
    shift 2
    alpenglow bake "$scene.gltf" --maps light --maps-dir "$folder" --size 32 --samples 16 -q "$@" ||
        echo "failed: $scene $*"
}
for bounces in 0 1; do
    bake lit file$bounces --bounces $bounces
    bake dark options$bounces --bounces $bounces $first $spot $last
    bake one both$bounces --bounces $bounces $spot $last
    bake dark less$bounces --bounces $bounces $first $spot
    cmp file$bounces/irradiance.exr options$bounces/irradiance.exr && echo "as the file's"
    cmp file$bounces/irradiance.exr both$bounces/irradiance.exr && echo "beside the file's"
    cmp -s file$bounces/irradiance.exr less$bounces/irradiance.exr || echo "less with less"
done
render="--with reference --resolution 16x16 --samples 4 -q"
alpenglow render lit.gltf $render -o file.exr
alpenglow render dark.gltf $render -o options.exr $first $spot $last
cmp file.exr options.exr && echo "the same picture"
echo "== warnings name them, counted from 0"
alpenglow bake dark.gltf --maps light --maps-dir hidden --size 16 --samples 1 \
    --lamp 0,1,0,1 --lamp 0,9,0,1 2>&1 | grep '^warning'
