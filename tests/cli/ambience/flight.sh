# SPDX-License-Identifier: MIT
# ambience: lines of a flight that are wrong are refused with file, line, fault and remedy
fly() {
    printf '%b' "$1" >flight.csv
    alpenglow ambience builtin:cornell --path flight.csv -q --errors off --fps 1 --budget 1 2>&1
    echo "exit $?"
}
good='0,.28,.3,.5,.28,.27,0\n'
fly ''
fly '# only a comment\n\n'
fly 't,px,py,pz,tx,ty,tz\n'
fly "${good}time,px,py,pz,tx,ty,tz\n"
fly '0,.28,.3,.5,.28,.27\n'
fly '0,.28,.3,,.28,.27,0\n'
fly 'now,.28,.3,.5,.28,.27,0\n'
fly '0,.28,nan,.5,.28,.27,0\n'
fly '0,.28,.3,inf,.28,.27,0\n'
fly 'nan,.28,.3,.5,.28,.27,0\n'
fly '1e10,.28,.3,.5,.28,.27,0\n'
fly '0,.28,.3,1e16,.28,.27,0\n'
fly '0,.28,.3,.5,.28,.3,.5\n'
fly '0,.28,.3,.5,.28,.27,0,0\n'
fly '0,.28,.3,.5,.28,.27,0,180\n'
fly '0,.28,.3,.5,.28,.27,0,60,1\n'
fly '0,.28,.3,.5,.28,.27,0,wide\n'
fly "1,.28,.3,.5,.28,.27,0\n$good"
fly "$good$good"
alpenglow ambience builtin:cornell --path missing.csv 2>&1 || echo "exit $?"
alpenglow ambience builtin:cornell --path . 2>&1 || echo "exit $?"
printf "$good" >flight.csv
alpenglow ambience builtin:cornell --path flight.csv --time -1 2>&1 || echo "exit $?"
