# SPDX-License-Identifier: MIT
# render --with hemicube: what it takes, and what it does not look at
. "$(dirname "$0")/helpers.bash"
render() { try render scene.glb -o out.png "$@"; }
render --with hemicube --hemicube 3
render --with hemicube --hemicube 0
render --with hemicube --hemicube 1025
render --with hemicube --show nothing
render --with hemicube --resolution 64x64
render --with hemicube --samples 4
render --with hemicube --texel-samples 4
render --with hemicube --ao-samples 4
render --with hemicube --occluders Wall
for method in reference radiosity lightmap ao albedo; do
    render --with $method --show weight
    render --with $method --hemicube 64
done
# these are good
render --with hemicube --show product --hemicube 64 --size 64 --bounces 2 --sky 1,1,1 --lamp 0,1,0,5
