# SPDX-License-Identifier: MIT
# ambient occlusion of the screen dims a model of ambient light, and less by a small radius
. "$(dirname "$0")/gl.bash"
view="alpenglow view builtin:cornell --with constant --resolution 96x54 -q -f -o drawn.exr"
$view -o open.exr
for options in "--ssao off" "--ssao on" "--ssao on --ssao-radius 1e-6"; do
    $view $options --reference open.exr --reference-threshold 1e-6 >/dev/null 2>&1
    echo "$options: exit $?"
done
