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
