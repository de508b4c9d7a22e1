# SPDX-License-Identifier: MIT
# unknown commands and options; the nearest known name is offered
. "$(dirname "$0")/helpers.bash"
try baek
try brender
try comprae a b
try frobnicate
try --versoin
try --size 4 bake
try bake --ao-sample 3
try bake --ao_samples 3
try bake --texels-per-meter 3
try bake --maps_dir x
try bake --thread 2
try bake -ao-samples 4
try bake --zzzzz
try bake -z
try bake --bounce 3
try bake --
try render --wtih ao
try compare --maxrmse 1
try info --jsno
# an option of another command
try bake --resolution 3x3
try render --padding 4
try info --ao-samples 4
try compare --threads 2
