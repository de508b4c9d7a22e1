#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run.sh COMMAND NAME SHARED: test_NAME.py inside Blender, with the add-on installed from its zip.
# 77 = skipped: no Blender, numpy or virtual screen, or no shared folder where the test needs it.
set -euo pipefail
command=$(realpath "$1")
name=$2
export ALPENGLOW_SHARED=${ALPENGLOW_SHARED:-$3}
here=$(cd "$(dirname "$0")" && pwd)

skip() {
    echo "$*: skipped ('scripts/setup.sh blender' installs it)"
    exit 77
}

[ -x /usr/bin/blender ] || skip "/usr/bin/blender is absent"
# Blender takes the Python it finds first: the system's is the one that has numpy.
/usr/bin/python3 -c "import numpy" 2>/dev/null || skip "numpy is absent"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$here/../../../integrations/blender/make_zip.py" "$folder/alpenglow-blender.zip"
mkdir "$folder/scripts" "$folder/scripts/addons" "$folder/bin" "$folder/temp"
ln -s "$command" "$folder/bin/alpenglow"
export BLENDER_USER_SCRIPTS=$folder/scripts BLENDER_USER_CONFIG=$folder/config
export ALPENGLOW_TEST_FOLDER=$folder TMPDIR=$folder/temp PYTHONDONTWRITEBYTECODE=1
blender=(/usr/bin/blender -b)
if [ "$name" = window ]; then # drawn by the processor, into the memory of a virtual screen
    command -v xvfb-run >/dev/null || skip "xvfb-run is absent"
    export LIBGL_ALWAYS_SOFTWARE=1
    blender=(xvfb-run -a -s "-screen 0 1280x800x24" /usr/bin/blender)
fi
status=0
PATH=$folder/bin:/usr/bin:/bin "${blender[@]}" --factory-startup --python-exit-code 3 \
    --python "$here/test_$name.py" >"$folder/log" 2>&1 || status=$?
grep -vE '^(Fra:|Saved: |Blender quit|Modules Installed)' "$folder/log" || true
if [ -f "$folder/child.pid" ] && kill -0 "$(cat "$folder/child.pid")" 2>/dev/null; then
    echo "FAILED: the command runs on after Blender has quit"
    status=1
fi
if [ "$name" = window ] && [ ! -f "$folder/child.pid" ]; then
    echo "FAILED: the test did not come to its end"
    status=1
fi
exit "$status"
