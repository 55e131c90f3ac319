#!/usr/bin/env bash
# What limits the two-step method: initialisation and success over the magnetometer's bias, over the map's error
# (the share of the steel that stands about and was moved between survey and runs) and over the distance of the survey's
# lines, as a Markdown table.
#
#   tools/limits.sh MSTSL OUT [SEED] [WORLD]
#
# MSTSL is the built command, OUT a folder for the protocol's reports, WORLD corridor (default) or carpark. One protocol
# of 10 starts x 10 runs a point; a report that is there already is used as it is.
set -euo pipefail

[ $# -ge 2 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 out=$2 seed=${3:-1000} world=${4:-corridor}
here=$(dirname "$0")

point() {  # point NAME OPTION...: one point of a curve
  local name=$1
  shift
  [ -s "$out/$name/paper_$world.json" ] ||
    "$mstsl" bench --protocol paper --world "$world" --seed "$seed" --fingerprints 0 --quiet -o "$out/$name" "$@" >&2
}

for bias in 0 0.3 1 3 5; do point "bias_$bias" --bias "$bias"; done
for moved in 0 0.1 0.3 0.6 1; do point "moved_$moved" --moved "$moved"; done
for spacing in 0.3 0.5 1 2; do point "lines_$spacing" --lane-spacing "$spacing"; done
python3 "$here/limits_table.py" "$out"/*/"paper_$world.json"
