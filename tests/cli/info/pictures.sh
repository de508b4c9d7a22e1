# SPDX-License-Identifier: MIT
# --pictures: made, named, not overwritten without -f, and in the JSON.
alpenglow info builtin:sphere-plane --pictures out 2>/dev/null | grep ^picture
alpenglow bake builtin:sphere-plane --size 64 --ao-samples 4 -o baked.glb -q
alpenglow info baked.glb --pictures out/ 2>&1 | grep -c '^findings'
alpenglow info baked.glb --pictures out/ -f 2>/dev/null | grep ^picture
alpenglow info baked.glb --pictures out --json -f 2>/dev/null | sed -n '/"pictures"/,/]/p'
alpenglow info baked.glb --pictures out --json
echo $?
echo text >file
alpenglow info baked.glb --pictures file --json
echo $?
ls out
printf 'v 0 0 0\nf 1 1 1\n' >point.obj
alpenglow info point.obj --pictures none 2>&1 | grep pictures
ls none 2>&1 | grep -c cannot
head -c 8 out/uv0.png | od -An -c
