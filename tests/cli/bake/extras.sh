# SPDX-License-Identifier: MIT
# the asset says what was done with occlusion that was there, and where ours went: no image to pack it into here
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -o out.gltf -q
grep -ao '"existing_ao": *"[a-z]*"\|"ao_into": *"[a-z]*"' out.gltf
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 --ao-into orm -o orm.gltf -q 2> /dev/null
grep -ao '"ao_into": *"[a-z]*"' orm.gltf
