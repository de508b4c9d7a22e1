# SPDX-License-Identifier: MIT
# ambience: a budget of milliseconds takes samples, few where it is short, all of them where it is long
printf '0,.1,.45,.4,.28,.27,0\n2,.45,.45,.4,.28,.27,0\n' >flight.csv
fly="alpenglow ambience builtin:cornell --path flight.csv --fps 5 --anchors 300 --errors off --warm off --progress off"
counts() { $fly "$@" --csv - | cut -d , -f 1-3; }
counts --budget 65536 >all.csv
counts --budget-ms .01 >short.csv
counts --budget-ms 10000 | cmp - all.csv && echo "a long budget takes all"
paste -d , short.csv all.csv | awk -F , 'NR > 1 {
    print $1, ($3 > 0 ? "samples" : "none"), ($3 * 2 < $6 ? "fewer" : $3 " of " $6)}'
$fly --budget-ms 1 --json - | grep -o '"budget[a-z_]*": [0-9.a-z]*'
for command in "sample --at points.csv" "render -o picture.exr --resolution 16x9"; do
    printf '.28,.27,.28,0,1,0\n' >points.csv
    alpenglow ${command%% *} builtin:cornell ${command#* } --with ambience --path flight.csv --fps 5 --anchors 300 \
        --progress off --budget-ms 1 -q | wc -l
done
