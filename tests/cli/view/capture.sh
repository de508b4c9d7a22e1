# SPDX-License-Identifier: MIT
# spherical harmonics at a point: a sky alone is that of sh, and conventions are those of sh
. "$(dirname "$0")/gl.bash"
# A smooth sky of 64 x 32 texels, another in each channel.
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n' >sky.hdr
printf "$(awk 'BEGIN {
    for (y = 0; y < 32; y++)
        for (x = 0; x < 64; x++) {
            around = x / 64 * 6.2832
            share = sin((y + .5) / 32 * 3.14159)
            printf "\\%o\\%o\\%o\\201", 128 + 100 * cos(around) * share, 40 + 5 * y,
                160 - 60 * sin(around) * share
        }
}')" >>sky.hdr
# differences FILE FILE: the values, and those that differ by more than .001 of the first
differences() {
    paste -d ' ' "$1" "$2" | awk '{
        for (k = 1; k <= NF / 2; k++) {
            scale = NR == 1 && k == 1 ? $1 : scale
            difference = $k - $(k + NF / 2)
            values++
            wrong += difference > .001 * scale || -difference > .001 * scale
        }
    }
    END { print values " values, " wrong + 0 " differ" }'
}
for convention in three filament gltf godot unity ambient-cube; do
    alpenglow sh sky.hdr --convention $convention >expected
    alpenglow view builtin:cornell --capture 0.28,30000,0 --with none --sky sky.hdr \
        --convention $convention >drawn # the box is smaller than a texel there
    echo "$convention: $(differences drawn expected)"
done
