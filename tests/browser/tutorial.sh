#!/bin/sh
# SPDX-License-Identifier: MIT
# tutorial.sh ALPENGLOW: the page of docs/tutorials/web.md, with the scene of its command. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/needs.sh"
need playwright-core three
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" bake builtin:teapot-room "$folder/room.json" --size 256 -q
# shellcheck disable=SC2016 # the backquotes are Markdown
sed -n '/^```html$/,/^```$/p' "$here/../../docs/tutorials/web.md" | sed '/^```/d' >"$folder/viewer.html"
ln -s "$here/node_modules" "$folder/node_modules"
node "$here/tutorial.mjs" "$folder"
