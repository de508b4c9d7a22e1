# SPDX-License-Identifier: MIT
# layers of light: their files, their names in the summary and the report, and what is refused
bake() {
    alpenglow bake builtin:cornell --size 32 --samples 32 --layers --threads 2 "$@"
}
bake --maps light --lamp 0.2,0.5,0.3,2 --sky 0.5,0.5,0.5 --maps-dir maps --json report.json |
    grep '^layers'
ls maps
grep -A 4 '"layers"' report.json | tr -d ' '
bake --maps light --bounces 0 --maps-dir direct -q && ls direct
alpenglow bake builtin:cornell --maps ao --layers --maps-dir none 2>&1
bake --maps light --lightmap-as extras -o out.glb 2>&1
bake --maps light --gather paths --maps-dir none 2>&1
alpenglow bake builtin:cornell --maps light --layers --denoise on --maps-dir none 2>&1
ls
