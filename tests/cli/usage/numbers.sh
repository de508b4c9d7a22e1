# SPDX-License-Identifier: MIT
# what is not a number, and one past each end of every range
. "$(dirname "$0")/helpers.bash"
wrong() { # command, option, values
    local command=$1 option=$2 value
    shift 2
    for value; do
        try "$command" scene.glb $(outputs "$command") "$option" "$value"
    done
}
wrong bake --size 0 16385 -1 1.5 1e3 abc 12x ' 12' 0x10 99999999999999999999 +5 auto
wrong bake --padding -1 65 x
wrong bake --block 0 65 x
wrong bake --mips -1 9 x
try bake scene.glb -o out.glb --size 100 --mips 3
wrong bake --texels-per-metre 0 9e-7 1000001 -2 nan inf 1e999 0x1p3 3m
wrong bake --ao-samples 0 1048577 -1 1.5 many
wrong bake --ao-distance 0 9e-7 1000000001 -1 nan infinity
wrong bake --ao-cone 0 0.0009 90.001 -90 pi nan
wrong bake --seed -1 9007199254740993 1.0 99999999999999999999
wrong bake --threads 0 1025 all
wrong render --ao-samples 0 1048577
wrong render --ao-distance 0
wrong render --ao-cone 91
wrong render --samples 0 4097 x
wrong render --seed -1
wrong render --threads 0 1025
wrong render --resolution 0x1 1x0 16385x1 1x16385 12 x 12x 3x4x5 1.5x2 -1x2 100X100
wrong render --camera -1 x 1,2,3 1,2,3,4,5,6,0 1,2,3,4,5,6,179.1 1,2,3,1,2,3,40 \
    1,2,3,4,5,6,7,8 nan,2,3,4,5,6,40 1,2,3,4,5,6, 4294967295
wrong render --exposure -64.1 64.1 nan inf 1e999 bright 1EV
wrong render --white-balance 999.9 25000.1 -6500 6500K nan on
wrong compare --scale -1000000001 1000000001 nan x
wrong compare --max-rmse -0.001 1000000001 nan x
wrong compare --points 0 16777217 1.5 x
for value in 0 0.009 101 1e400 nan pct; do
    try bake scene.glb -o out.glb --error $value
done
for value in 0 1K 1023K 1.5M 10x 10MB -1 99999999999999999999G; do
    try bake scene.glb -o out.glb --memory-limit $value
done
for value in 0 1 -1 on; do
    try bake scene.glb -o out.glb --adaptive $value
done
try bake scene.glb -o out.glb --time-limit 0
try bake scene.glb -o out.glb --quality best
try bake scene.glb -o out.glb --quality high --error 1
