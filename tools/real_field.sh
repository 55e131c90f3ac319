#!/usr/bin/env bash
# How well field maps of real surveys foretell other real drives, by model and covariance.
#
#   tools/real_field.sh MSTSL DATA OUT
#
# MSTSL is the built command, DATA the folder with cea-corridor/ and aalto-robot/. Ends with OUT/field.json: for each
# data set and way what `mstsl map magnetic --check --json` says. docs/results/field.json is a copy of one.
set -euo pipefail

[ $# -eq 3 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 data=$2 out=$3
mkdir -p "$out"

separator='['
each() {  # each DATASET: convert once, then all ways
  local folder=$out/$1 way
  [ -f "$folder/README.txt" ] || "$mstsl" convert --dataset "$1" --quiet -o "$folder" "$data/$1" >&2
  for way in '--kernel se' '--kernel auto' '--model bilinear' '--model fingerprint'; do
    echo "== $1 $way" >&2
    printf '%s\n{"dataset": "%s", "way": "%s", "report": ' "$separator" "$1" "$way"
    # shellcheck disable=SC2086  # options are words of their own
    "$mstsl" map magnetic $way --json --map "$folder/map.yaml" --pose-topic /ground_truth -o "$out/field.nc" \
      "$folder"/survey_*.mcap --check "$folder"/check_*.mcap
    printf '}'
    separator=','
  done
}
{ each cea-corridor; each aalto-robot; printf '\n]\n'; } > "$out/field.json.part"
mv "$out/field.json.part" "$out/field.json"
echo "$out/field.json" >&2
