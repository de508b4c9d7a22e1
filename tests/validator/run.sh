#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh empty FOLDER      before tests write files there
# run.sh validate FOLDER   validates what they wrote, and removes it. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$2
if [ "$1" = empty ]; then
    rm -rf "$folder"
    mkdir -p "$folder"
    exit
fi
trap 'rm -rf "$folder"' EXIT
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
