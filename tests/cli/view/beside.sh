# SPDX-License-Identifier: MIT
# two modes in one picture: at divider 1 it is that of --with, but for a column that does not count
. "$(dirname "$0")/gl.bash"
view="alpenglow view builtin:cornell --resolution 48x27 -q"
$view --with albedo -o albedo.exr
$view --with none -o none.exr
joined="$view --with none --beside albedo -f -o joined.exr --reference-threshold 1e-6"
for share in 0 1; do
    for reference in albedo none; do
        $joined --divider $share --reference $reference.exr >/dev/null 2>&1
        echo "$share $reference: exit $?"
    done
done
$view --with none --beside albedo -o joined.png && grep -a -o -- "--with none --beside albedo" joined.png
