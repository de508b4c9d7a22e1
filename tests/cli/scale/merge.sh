# SPDX-License-Identifier: MIT
# Shards, and the merge that writes what one bake writes: maps of occlusion and light, an asset.
bake() { alpenglow bake builtin:cornell --size 48 --ao-samples 64 --samples 32 --bounces 2 --maps ao,light \
    --adaptive off -q --progress off "$@"; }
shard() { alpenglow bake builtin:cornell --size 48 --ao-samples 64 --samples 32 --bounces 2 --maps ao,light \
    -q --progress off -o out.glb --maps-dir maps --checkpoint c --shard "$@"; }
same() { cmp whole.glb "$1" && diff -r whole "$2" && echo same; }
bake -o whole.glb --maps-dir whole
shard 2/5 && shard 4/5
alpenglow merge c -q
echo "exit $?"
SLURM_ARRAY_TASK_ID=1 shard slurm/5 && shard 3/5
shard 2/6
echo "exit $?"
alpenglow merge c -q
echo "exit $?"
ls
shard 5/5
alpenglow merge c -q && same out.glb maps
alpenglow merge c -q
echo "exit $?"
alpenglow merge c -q -f && same out.glb maps
mkdir elsewhere
(cd elsewhere && alpenglow merge ../c -q -o new.glb -f && alpenglow merge ../c -q -f -o folder)
ls elsewhere elsewhere/folder
bake -o alone.glb && cmp alone.glb elsewhere/new.glb && diff -r whole elsewhere/folder && echo same
alpenglow merge c -q -o elsewhere/new.glb
echo "exit $?"
# A damaged record costs its shard, which is named.
cp -r c damaged
byte=$(tail -c 1 c/shard-2.tiles | od -An -tu1)
printf "\\x$(printf %x $((byte ^ 1)))" | dd of=damaged/shard-2.tiles bs=1 conv=notrunc status=none \
    seek=$(($(stat -c %s c/shard-2.tiles) - 1))
alpenglow merge damaged -q -o none
echo "exit $?"
# The bake's own outputs stay as they were: one asset or one folder is written.
rm -r out.glb maps
alpenglow merge c -q -o only && ls -d only out.glb maps 2>&1
alpenglow merge c -q -o only.glb && ls -d only.glb out.glb maps 2>&1
# A second operand names the asset of a bake as -o does, and its ending chooses the maps.
lit() { alpenglow bake builtin:cornell --size 32 --samples 16 --sky 1 -q --progress off "$@"; }
lit lit.json --checkpoint d --shard 1/1
alpenglow merge d -q -o lit.glb && alpenglow merge d -q -o lit/ && ls lit && ls -d lit.*
lit --adaptive off --maps-dir reference && diff -r lit reference
lit --adaptive off -o reference.glb && cmp lit.glb reference.glb
alpenglow merge d -q -o lit.png
echo "exit $?"
mkdir lit.png && alpenglow merge d -q -o lit.png && alpenglow merge d -q -o lit.v2/ && diff -r lit.png lit.v2
