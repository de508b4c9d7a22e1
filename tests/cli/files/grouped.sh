# SPDX-License-Identifier: MIT
# messages of one kind are printed in one line with the first three places; a report has all
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
lights() { # count, intensity
    for i in $(seq "$1"); do printf ',{"type":"point","name":"bulb %d","intensity":%s}' "$i" "$2"; done
}
nodes() { for i in $(seq "$1"); do printf ',%s' "$(lamp $((i - 1)) 0 1 0)"; done; }
more=$(nodes 12) same=$(lights 12 -1)
room "$grey" "${more#,}" "${same#,}" >same.gltf
alpenglow bake same.gltf --size 8 --ao-samples 4 --maps-dir maps -q --json same.json
grep -c '"code": "light"' same.json
other=$(for i in {1..12}; do printf ',{"type":"spot","spot":{"innerConeAngle":-1,"outerConeAngle":%d}}' $((i + 3)); done)
room "$grey" "${more#,}" "${other#,}" >other.gltf
alpenglow bake other.gltf --size 8 --ao-samples 4 --maps-dir maps -q -f
echo "== references to nothing, in a bake and in info; notes" >&2
parts=$(for i in {1..40}; do printf ',{"attributes":{"POSITION":0},"indices":1,"material":%d}' $((i + 9)); done)
room "$grey" "" "" | sed 's/"primitives":\[[^]]*\]/"primitives":['"${parts#,}"']/' >missing.gltf
alpenglow bake missing.gltf --size 8 --ao-samples 4 --maps-dir maps -f 2>&1 >/dev/null | grep -E '^(warning|note)' >&2
alpenglow info missing.gltf -q | grep '\[missing\]'
echo "== one of each" >&2
room "$grey" "" "" | sed 's/"material":0/"material":3/' >one.gltf
alpenglow bake one.gltf --size 8 --ao-samples 4 --maps-dir maps -f 2>&1 >/dev/null | grep -E '^(warning|note)' >&2
echo "== files that are not there" >&2
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nmtllib c.mtl\n' >c.obj
for name in oak elm ash yew; do
    printf 'newmtl %s\nmap_Kd %s.png\n' $name $name >>c.mtl
    printf 'usemtl %s\nf 1/1 2/2 3/3\n' $name >>c.obj
done
alpenglow bake c.obj --size 8 --ao-samples 4 --maps-dir maps -q -f
echo "== places of one document" >&2
triangle_dae '<unit meter="1"/>' 1 | sed 's|</node>|<instance_camera url="#c"/>\n<instance_camera url="#d"/></node>|' >d.dae
alpenglow bake d.dae --size 8 --ao-samples 4 --maps-dir maps -q -f
echo "== notes"
printf 'newmtl m0\nmap_Kd t0.png\n' >b.mtl
printf 'mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n' >b.obj
alpenglow bake builtin:cornell --size 8 --ao-samples 4 --maps-dir t -q
for i in {1..12}; do
    cp t/ao.png "T$i.PNG"
    printf 'newmtl m%d\nmap_Kd t%d.png\n' "$i" "$i" >>b.mtl
    printf 'usemtl m%d\nf 1/1 2/2 3/3\n' "$i" >>b.obj
done
alpenglow bake b.obj --size 8 --ao-samples 4 --maps-dir maps -f 2>&1 >/dev/null | grep '^note' | grep capitals
echo "== a path is told once"
printf 'mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n' >a.obj
printf 'newmtl m\nmap_Kd none.png\n' >a.mtl
mkdir sub && cp a.obj a.mtl sub
alpenglow bake sub/a.obj --size 8 --ao-samples 4 -q 2>&1 | grep -o '^warning: none.png: cannot open'
echo "== files of other programs"
for ending in fbx kmz stl usdz FBX blend png txt; do
    echo x >scene.$ending
    alpenglow bake scene.$ending
done
alpenglow info none.fbx
