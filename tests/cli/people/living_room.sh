# SPDX-License-Identifier: MIT
# the lines that people type first, on living_room.glb
. "$(dirname "$0")/lines.bash"
copy architecture/living_room.glb
lines living_room.glb living_room .glb
