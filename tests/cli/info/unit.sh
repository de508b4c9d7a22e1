# SPDX-License-Identifier: MIT
# The line `unit`: what a file states, and what else it may be by its size.
. "$(dirname "$0")/../scenes.bash"
obj() { # side
    printf 'v 0 0 0\nv %s 0 0\nv 0 %s 0\nf 1 2 3\n' "$1" "$1" >a.obj
}
for side in 0 1e-6 0.9 5 556 20000 1e9; do
    echo "== $side"
    obj $side
    alpenglow info a.obj 2>/dev/null | grep -e '^unit' -e '\[size\]'
done
dae() { # <unit>, <up_axis>
    triangle_dae "$1$2" 60 >a.dae
    echo "== $1 $2"
    alpenglow info a.dae 2>/dev/null | grep '^unit'
}
dae '<unit meter="0.01" name="centimeter"/>' '<up_axis>Z_UP</up_axis>'
dae '<unit meter="0.0254"/>' ''
dae '<unit meter="1"/>' '<up_axis>Y_UP</up_axis>'
dae '' '<up_axis>X_UP</up_axis>'
alpenglow info a.dae --json 2>/dev/null | sed -n '/"unit": {/,/^    }/p'
