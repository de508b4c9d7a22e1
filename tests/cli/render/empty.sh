# SPDX-License-Identifier: MIT
# a scene without triangles: a warning and a picture of the sky
echo '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"name":"nothing"}]}' >empty.gltf
for method in reference albedo constant; do
    sky=$([ $method = albedo ] || echo "--sky 1,1,1")
    alpenglow render empty.gltf --with $method $sky --resolution 4x4 -q -o $method.exr &&
        echo "$method: a picture"
done
alpenglow render empty.gltf --with ao --resolution 4x4 --warnings-as-errors -q -o none.exr
echo "status $?"
alpenglow bake empty.gltf -q -o baked.gltf
echo "status $?"
ls
