# SPDX-License-Identifier: MIT
# ambience: the terrain's own flight, and a day that passes
fly="alpenglow ambience builtin:terrain,triangles=5000 --anchors 400 --progress off --sky clear --sun 40,50,80000 --fps 4 --budget 20"
seconds() { $fly --errors off --csv - "$@" | cut -d , -f 1-4; }
seconds | wc -l
seconds --time 3 >own.csv
seconds --time 3 --day 12 | cut -d , -f 1 | cmp - <(cut -d , -f 1 own.csv) && echo "a day"
seconds --time 3 --prediction path --flat on --depth 4 --cell 2 | wc -l
$fly --day 8 --csv - --reference-samples 16 --time 6 | awk -F , 'NR > 1 {print $1, ($6 != "" ? "error" : "none")}'
alpenglow ambience builtin:terrain,triangles=5000 --time 1 2>&1 || echo "exit $?"
