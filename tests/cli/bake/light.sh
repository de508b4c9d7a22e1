# SPDX-License-Identifier: MIT
# light with and without bounces: what is said of the samples; direct light in the same bits for any
# number of threads
bake() {
    alpenglow bake builtin:cornell --size 32 --maps light --samples 20 --threads 2 "$@" ||
        echo "failed: $*"
}
said() {
    grep '^light' | sed 's/;.*//'
}
# without any light: refused, and no map is written
alpenglow bake builtin:sphere-plane --size 16 --maps ao,light --maps-dir dark -q; echo "$?"; ls dark 2>/dev/null
bake --bounces 0 --maps-dir direct --json direct.json | said
bake --bounces 1 --maps-dir paths --json paths.json | said
bake --bounces 0 --maps-dir again --threads 1 -q
ls direct
bake --bounces 1 --maps light,sh,direction --maps-dir directions | grep '^maps'
ls directions
cmp paths/irradiance.exr directions/irradiance.exr
cmp direct/irradiance.exr again/irradiance.exr
grep -ho '"[a-z_]*per[a-z_]*": [0-9]*' direct.json paths.json
# the stated error and that of 99 % of the texels, in words and in JSON
bake --bounces 1 --maps-dir again --json errors.json -f | grep -o '; stated error.*' | sed 's/[0-9.e-]* %/N %/; s/within [0-9.e-]*/within N/'
json_shape errors.json | grep '^\.error'
