#!/bin/sh
# SPDX-License-Identifier: MIT
# probes.sh PROGRAM: lets it write probes for three.js, opens them in two releases of it and compares
# pixels. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/needs.sh"
need three three-185 playwright-core
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$folder"
node "$here/probes.mjs" "$folder"
