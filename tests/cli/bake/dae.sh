# SPDX-License-Identifier: MIT
# what a .dae has no place for is refused before the work, and before it is guessed at
cat >a.dae <<'TEXT'
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/></asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
TEXT
refused() {
    alpenglow bake "$@" 2>&1 | grep -v '^note: '
    echo "${PIPESTATUS[0]}"
}
refused builtin:cornell -o b.dae
refused a.dae -o b.dae --maps light --sky 1,1,1 --lightmap-as moz
refused a.dae -o b.dae --maps light --sky 1,1,1 --lightmap-as extras
refused a.dae -o b.dae --ao-into orm
refused a.dae -o b.dae --atlas vertex
alpenglow bake a.dae -o b.dae --size 16 --ao-samples 4 -q
touch c.dae
refused a.dae -o c.dae
ls
