# SPDX-License-Identifier: MIT
# the lines that people type first, on duck.dae
. "$(dirname "$0")/lines.bash"
copy collada/duck.dae
lines duck.dae duck .dae
