# SPDX-License-Identifier: MIT
# The irradiance map: E = pi (1 + cos) / 2 in each format, nothing is overwritten without -f, and
# standard output has the coefficients alone.
. "$(dirname "$0")/sky.bash"
sky sky.hdr
for name in map.hdr map.exr map.png; do
    alpenglow sh sky.hdr -o $name >lines.txt
    echo "$name $? $(wc -l <lines.txt)"
done
alpenglow compare map.hdr map.exr --max-rmse 0.01 | grep -E '^(pixels|means)'
# the map of the map: bands 1 and 2 shrink by 2/3 and 1/4
alpenglow sh map.exr | head -2
alpenglow sh sky.hdr -o map.exr
echo $?
alpenglow sh sky.hdr -f -o map.exr | wc -l
alpenglow sh sky.hdr -f -o sky.hdr
echo $?
alpenglow sh sky.hdr | head -1
