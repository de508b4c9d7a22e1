# SPDX-License-Identifier: MIT
# A fault has a message and an exit status, and leaves no file.
. "$(dirname "$0")/../usage/helpers.bash"
. "$(dirname "$0")/sky.bash"
sky sky.hdr
header='#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n'
printf "$header\n-Y 2 +X 2\n%b" "$(printf '\\200\\200\\200\\201%.0s' 1 2 3 4)" >square.hdr
printf "$header\n-Y 2 +X 4\n" >cut.hdr
alpenglow sh sky.hdr -o picture.png >/dev/null
try sh
try sh sky.hdr sky.hdr
try sh missing.hdr
try sh cut.hdr
try sh square.hdr
try sh picture.png
try sh sky.hdr --convention
try sh sky.hdr --convention bevy
try sh sky.hdr -o map.jpg
try sh sky.hdr -o nowhere/map.hdr
try sh square.hdr -o map.hdr
try sh sky.hdr --seed 3
(
    ulimit -f 0 # a full disk
    alpenglow sh sky.hdr -o map.hdr 2>&1
    echo $?
) | cat
# infinite values count as the brightest, with a warning
printf "$header\n-Y 2 +X 4\n\200\200\200\201%b" "$(printf '\\377%.0s' {1..28})" >infinite.hdr
alpenglow sh infinite.hdr 2>&1 | head -2
ls
