# SPDX-License-Identifier: MIT
# Shape of the tables only: figures of small runs mean nothing. Numbers become 0, and runs of
# blanks one blank.
export ALPENGLOW_SHARED=/nowhere # the same scenes everywhere
shape() { sed -E 's/[0-9]+(\.[0-9]+)?/0/g; s/[+-]0/0/g; s/-?nan|-?inf/?/g; s/ +/ /g; s/:?-+:?/-/g'; }
alpenglow bench --quick | shape
echo
alpenglow bench transport --quick --markdown | shape
alpenglow bench atlas --quick --scene hills:200 | shape
alpenglow bench atlas --scene nothing.glb 2>/dev/null
echo "no such scene: $?"
