# SPDX-License-Identifier: MIT
# render: fields, objects that they light, and spheres that show probes
render="alpenglow render builtin:cornell --resolution 32x24 --samples 4 -q"
for model in constant hemisphere ground-map ambient-cube environment "probes --spacing .1" \
    "lpv --grid 16"; do
    $render --with $model -o "${model%% *}.exr" || echo "exit $?"
done
ls
$render --with probes --spacing .1 --lookup three -o three.exr
$render --with probes --spacing .1 --overlay probes --object sphere,.28,.3,.28,.1 -o object.exr
for name in three object; do
    alpenglow compare probes.exr $name.exr --max-rmse 1e-6 >/dev/null 2>&1 || echo "$name differs"
done
for options in "--blockers views --cascades 2" "--blockers off" "--mode conformance" "--iterations 4" \
    "--cell .05" "--bounces 1"; do
    $render --with lpv --grid 16 $options -f -o object.exr || echo "exit $?"
    alpenglow compare lpv.exr object.exr --max-rmse 1e-3 >/dev/null 2>&1 || echo "$options differs"
done
for options in --gloss "--media 1" "--media 1 --lamp .28,.3,.28,9" "--media 1 --lamp .28,.3,.28,9 --direct off"; do
    $render --with lpv --grid 16 $options -f -o object.exr || echo "exit $?"
    alpenglow compare lpv.exr object.exr --max-rmse 1e-3 >/dev/null 2>&1 || echo "$options differs"
done
$render --with lpv --grid 16 --media 0 -f -o object.exr && cmp lpv.exr object.exr && echo "no medium, no difference"
$render --with lpv --grid 16 --sky 1,1,1 -f -o object.exr
$render --with reference --lamp .28,.3,.28,9 -o on.exr
$render --with reference --lamp .28,.3,.28,9 --direct off -o off.exr
alpenglow compare on.exr off.exr --max-rmse .1 >/dev/null 2>&1 || echo "the lamp is left out"
for options in "--with ao --direct off" "--with constant --spacing 1" "--with ao --object sphere,0,0,0,1" \
    "--with probes --object cube,0,0,0,1" "--with probes --object sphere,0,0,0,0" \
    "--with constant --overlay probes" "--with probes --lookup godot" "--with ao --grid 9" \
    "--with probes --cell 1" "--with lpv --bounces 2" "--with lpv --spacing 1" "--with lpv --path x"; do
    $render $options -o x.exr 2>&1 | head -n 1
done
alpenglow probes builtin:furnace -q --spacing 1 -o other.probes.json
$render --with probes --probes other.probes.json -o other.exr
