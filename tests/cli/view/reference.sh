# SPDX-License-Identifier: MIT
# a picture that differs from its reference, one of another size, and none at all
. "$(dirname "$0")/gl.bash"
view="alpenglow view builtin:cornell --resolution 48x27 -q -f -o drawn.png"
$view --with albedo
cp drawn.png albedo.png
$view --with none --reference albedo.png --reference-threshold 0.01 >figures
echo "exit $?"
alpenglow view builtin:cornell --with none --resolution 24x27 -q -o other.png
$view --with none --reference other.png
echo "exit $?"
$view --with none --reference missing.png
echo "exit $?"
