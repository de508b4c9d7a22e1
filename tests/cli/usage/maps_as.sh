# SPDX-License-Identifier: MIT
# --maps-as: what is no format, where there are no such files, and what .hdr cannot hold
. "$(dirname "$0")/helpers.bash"
for format in wrong EXR half png '' exr,hdr; do
    try bake scene.glb --maps-dir maps --maps-as "$format"
done
try bake scene.glb -o out.glb --maps-as hdr
try bake scene.glb -o out.glb --maps-as exr
try bake scene.glb --maps-dir maps --maps ao,bent --maps-as hdr
try bake scene.glb --maps-dir maps --maps light,sh --maps-as hdr
try bake scene.glb --maps-dir maps --maps light,direction --maps-as hdr
try bake scene.glb -o out.glb --atlas vertex --maps-as exr16
try render scene.glb -o out.png --maps-as hdr
for format in exr exr16 hdr ktx2; do
    accepted bake --maps-as "$format --maps-dir maps --maps ao,light"
done
