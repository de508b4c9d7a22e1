# SPDX-License-Identifier: MIT
# The line `unit`: what a file states, and what else it may be by its size.
obj() { # side
    printf 'v 0 0 0\nv %s 0 0\nv 0 %s 0\nf 1 2 3\n' "$1" "$1" >a.obj
}
for side in 0 1e-6 0.9 5 556 20000 1e9; do
    echo "== $side"
    obj $side
    alpenglow info a.obj 2>/dev/null | grep -e '^unit' -e '\[size\]'
done
dae() { # <unit>, <up_axis>
    cat >a.dae <<TEXT
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>$1$2</asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 60 0 0 0 60 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
TEXT
    echo "== $1 $2"
    alpenglow info a.dae 2>/dev/null | grep '^unit'
}
dae '<unit meter="0.01" name="centimeter"/>' '<up_axis>Z_UP</up_axis>'
dae '<unit meter="0.0254"/>' ''
dae '<unit meter="1"/>' '<up_axis>Y_UP</up_axis>'
dae '' '<up_axis>X_UP</up_axis>'
alpenglow info a.dae --json 2>/dev/null | sed -n '/"unit": {/,/^    }/p'
