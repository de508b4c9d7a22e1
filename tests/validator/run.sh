#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh PROGRAM...: lets the test programs write glTF files and validates them. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
if ! command -v node >/dev/null; then
    echo "node is absent: skipped"
    exit 77
fi
if [ ! -d "$here/node_modules/gltf-validator" ]; then
    echo "the npm package gltf-validator is absent: skipped (npm ci in tests/validator)"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
: >"$folder/list"
for program in "$@"; do
    ALPENGLOW_WRITTEN="$folder" "$program" >"$folder/log" 2>&1 || {
        cat "$folder/log"
        exit 1
    }
done
if [ ! -s "$folder/list" ]; then
    echo "nothing was written (is ALPENGLOW_SHARED there?): skipped"
    exit 77
fi
node "$here/run.mjs" "$folder/list"
