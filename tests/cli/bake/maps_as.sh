# SPDX-License-Identifier: MIT
# maps as files of each format: their names on the disk and in the summary, and how far they are
# from the floats
for format in exr exr16 hdr ktx2; do
    alpenglow bake builtin:cornell --size 32 --samples 32 --ao-samples 16 --maps ao,light \
        --direct apart --layers --lamp 0.2,0.3,0.3,0.1 --maps-dir $format --maps-as $format 2>&1 |
        grep -E '^(maps|layers) '
    ls $format
done
# 11 bits of each number, and 8 of the largest of three
near() { # A, B, how near
    if alpenglow compare "$1" "$2" --max-rmse "$3" >said 2>&1; then echo "$1 near"; else cat said; fi
}
near exr16/irradiance.exr exr/irradiance.exr 0.001
near hdr/irradiance.hdr exr/irradiance.exr 0.01
cmp -s exr16/irradiance.exr exr/irradiance.exr || echo "not the same"
# too bright for halves: said, and read as it is
for format in exr exr16; do
    alpenglow bake builtin:cornell --size 16 --samples 32 --maps light --sky 1e6,1e6,1e6 \
        --maps-dir "bright $format" --maps-as $format 2>&1 | grep "half floats"
done
near "bright exr16/irradiance.exr" "bright exr/irradiance.exr" 600
