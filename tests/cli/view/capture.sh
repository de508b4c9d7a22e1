# SPDX-License-Identifier: MIT
# spherical harmonics at a point: a sky alone is that of sh, and conventions are those of sh
. "$(dirname "$0")/gl.bash"
capture="alpenglow view builtin:cornell --capture 0.28,300,0 --sky 1,2,3"
echo "== three"
$capture --with none | head -1 | cut -c1-4
echo "== ambient-cube"
$capture --with none --convention ambient-cube | wc -l
