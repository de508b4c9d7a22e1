# SPDX-License-Identifier: MIT
# ambience: a line for each second, as CSV, table and JSON; the same numbers by any number of threads
printf 't,px,py,pz,tx,ty,tz,vfov\n0,.1,.45,.4,.28,.27,0,60\n# then\n2.5;.45;.45;.4;.28;.27;0;50\n' >flight.csv
fly="alpenglow ambience builtin:cornell --path flight.csv --fps 10 --budget 20 --anchors 300 --progress off"
counts() { cut -d , -f 1-4; }
$fly --reference-samples 16 --csv seconds.csv --json seconds.json -q
head -n 1 seconds.csv
tail -n +2 seconds.csv | awk -F , '{print $1, ($2 > 0 ? "anchors" : "none"), ($3 > 0 && $3 <= 800 ? "samples" : $3),
    ($4 > 0 ? "bytes" : "none"), ($5 >= 0 ? "ms" : "none"), ($6 > 0 && $6 < 100 ? "error" : $6)}'
json_shape seconds.json
echo "last anchors"
$fly --reference-samples 16 --csv - --threads 1 | counts | cmp - <(counts <seconds.csv) && echo "threads agree"
$fly --csv - --errors off | counts | cmp - <(counts <seconds.csv) && echo "errors change nothing"
$fly --csv - --errors off --time 1 | awk -F , '{print NF, $6}'
printf '0,1000,0,0,0,0,0\n' >far.csv
$fly --path far.csv --time 1 --csv - | awk -F , '{print NF, $6}'
$fly --errors off --time 4 | awk 'NR == 1 || /^ *[0-9]/ {print NR, NF} /^[a-z]+ / {print $1}'
printf '5,.1,.45,.4,.28,.27,0\n' | alpenglow ambience builtin:cornell --path - --fps 2 --budget 4 --anchors 300 --progress off --csv - --errors off | wc -l
$fly --csv seconds.csv 2>&1 || echo "exit $?"
$fly --csv seconds.csv -f --errors off -q && ls
