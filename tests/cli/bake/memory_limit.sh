# SPDX-License-Identifier: MIT
# A bake that needs more memory than it may hold fails with the stage's name and writes nothing.
bake() {
    alpenglow bake builtin:cornell --maps ao,light --maps-dir maps -q "$@"
    echo "exit $?, $(ls)"
}
bake --memory-limit 1M
bake --memory-limit 24M --size 512
bake --memory-limit 100M --size 32 --samples 32
