# SPDX-License-Identifier: MIT
# film: nothing unless asked for; an exposure that was chosen gives the same picture again
render="alpenglow render builtin:cornell --resolution 32x24 --samples 2 --with albedo"
$render -q -o plain.png && $render -q --exposure 0 --tone none --white-balance off -o zero.png &&
    cmp plain.png zero.png && echo "the default shows what is there"
ev=$($render --exposure auto --tone film -o auto.png | sed -n 's/^exposure *\(.*\) EV$/\1/p')
$render -q --exposure "$ev" --tone film -o given.png && cmp auto.png given.png && echo "the same again"
for other in "--exposure -1" "--tone film" "--tone reinhard" "--tone filmic" "--white-balance 3000" \
    "--white-balance auto"; do
    $render -q -f $other -o other.png && cmp -s plain.png other.png || echo "$other differs"
done
$render -q --exposure 2 -o two.exr
