# SPDX-License-Identifier: MIT
# an OBJ as people's programs write it: textures behind options, in quotes, of another machine and in
# other capitals; masks, Tr 1, missing vt; all statements come out again
exec 2>&1
bake() {
    alpenglow bake "$@" --size 32 -q
    echo "$?"
}
printf 'v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3 4\n' > plane.obj
mkdir -p in/sub out
bake plane.obj -o plane.baked.obj
mv plane.baked.ao.png in/tex.png
cp in/tex.png 'in/sub/My Wood.png'
cat > in/a.mtl <<'MTL'
# by hand
newmtl wood
  Kd 0.50 .4 0.3
Ns 250
Ni 1.45
map_Kd -colorspace sRGB "sub\my wood.png" -bm 0.5
map_Bump C:\Users\someone\tex.png
newmtl glass
Kd 1 1 1
Tr 1
newmtl leaf
Kd 0.3 0.8 0.3
map_d tex.png # a mask
MTL
cat > in/house.obj <<'OBJ'
mtllib A.mtl
o House
g walls
s 1
v 0 0 0.000 1 0 0
v 1.0 0 0
v 1 0 -1e0
v 0 0 -1
v 2 0 0
v 2 0 -1
v 3 0 0
v 3 0 -1
vt 0 0
vt .3 0
vt .3 1
vt 0 1
vt .6 0
vt .6 1
vt 1 0
vt 1 1
usemtl wood
f 1/1 2/2 3/3 4/4
usemtl glass
f 2/2 5/5 6/6 3/3
usemtl leaf
f 5/5 7/7 8/8 6/6
OBJ
bake in/house.obj -o out/house.obj
tail -n +3 out/house.obj | diff in/house.obj -
tail -n +2 out/house.mtl | diff in/a.mtl -
(cd out && find . -type f | sort)
alpenglow bake in/house.obj -o house.glb --size 32 | grep -c atlas
sed 's,^f 5/5 7/7 8/8 6/6,f 1//1 2//1 3//1,' in/house.obj > in/novn.obj
bake in/novn.obj -o novn.glb
