# SPDX-License-Identifier: MIT
# a .dae with references to nothing, Latin-1 and a bad primitive is baked without them; one with nothing
# left is not; text that is no XML has its cause told
. "$(dirname "$0")/../scenes.bash"
triangle_dae '<unit meter="1"/>' 1 >good.dae
try() {
    alpenglow bake "$1" -o "${1%.dae}.out.dae" --size 16 --ao-samples 4 -q 2>&1 | grep -v '^note: '
    echo "${PIPESTATUS[0]}"
}
sed 's|<instance_geometry|<instance_camera url="#Cam"/><instance_light url="#Lamp"/>&|' good.dae >missing.dae
try missing.dae
sed 's|<node|<node name="T\xfcr"|' good.dae >latin1.dae
try latin1.dae
sed 's|<p>[^<]*|<p>0 1 -1|' good.dae >negative.dae
try negative.dae
sed 's|<node|<node name="A \& B"|' good.dae >bare.dae
try bare.dae
alpenglow bake good.dae -o good.obj --size 16 --ao-samples 4 -q 2>&1 | grep -v '^note: '
ls
