#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh empty FOLDER      before tests write files there
# run.sh validate FOLDER   validates what they wrote, and empties the folder. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$2
empty() {
    rm -rf "$folder"
    mkdir -p "$folder"
}
case $1 in
empty)
    empty
    exit
    ;;
validate) trap empty EXIT ;;
*) exit 2 ;;
esac
if ! command -v node >/dev/null; then
    echo "node is absent: skipped"
    exit 77
fi
if [ ! -d "$here/node_modules/gltf-validator" ]; then
    echo "the npm package gltf-validator is absent: skipped (npm ci in tests/validator)"
    exit 77
fi
if [ ! -s "$folder/list" ]; then
    echo "nothing was written (is ALPENGLOW_SHARED there?): skipped"
    exit 77
fi
node "$here/run.mjs" "$folder/list"
