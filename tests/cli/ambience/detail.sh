# SPDX-License-Identifier: MIT
# ambience: a simplified scene gives nearly the light of the scene itself; metres of 0 are that scene
sky="--sky clear --sun 40,50,80000"
flight="--with ambience --time 1 --fps 4 --budget 20 --anchors 300 --progress off $sky"
printf -- '-95,17,38,0,1,0\n-100,18,41,1,0,0\n' >points.csv
for detail in "" "--detail 0" "--detail 2"; do
    alpenglow sample builtin:terrain,triangles=20000 $flight $detail --at points.csv >"sampled$detail.csv"
done
cmp sampled.csv "sampled--detail 0.csv" && echo "0 is the scene itself"
paste -d , sampled.csv "sampled--detail 2.csv" | awk -F , 'NR > 1 {
    change = $17 / $7 - 1
    print (change == 0 ? "the same" : change ^ 2 < .1 ^ 2 ? "nearly the same" : change)}'
alpenglow ambience builtin:terrain,triangles=5000 --time .5 --fps 4 --budget 1 --anchors 100 --detail 1.5 $sky \
    --errors off --progress off --json - | grep -o '"detail": [0-9.]*'
