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

# A floor under a lamp, and a wall that two animations of 2 s move: "slide" from x = -1 to 1 and up
# to 1.7 m, "turn" by a quarter about y.
slide() {
    local bytes=
    bytes+=AAAAwAAAAAAAAADAAAAAwAAAAAAAAABAAAAAQAAAAAAAAABAAAAAQAAAAAAAAADAAAECAAIDAAAAAAC/
    bytes+=AAAAvwAAAAAAAAA/AAAAvwAAAAAAAAA/AAAAPwAAAAAAAAC/AAAAPwAAAAAAAAAAAAAAQAAAgL8zMzM/
    bytes+=AAAAAAAAgD+amZk/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAA9AQ1PwAAAAD0BDU/
    cat <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":20}]}},
"nodes":[{"mesh":0,"name":"floor"},{"mesh":1,"name":"mover","translation":[-1,0.7,0]},{"name":"lamp",
"translation":[0,2,0.5],
"extensions":{"KHR_lights_punctual":{"light":0}}}],
"materials":[{"pbrMetallicRoughness":{"metallicFactor":0},"doubleSided":true}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},
"indices":1,"material":0}]},{"primitives":[{"attributes":{"POSITION":2},
"indices":1,"material":0}]}],
"animations":[{"name":"slide","channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],
"samplers":[{"input":3,"output":4}]},{"name":"turn","channels":[{"sampler":0,"target":{"node":1,
"path":"rotation"}}],
"samplers":[{"input":3,"output":5}]}],
"buffers":[{"byteLength":168,"uri":"data:application/octet-stream;base64,$bytes"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":6},
{"buffer":0,"byteOffset":56,"byteLength":48},{"buffer":0,"byteOffset":104,"byteLength":8},{"buffer":0,
"byteOffset":112,"byteLength":24},{"buffer":0,"byteOffset":136,"byteLength":32}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[-2,0,-2],
"max":[2,0,2]},{"bufferView":1,"componentType":5121,"type":"SCALAR","count":6},{"bufferView":2,
"componentType":5126,"type":"VEC3","count":4,"min":[-0.5,-0.5,0],
"max":[0.5,0.5,0]},{"bufferView":3,"componentType":5126,"type":"SCALAR","count":2},{"bufferView":4,
"componentType":5126,"type":"VEC3","count":2},{"bufferView":5,"componentType":5126,"type":"VEC4","count":2}]}
END
}
