# SPDX-License-Identifier: MIT
# bake --density: what is refused is refused at once, before a guess at how long the bake takes
. "$(dirname "$0")/helpers.bash"
for density in floor flor=2 floor=2000 floor=1000,floor=2 'material:red=.001,*wall=.1'; do
    try bake builtin:cornell --atlas charts --size 64 --ao-samples 4 -o out.glb --density "$density"
done
