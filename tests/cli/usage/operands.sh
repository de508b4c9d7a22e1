# SPDX-License-Identifier: MIT
# too few and too many
. "$(dirname "$0")/helpers.bash"
try bake
try bake a.glb b.glb
try bake a.glb
try render a.glb
try render a.glb -o a.png
try render
try info
try info a b
try info ''
try bake '' -o a.glb
try compare a ''
try compare
try compare a
try compare a b c
# after -- all are operands
alpenglow info -- --json 2>&1 | grep -c -e "--json: "
