# SPDX-License-Identifier: MIT
# a scene without triangles: a warning and a picture of the sky
. "$(dirname "$0")/gl.bash"
echo '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"name":"nothing"}]}' >empty.gltf
alpenglow view empty.gltf --with constant --sky 1,1,1 --resolution 4x4 -q -o sky.exr &&
    alpenglow render empty.gltf --with constant --sky 1,1,1 --resolution 4x4 -q -o rendered.exr &&
    alpenglow compare sky.exr rendered.exr --max-rmse 1e-6 >/dev/null && echo "like render"
alpenglow view empty.gltf --with lightmap --sky 1,1,1 --resolution 4x4 -q -o map.exr
echo "status $?"
