# SPDX-License-Identifier: MIT
# web --report puts a link into the report of a bake, once, and touches no other file.
. "$(dirname "$0")/../usage/helpers.bash"
alpenglow bake builtin:cornell --size 16 -q -o baked.glb --report report.html
if alpenglow web baked.glb -q -o page.html 2>&1 | grep -q 'built without'; then
    echo "the page is not built, three.js is absent" >&2
    exit 77
fi
links() { grep -o '<p id="web">.*</p>' report.html; }
cp report.html first.html
links
alpenglow web baked.glb -q -f -o page.html --report report.html
links
alpenglow web baked.glb -q -o 'a "page" & <more>.html' --report ./report.html
links
diff first.html report.html | grep -c '^[<>]'
xmllint --noout report.html 2>/dev/null && echo 'well-formed' || command -v xmllint >/dev/null || echo 'well-formed'
alpenglow bake builtin:cornell --size 16 -q -f -o baked.glb --report report.html
links
echo '== faults'
echo '<html>mine</html>' >mine.html
mkdir folder
cp report.html folder
fault() { try web baked.glb -o fault.html "$@"; }
fault --report missing.html
fault --report mine.html
fault --report page.html
fault --report fault.html
fault --report folder
fault --report folder/report.html
fault --report baked.glb
try web baked.glb -f -o report.html --report report.html
cat mine.html
cmp report.html folder/report.html
[ -e fault.html ] || echo 'no page'
