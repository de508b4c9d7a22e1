# SPDX-License-Identifier: MIT
# the figure is above the limit: 1; at or below it: 0. A is scaled
alpenglow render builtin:sphere-plane --with ao --ao-samples 8 --resolution 32x24 --samples 1 -q -o a.exr
alpenglow compare a.exr a.exr --scale 0.5 --max-rmse 0.01 >/dev/null; echo $?
alpenglow compare a.exr a.exr --scale 0.5 --max-rmse 0.9 >/dev/null; echo $?
alpenglow compare a.exr a.exr --scale 0.5 >/dev/null; echo $?
alpenglow render builtin:sphere-plane --with ao --ao-samples 8 --resolution 32x25 --samples 1 -q -o b.exr
alpenglow compare a.exr b.exr; echo $?
