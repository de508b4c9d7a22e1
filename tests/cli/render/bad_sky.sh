# SPDX-License-Identifier: MIT
# Skies that are none, and values in them and of suns that are none: a message, or a sane picture.
header='#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n'
printf "$header\n-Y 2 +X 4\n" >cut.hdr
{ cat cut.hdr; printf '\200\200\200\201'; } >truncated.hdr
printf "$header\n-Y 1 +X 8\n\002\002\000\010\377\377\377\377" >overrun.hdr
printf "$header\n-Y 2 +X 2\n%b" "$(printf '\\200\\200\\200\\201%.0s' 1 2 3 4)" >square.hdr
# all but one beyond what a sky may hold
printf "$header\n-Y 2 +X 4\n\200\200\200\201%b" "$(printf '\\377%.0s' {1..28})" >infinite.hdr
printf "${header}EXPOSURE=nan\n\n-Y 2 +X 4\n%b" "$(printf '\\200%.0s' {1..32})" >exposure.hdr
: >empty.hdr
alpenglow render builtin:sphere-plane --with albedo -o sky.png --resolution 4x2 -q
cp sky.png png.hdr
render="alpenglow render builtin:sphere-plane --with reference --resolution 16x9 --samples 4 -q -f"
for sky in missing empty truncated overrun square infinite exposure png; do
    echo "== $sky.hdr"
    $render -o a.exr --sky $sky.hdr 2>&1
    echo $?
done
echo "== sky.png"
$render -o a.exr --sky sky.png 2>&1
echo $?
echo "== a sun without size is one of the smallest"
$render -o zero.exr --sun 0,45,1000 --sun-size 0 &&
    $render -o tiny.exr --sun 0,45,1000 --sun-size 0.001 &&
    alpenglow compare zero.exr tiny.exr --max-rmse 0 >/dev/null && echo same
