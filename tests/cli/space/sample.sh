# SPDX-License-Identifier: MIT
# sample: every model of light at points, in one form
printf 'x,y,z,nx,ny,nz\n.28,.27,.28,0,1,0\n.28 .27 .28\t0 -2 0\n' >points.csv
sample="alpenglow sample builtin:cornell --at points.csv -q"
$sample --with reference --samples 16 | cut -d , -f 1-6
for model in reference "probes --spacing .1" constant hemisphere ground-map ambient-cube environment \
    "lpv --grid 16"; do
    # above is brighter than below, but for one colour alone
    $sample --with $model | awk -F , -v model="${model%% *}" 'NR == 2 {up = $7}
        NR == 3 {print model, (up > $7 ? "up" : (up == $7 ? "even" : "down")), NF}'
done
$sample --with constant --direct on --lamp .3,.3,.3,1 | tail -n 1 | cut -d , -f 1-3
alpenglow probes builtin:cornell --spacing .2 -q -o room.probes.json
$sample --with probes --probes room.probes.json >file.csv &&
    $sample --with probes --spacing .2 | awk -F , 'NR == FNR {r[FNR] = $7; next}
        FNR > 1 && ($7 - r[FNR])^2 > (.002 * $7)^2 {bad = 1} END {print (bad ? "differs" : "agrees")}' \
        file.csv -
for options in "" "--with probes --samples 9" "--with constant --spacing 1" "--with x" \
    "--with probes --probes room.probes.json --spacing 1" "--with probes --probes room.probes.json --direct on"; do
    $sample $options 2>&1 | head -n 1
done
alpenglow sample builtin:cornell --with constant 2>&1 | head -n 1
printf '1,2,3\n' >bad.csv
alpenglow sample builtin:cornell --with constant --at bad.csv || echo "exit $?"
printf '1,2,3,0,0,0\n' >bad.csv
alpenglow sample builtin:cornell --with constant --at bad.csv || echo "exit $?"
alpenglow sample builtin:sphere-plane --with constant --at points.csv || echo "exit $?"
