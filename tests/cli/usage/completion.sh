# SPDX-License-Identifier: MIT
# scripts for shells that are known, and pages for commands that are built
. "$(dirname "$0")/helpers.bash"
try --completion
try --completion tcsh
try --completion bash
try --man
try --man bake
try --man sh
try --man baek
