#!/usr/bin/env bash
# The paper's two sites, surveyed: how near tracked positions come to the true ones, and what that does to the field map.
#
#   tools/survey_positions.sh MSTSL SURVEY_POSITIONS OUT SEED
#
# MSTSL is the built command, SURVEY_POSITIONS the built bench/survey_positions. Ends with OUT/positions.json;
# docs/results/positions/SEED.json is a copy of one.
set -euo pipefail

[ $# -eq 4 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 program=$2 out=$3 seed=$4
mkdir -p "$out"

separator='{'
{
  for world in corridor carpark; do
    echo "== $world" >&2
    "$mstsl" simulate --world $world --seed "$seed" --moved 0 --bias-sigma-uT 0 --runs 10 --scan-hz 1 --survey-scan-hz 10 \
      --quiet -o "$out/$world"
    printf '%s"%s": ' "$separator" $world
    "$program" "$out/$world"
    separator=','
  done
  printf '}\n'
} > "$out/positions.json.part"
mv "$out/positions.json.part" "$out/positions.json"
echo "$out/positions.json" >&2
