# SPDX-License-Identifier: MIT
# what a .dae has no place for is refused before the work, and before it is guessed at
. "$(dirname "$0")/../scenes.bash"
triangle_dae '<unit meter="1"/>' 1 >a.dae
refused() {
    alpenglow bake "$@" 2>&1 | grep -v '^note: '
    echo "${PIPESTATUS[0]}"
}
refused builtin:cornell -o b.dae
refused a.dae -o b.dae --maps light --sky 1,1,1 --lightmap-as moz
refused a.dae -o b.dae --maps light --sky 1,1,1 --lightmap-as extras
refused a.dae -o b.dae --ao-into orm
refused a.dae -o b.dae --atlas vertex
alpenglow bake a.dae -o b.dae --size 16 --ao-samples 4 -q
touch c.dae
refused a.dae -o c.dae
ls
