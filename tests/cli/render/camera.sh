# SPDX-License-Identifier: MIT
# by number, automatic, by position; a number past the last is told
render="alpenglow render builtin:sphere-plane --resolution 32x24 --samples 1 --with albedo -q"
$render -o first.exr && $render --camera 0 -o zero.exr && cmp first.exr zero.exr && echo "0 is the default"
$render --camera auto -o auto.png && echo automatic
$render --camera 0,9,0,0,0,0,40 -o above.png && echo "from above"
$render --camera 99 -o none.png
