# SPDX-License-Identifier: MIT
# Small scenes that cases write.

# room MATERIAL NODES LIGHTS: a box of 4 m seen from inside, closed, about the origin. NODES are
# added, such as what `lamp 0 1 2 3` prints: light 0 at (1, 2, 3); LIGHTS are those of
# KHR_lights_punctual.
room() {
    local bytes=
    bytes+=AAAAwAAAAMAAAADAAAAAwAAAAMAAAABAAAAAwAAAAEAAAADAAAAAwAAAAEAAAABAAAAAQAAAAMAAAADA
    bytes+=AAAAQAAAAMAAAABAAAAAQAAAAEAAAADAAAAAQAAAAEAAAABAAAIDAAMBBQcGBQYEAQUEAQQAAgYHAgcD
    bytes+=AAQGAAYCAwcFAwUB
    cat <<END
{"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[$3]}},"materials":[$1],
"nodes":[{"mesh":0,"name":"walls"}${2:+,$2}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
"buffers":[{"byteLength":132,"uri":"data:application/octet-stream;base64,$bytes"}],
"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":8,
"min":[-2,-2,-2],"max":[2,2,2]},{"bufferView":1,"componentType":5121,"type":"SCALAR","count":36}]}
END
}

lamp() { # light, x, y, z
    echo '{"extensions":{"KHR_lights_punctual":{"light":'"$1"'}},"translation":['"$2,$3,$4"']}'
}

triangle_dae() { # what is in <asset>, side of the triangle
    cat <<END
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>$1</asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 $2 0 0 0 $2 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
END
}
