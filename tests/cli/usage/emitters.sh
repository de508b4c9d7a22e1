# SPDX-License-Identifier: MIT
# --emitters: what counts them, and what they cannot be told apart for
. "$(dirname "$0")/helpers.bash"
bake() { try bake scene.glb --maps-dir maps --maps light "$@"; }
try bake scene.glb -o out.glb --emitters counted
bake --emitters wrong --gather hemicube
for gather in rays paths; do
    bake --emitters counted --gather $gather
    bake --emitters analytic --gather $gather
done
bake --emitters counted
bake --emitters counted --gather hemicube --bounces 0
bake --emitters counted --gather hemicube --layers
bake --emitters counted --gather hemicube --only Wall
bake --emitters counted --gather hemicube --direct only
bake --emitters counted --gather hemicube --hemicube 3
# these are good
bake --emitters counted --gather hemicube --direct apart
bake --emitters analytic --gather hemicube --layers
