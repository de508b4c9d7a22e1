# SPDX-License-Identifier: MIT
# Each fault has one line and an exit status, and leaves no file.
. "$(dirname "$0")/../usage/helpers.bash"
alpenglow bake builtin:cornell --size 16 -q -o baked.glb
echo here >there.html
cp baked.glb glb.html
mkdir folder.html
try web
try web baked.glb
try web baked.glb -o page.htm5
try web baked.glb baked.glb
try web glb.html -o glb.html
try web baked.glb one.html two.html
try web baked.obj -o page.html
try web builtin:cornell -o page.html
try web baked.glb -o there.html
try web baked.glb -o folder.html
try web baked.glb -o nowhere/page.html
try web baked.glb -o page.html --size 3
cat there.html
# without the page, web says what is missing
cp "$(command -v alpenglow)" .
try() {
    local code=0
    ./alpenglow "$@" 2>&1 || code=$?
    echo "$code"
}
try web baked.glb -o page.html
ls
