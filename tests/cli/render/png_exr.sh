# SPDX-License-Identifier: MIT
# all kinds of picture, all methods
plain="alpenglow render builtin:sphere-plane --resolution 32x24 --samples 2 -q"
render="$plain --ao-samples 8"
$render --with ao -o ao.png && head -c 4 ao.png | tail -c 3; echo
$render --with ao -o ao.exr && $plain --with albedo -o albedo.exr && ls
alpenglow compare ao.exr albedo.exr --max-rmse 0 >/dev/null 2>&1 || echo "the methods differ"
# values up to 1 in steps of 1/256: at most half of one off
$render --with ao -o ao.hdr && head -n 1 ao.hdr &&
    alpenglow compare ao.hdr ao.exr --max-rmse 0.002 >/dev/null && echo "eight bits agree"
$render --with ao --threads 1 -o one.exr && $render --with ao --threads 7 -o seven.exr &&
    cmp one.exr seven.exr && echo "same bits"
alpenglow render builtin:sphere-plane --resolution 32x24 --samples 1 --with albedo -o summary.png
alpenglow render builtin:furnace --resolution 16x12 --samples 16 --bounces 0 -q --with reference \
    --exposure 0 --tone none -o reference.png && head -c 4 reference.png | tail -c 3; echo
alpenglow render builtin:sphere-plane --resolution 16x12 --with reference -o dark.png 2>&1 |
    grep -c "nothing lights the scene"; ls dark.png 2>/dev/null || true
