#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a command that uses Debian's Blender, which takes the first python3 of PATH as its own.
#
#   with_blender.sh COMMAND...
#
# Exit status: that of the command, 77 skipped.
set -euo pipefail
skip() {
    echo "skipped: $1 ('scripts/setup.sh blender' installs it)" >&2
    exit 77
}
[ -x /usr/bin/blender ] || skip "there is no /usr/bin/blender"
/usr/bin/python3 -c "import numpy" 2>/dev/null || skip "there is no numpy"
PATH=$(dirname "$(command -v alpenglow)"):/usr/bin:/bin
exec "$@"
