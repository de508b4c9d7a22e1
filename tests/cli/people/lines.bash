# SPDX-License-Identifier: MIT
# The lines that people type first, on one scene that is not in the repository.
shared=${ALPENGLOW_SHARED:-/nowhere}

# copy FILE: a file of the shared scenes, in the working folder. The case is skipped without it.
copy() {
    [ -r "$shared/scenes/$1" ] || { echo "no $shared/scenes/$1: set ALPENGLOW_SHARED" >&2; exit 77; }
    cp "$shared/scenes/$1" . && chmod u+w "${1##*/}"
}

# line WORDS...: the command, what it answers without figures and without remarks about the scene
# itself, and its exit status
line() {
    local code=0
    echo "\$ alpenglow $*"
    alpenglow "$@" >answer 2>&1 || code=$?
    sed -E '/^(atlas|stretch|sampling|seams|energy|time|vertices|about|exposure|warning:) /d
        /^note: ('"$scene"'|out\..*: .* smaller)/d; s/^(occlusion|light) .*/\1/
        s/, load [0-9.]+ s, render [0-9.]+ s//' answer | head -n "${rows:-20}"
    echo "= $code"
}

# lines SCENE STEM ENDING: every line on one scene, whose bakes have this ending
lines() {
    local quick="--size 16 --ao-samples 4 --progress off" lit="--size 16 --samples 32 --progress off"
    local scene=$1 stem=$2 ending=$3 option
    line "$scene"
    line bake "$scene" $quick
    line bake "$scene" $quick
    line bake "$stem.baked$ending" $quick
    line bake "$scene" "out$ending" $quick
    line bake "$scene" -o "lit$ending" --maps light --sky 1 $lit
    for option in '--sky 1' '--sun 150,40,60000' '--lamp 0,1,0,100' '--bounces 0 --sky 1' \
        '--denoise on --sky 1' '--layers --maps-dir layers --sky 1' '--sky 1 --ao-samples 4'; do
        line bake "$scene" -q -f -o "option$ending" $option $lit
        maps "option$ending"
    done
    line bake "$scene" --maps ao,light "both$ending" --maps-dir apart --sky 1 --ao-samples 4 $lit -f
    line bake "$scene" -q --maps lightmap --size 1k --sky 1 -o missing/out.glb
    line bake "$scene" --maps Lights
    line bake "$scene" --size 1024px
    line bake "$scene" --sky white
    rows=1 line info "$scene" --json -
    rows=3 line info "$scene"
    line render "lit$ending" --with lightmap lit.png --resolution 16x16
    line render "lit$ending" --with lightmap new.png --resolution 16x16 --quality preview
    line render "out$ending" --with lightmap out.png --resolution 16x16 --size 16 --texel-samples 32
    line render "$scene" --with lightmap bad.png --sky 1 --quality preview --gather hemicube
}

# maps OUT: the kinds of maps that the bake put into OUT, or beside it
maps() {
    local word
    for word in occlusionTexture emissiveTexture map_Ka map_Ke 'ao.png' 'light.png'; do
        cat "$1" "${1%.*}.mtl" 2>/dev/null | grep -aq -- "$word" && printf '%s ' "$word"
    done
    echo
}
