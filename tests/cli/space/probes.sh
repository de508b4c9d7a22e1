# SPDX-License-Identifier: MIT
# probes: files, their facts, and all that is refused
probes="alpenglow probes builtin:cornell -q"
$probes --spacing .2 -o room.probes.json && ls
alpenglow info room.probes.json | sed 's/[0-9.e+-]* %/N %/; s/irradiance .* W/irradiance N W/'
alpenglow info builtin:cornell --probes room.probes.json | tail -n 1
alpenglow info builtin:furnace --probes room.probes.json | tail -n 1
$probes --spacing .2 -o room.probes.json || echo "exit $?"
$probes --spacing .2 --threads 1 -o one.probes.json && cmp room.probes.ktx2 one.probes.ktx2 &&
    echo "same bits"
$probes --spacing .2 --export three -o web.probes.json && ls web*
for options in "--spacing 0" "--spacing nan" "--bounds 1,2" "--export-scale 2" "--at a.csv --spacing 1" \
    "--split rooms" "--at a.csv --gradients" "--layers --gradients" "--bounds 1,1,1,1,1,1" "--basis ambient-cube --export three" "--export bevy"; do
    $probes $options -o x.probes.json 2>&1 | head -n 1
done
alpenglow probes builtin:cornell 2>&1 | head -n 1
alpenglow probes builtin:cornell -o x.txt 2>&1 | head -n 1
$probes --spacing 1e-4 -o x.probes.json || echo "exit $?"
$probes --bounds 9,9,9,10,10,10 --spacing 1 -o x.probes.json -f; rm -f x.*
printf 'x,y,z\n.2 .2 .2\n# a comment\n.3;.3;.3;1\n' | $probes --at - -o list.probes.json && ls list*
printf "0,,0.3,0.1\n" >bad.csv; $probes --at bad.csv -o x.probes.json || echo "exit $?"
for text in '1,2' '1,2,nan' '1,2,x' ''; do
    printf '%s\n' "$text" >bad.csv
    $probes --at bad.csv -o x.probes.json || echo "exit $?"
done
$probes --at nowhere.csv -o x.probes.json || echo "exit $?"
printf 'x' >>room.probes.ktx2
alpenglow info room.probes.json 2>&1 | sed "s/[0-9][0-9]* bytes, its JSON states [0-9]*/N bytes, its JSON states N/"
sed -i 's/"version":1/"version":9/' web.probes.json && alpenglow info web.probes.json || echo "exit $?"
ls x* 2>/dev/null || true
