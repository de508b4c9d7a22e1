# SPDX-License-Identifier: MIT
# both ends of every range, and the words that stand for numbers: only the missing file is wrong
. "$(dirname "$0")/helpers.bash"
right() { # command, option, values
    local command=$1 option=$2 value
    shift 2
    for value; do
        accepted "$command" "$option" "$value"
    done
}
right bake --size 1 16384
right bake --padding 0 64
right bake --block 1 64
right bake --mips 0 8
right bake --texels-per-metre 1e-6 1000000 auto
right bake --ao-samples 1 1048576
right bake --ao-distance 0.000001 1e9 auto inf .5
right bake --ao-falloff "none --ao-distance inf"
right bake --ao-cone 0.001 90
right bake --seed 0 9007199254740992
right bake --threads 1 1024 auto
right bake --maps ao ao,ao "ao,bent --maps-dir maps"
right bake --existing-ao replace multiply keep
right render --samples 1 4096
right render --resolution 1x1 16384x16384
right render --camera 0 4294967294 auto 1,2,3,4,5,6,0.001 1,2,3,4,5,6,179 0,9,0,0,0,0,40 \
    -1,-2,-3e0,4,5,6,90
right render --exposure -64 64 0 -1.5 auto
right render --tone film reinhard filmic none
right render --white-balance 1000 25000 6504.5 auto off
right compare --scale -1e9 1e9 -1
right compare --max-rmse 0 1e9
right compare --points 1 16777216
