# SPDX-License-Identifier: MIT
# what the benches are asked for
. "$(dirname "$0")/helpers.bash"
try bench nothing
try bench trace atlas
try bench --quick=1
try bench --scene
try bench --size 3
