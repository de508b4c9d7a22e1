# SPDX-License-Identifier: MIT
# -q says nothing
alpenglow bake builtin:sphere-plane --size 16 --ao-samples 4 -o out.gltf -q && ls out.gltf
