# SPDX-License-Identifier: MIT
# Ctrl-C in the middle: 130 within a second (ALP_CLI_PATIENCE seconds where a sanitizer slows us),
# and nothing is left behind
set -m # a job of its own, in which SIGINT is not ignored
for signal in INT TERM; do
    alpenglow bake builtin:teapot-room --size 1024 --ao-samples 1048576 -o out.glb --maps-dir maps \
        --json out.json --progress off 2>stderr &
    job=$!
    sleep 1
    before=$(date +%s%N)
    kill -$signal $job
    (sleep $((10 * ${ALP_CLI_PATIENCE:-1})) && kill -KILL $job) 2>/dev/null & # should it not stop
    watch=$!
    disown $watch
    wait $job
    echo "exit $?"
    kill -- -$watch
    late=$((($(date +%s%N) - before) / 1000000))
    [ $late -le $((1000 * ${ALP_CLI_PATIENCE:-1})) ] || echo "it took $late ms"
    grep -v '^note: ' stderr
    rm stderr
    find . -type f
done
