#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The Python module, installed and used as README.md of integrations/python says.
#
#   run.sh PREFIX WORK    PREFIX holds an installed alpenglow, WORK is a folder to write in
#
# PYTHON names another Python than /usr/bin/python3.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
module=$here/../../../integrations/python
python=${PYTHON:-/usr/bin/python3}
unset MAKEFLAGS MFLAGS # of a make that may stand above

fail() {
    printf 'python: %s\n' "$*" >&2
    exit 1
}

skip() {
    echo "$*: skipped ('scripts/setup.sh browser' installs it)"
    exit 77
}

for need in cffi numpy ensurepip setuptools wheel; do
    "$python" -c "import $need" 2>/dev/null || skip "$python has no $need"
done
"$python" -c "import os, sysconfig as s, sys
sys.exit(not os.path.exists(s.get_path('include') + '/Python.h'))" || skip "$python has no Python.h"
[ -n "$(find "$1" -name 'libalpenglow.so')" ] || {
    echo "the library is static: skipped"
    exit 77
}

rm -rf "$2"
mkdir -p "$2"
work=$(cd "$2" && pwd)
cp -a "$1" "$work/prefix" # a copy, from which the library is taken away below
cp -r "$module" "$work/source"
libraries=$(dirname "$(find "$work/prefix" -name 'libalpenglow.so')")
"$python" -m venv --system-site-packages "$work/venv"
install=("$work/venv/bin/pip" install -q --no-index --no-build-isolation "$work/source")

# Without the library, one line says so.
! PKG_CONFIG_LIBDIR=/nonexistent PKG_CONFIG_PATH='' "${install[@]}" >"$work/missing.txt" 2>&1 ||
    fail "the module is installed without the library"
grep -q "pkg-config does not find the library alpenglow 0.1 or newer; run 'make install'" \
    "$work/missing.txt" || fail "no library: $(cat "$work/missing.txt")"

PKG_CONFIG_PATH=$libraries/pkgconfig "${install[@]}"
cd "$work"
ALPENGLOW_COMMAND=$work/prefix/bin/alpenglow "$work/venv/bin/python" "$here/test_module.py"

"$work/venv/bin/python" "$module/examples/bake_mesh.py" light.png >bake.txt 2>/dev/null
grep -qE '^[0-9]+ texels, mean [0-9.]+ W/m2, error (0\.[0-9]|1\.0) %' bake.txt || fail "$(cat bake.txt)"
[ "$(head -c 4 light.png | tail -c 3)" = PNG ] || fail "bake_mesh.py wrote no picture"
"$work/venv/bin/python" "$module/examples/read_probes.py" >probes.txt
[ "$(grep -cE '^at .*: [0-9.]+ [0-9.]+ [0-9.]+ W/m2$' probes.txt)" = 5 ] || fail "$(cat probes.txt)"
# shellcheck disable=SC2016 # the backquotes are Markdown
sed -n '/^```python$/,/^```$/p' "$module/README.md" | sed '/^```/d' >readme.py
"$work/venv/bin/python" readme.py >readme.txt
grep -qxF '(128, 128) (128, 128, 3)' readme.txt || fail "README.md: $(cat readme.txt)"
[ -s square.glb ] || fail "README.md: no square.glb"

# Without the library, so does the import.
mv "$libraries" "$libraries.gone"
! "$work/venv/bin/python" -c 'import alpenglow' 2>import.txt || fail "there is another alpenglow"
tail -n 1 import.txt | grep -q '^ImportError: alpenglow: .*libalpenglow.*; install the library' ||
    fail "import: $(cat import.txt)"
