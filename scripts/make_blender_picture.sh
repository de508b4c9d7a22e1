#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# make_blender_picture.sh COMMAND OUT.png: the built-in atrium in a window of Blender, after a bake
# by the add-on. Needs Blender and a virtual screen (scripts/setup.sh blender).
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -eq 2 ] || { echo "usage: make_blender_picture.sh COMMAND OUT.png" >&2; exit 2; }
command=$(realpath "$1")
out=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/scripts" "$folder/scripts/addons"
ln -s "$command" "$folder/bin/alpenglow"
cp -r "$here/../integrations/blender/alpenglow_blender" "$folder/scripts/addons/"
"$command" bake builtin:atrium -o "$folder/scene.glb" --size 64 --ao-samples 4 -q
export BLENDER_USER_SCRIPTS=$folder/scripts BLENDER_USER_CONFIG=$folder/config
export LIBGL_ALWAYS_SOFTWARE=1
PATH=$folder/bin:/usr/bin:/bin xvfb-run -a -s "-screen 0 1060x640x24" /usr/bin/blender \
    --factory-startup --enable-event-simulate --window-geometry 0 0 1060 640 \
    --python "$here/make_blender_picture.py" -- "$folder/scene.glb" "$out"
