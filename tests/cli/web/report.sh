# SPDX-License-Identifier: MIT
# web --report and bake --report put a link into the report, once, and touch no other file.
. "$(dirname "$0")/../usage/helpers.bash"
alpenglow bake builtin:cornell --size 16 -q -o baked.glb --report report.html
if alpenglow web baked.glb -q -o page.html 2>&1 | grep -q 'built without'; then
    echo "the page is not built, three.js is absent" >&2
    exit 77
fi
links() { grep -o '<p id="web">.*</p>' "${1:-report.html}"; }
cp report.html first.html
links
alpenglow web baked.glb -q -f -o page.html --report report.html
links
alpenglow web baked.glb -q -o 'a "page" & <more>.html' --report ./report.html
links
diff first.html report.html | grep -c '^[<>]'
xmllint --noout report.html 2>/dev/null && echo 'well-formed' || command -v xmllint >/dev/null || echo 'well-formed'
echo '== new bakes'
bake() { alpenglow bake builtin:cornell --size 16 -q -f -o baked.glb --report "$@"; }
bake report.html
links
rm 'a "page" & <more>.html'
bake report.html
links
cp page.html baked.html
bake report.html
links
bake baked.html # the page is replaced by the report
links baked.html
bake baked.html
links baked.html
cp first.html baked.html # another report, no page
bake report.html
links
mkdir in
cp page.html in/baked.html
bake in/report.html
links in/report.html
sed 's|<p id="web">|<p id="web"><a href="in%2Fbaked.html">See this scene in the browser</a>|' first.html >report.html
bake report.html
links
echo '== another scene'
sed 's/<dt>Input hash<\/dt><dd>./&x/' first.html >other.html
try web baked.glb -f -o page.html --report other.html
links other.html
echo '== faults'
echo '<html>mine</html>' >mine.html
echo '<html><p id="web">my text</p></html>' >alike.html
sed 's/<p id="web">/&my text/' first.html >edited.html
sed 's/<meta name="generator"[^>]*>//' first.html >nobody.html
cp alike.html alike.copy
cp edited.html edited.copy
mkdir folder
cp report.html folder
fault() { try web baked.glb -o fault.html "$@"; }
fault --report missing.html
fault --report mine.html
fault --report alike.html
fault --report edited.html
fault --report nobody.html
fault --report page.html
fault --report fault.html
fault --report folder
fault --report folder/report.html
fault --report baked.glb
try web baked.glb -f -o report.html --report report.html
cat mine.html
cmp alike.html alike.copy
cmp edited.html edited.copy
cmp report.html folder/report.html
[ -e fault.html ] || echo 'no page'
