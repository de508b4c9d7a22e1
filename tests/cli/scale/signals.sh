# SPDX-License-Identifier: MIT
# SIGTERM and SIGUSR1 write the checkpoint and end with 75, Ctrl-C with 130; the work is kept each time,
# and the same command goes on. While the scene is read, they end with 75 as well, and without a checkpoint
# as for other programs. The first write comes within 5 s of the first ray.
# status tells a bake that runs from one that was killed.
set -m # jobs of their own, in which SIGINT is not ignored
bake=(alpenglow bake builtin:cornell --size 128 --ao-samples 49152 --progress off -q -f)
"${bake[@]}" --maps-dir whole
for signal in TERM USR1 INT; do
    "${bake[@]}" --maps-dir maps --checkpoint c 2>stderr &
    job=$!
    sleep 0.5
    kill -$signal $job
    wait $job
    echo "$signal: exit $?"
    cat stderr
    [ -s c/bake.tiles ] || echo "no tiles"
    before=$(sed -n 's/^tiles //p' c/bake.state)
    [ "$before" -gt 0 ] || echo "no work was kept"
done
"${bake[@]}" --maps-dir maps --checkpoint c --json report.json
echo "exit $?"
cmp whole/ao.exr maps/ao.exr && echo same
"${bake[@]}" --ao-samples 1048576 --maps-dir maps --checkpoint long &
job=$!
disown $job
began=$(date +%s%N)
while [ ! -s long/bake.state ] || ! grep -q "^tiles [1-9]" long/bake.state && [ $(($(date +%s%N) - began)) -lt 15000000000 ]; do
    sleep 0.1
done
late=$((($(date +%s%N) - began) / 1000000))
[ $late -le 5500 ] || echo "the first write took $late ms" # half a second to start
alpenglow status long | sed 's/;.*//'
kill -KILL $job
alpenglow status long | sed 's/;.*//'
large=(alpenglow bake builtin:atrium,triangles=4000000 --ao-samples 1 --size 32 --progress off -q --maps-dir none)
for folder in none early; do
    for signal in TERM USR1; do
        "${large[@]}" $([ $folder = early ] && echo --checkpoint early) 2>stderr &
        job=$!
        sleep 0.4
        kill -$signal $job
        wait $job 2>/dev/null
        echo "$folder $signal: exit $?"
        cat stderr
    done
done 2>/dev/null # bash prints which signal ended a job
