# SPDX-License-Identifier: MIT
# an OBJ in and out: its files, what it says of materials, and what it has no place for
cat > chair.obj <<'OBJ'
mtllib chair.mtl
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 1 0
v 1 1 0
o seat
usemtl wood
f 4 3 2 1
g back
f 1 2 6 5
OBJ
printf 'newmtl wood\nKd 0.5 0.4 0.25\n' > chair.mtl
exec 2>&1
bake() {
    alpenglow bake "$@" --size 32 -q
    echo "$?"
}
bake chair.obj -o out.obj
ls
cat out.mtl | tail -n +2
grep -vE '^(v|vt|#)' out.obj
bake out.obj -o again.glb
bake chair.obj -o out.obj
bake chair.obj -o out.obj -f --only 'seat/*'
grep -A3 newmtl out.mtl
bake chair.obj -o lit.obj --maps light --samples 16 --sky 1,1,1 --lightmap-as emissive
grep -E '^(Kd|map_K)' lit.mtl
bake chair.obj -o no.obj --maps light --samples 16 --sky 1,1,1 --lightmap-as moz
alpenglow bake chair.obj -o no.obj --atlas vertex -q
bake builtin:cornell -o box.obj
ls ./*.obj
