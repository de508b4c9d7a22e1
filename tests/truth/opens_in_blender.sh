#!/bin/sh
# SPDX-License-Identifier: MIT
# opens_in_blender.sh COMMAND SHARED: what is written as emission opens elsewhere: a .dae and a .glb
# in Blender, whose emission must be our image, read with our coordinates, and the light of its
# place; the .dae in pycollada too, where that is. 77 = skipped: no Blender, or no shared folder.
set -eu
command=$1
shared=${ALPENGLOW_SHARED:-$2}
here=$(dirname "$0")
if [ ! -x /usr/bin/blender ]; then
    echo "blender is absent: skipped (apt-get install blender python3-numpy)"
    exit 77
fi
# Blender takes the Python it finds first: the system's is the one that has numpy.
if ! /usr/bin/python3 -c "import numpy" 2>/dev/null; then
    echo "numpy is absent: skipped (apt-get install python3-numpy)"
    exit 77
fi
if [ ! -r "$shared/scenes/collada/duck.dae" ]; then
    echo "$shared/scenes is absent: skipped (set ALPENGLOW_SHARED)"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# opens FILE
opens() {
    PATH=/usr/bin:/bin blender -b --factory-startup --python-exit-code 3 \
        --python "$here/opens_in_blender.py" -- "$1" >"$folder/log" 2>&1 || {
        tail -20 "$folder/log"
        exit 1
    }
    grep -E "^(light|\{)" "$folder/log"
}

# bake SCENE -o OUT OPTION...: ten per cent of error is enough, for places differ by more.
bake() {
    "$command" bake "$@" --maps light --lightmap-as emissive --size 128 --error 10 \
        --progress off -q
}

bake "$shared/scenes/collada/duck.dae" -o "$folder/duck.dae" --sky 1,1,1
opens "$folder/duck.dae"
bake "$shared/scenes/features/CornellBox.glb" -o "$folder/box.glb"
opens "$folder/box.glb"
if /usr/bin/python3 -c "import collada" 2>/dev/null; then
    /usr/bin/python3 "$here/opens_in_pycollada.py" "$folder/duck.dae"
else
    echo "pycollada is absent: the .dae is opened in Blender only (apt-get install python3-collada)"
fi
