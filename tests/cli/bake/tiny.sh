# SPDX-License-Identifier: MIT
# a real bake, end to end; what was written is read back
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -o out.glb --maps-dir maps --threads 2
echo $?
ls . maps
head -c 4 out.glb; echo
alpenglow info out.glb --json >info.json && json_shape info.json | head -3
alpenglow compare maps/ao.exr maps/ao.exr --max-rmse 0 >/dev/null && echo readable
