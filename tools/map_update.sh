#!/usr/bin/env bash
# What `mstsl map update` does for a map: buildings are surveyed, some of their things are moved (or none), eight drives
# update the map, and eight others are held against it as it was and as it is then.
#
#   tools/map_update.sh MSTSL OUT
#
# Ends with OUT/update.json. docs/results/update/1016.json is a copy of one.
set -euo pipefail

[ $# -eq 2 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 out=$2
mkdir -p "$out"
seed=1016

held_against() {  # held_against FOLDER FIELD: the reports of the drives 08 to 15
  local separator='[' drive
  for drive in "$1"/run_0[89].mcap "$1"/run_1*.mcap; do
    printf '%s' "$separator"
    "$mstsl" map update --quiet --json --map "$1/map.yaml" --field "$2" "$drive"
    separator=','
  done
  printf ']'
}

building() {  # building WORLD MOVED
  local folder=$out/$1-$2
  echo "== $1, $2 moved" >&2
  "$mstsl" simulate --world "$1" --seed $seed --moved "$2" --runs 16 --run-length 20 --scan-hz 10 --quiet -o "$folder"
  "$mstsl" map magnetic --quiet --map "$folder/map.yaml" --pose-topic /ground_truth --resolution 0.1 \
    -o "$folder/field.nc" "$folder"/survey_*.mcap
  printf '{"world": "%s", "moved": %s, "seed": %s, "update": ' "$1" "$2" $seed
  "$mstsl" map update --quiet --json --map "$folder/map.yaml" --field "$folder/field.nc" -o "$folder/updated.nc" \
    "$folder"/run_0[0-7].mcap
  printf ', "before": '
  held_against "$folder" "$folder/field.nc"
  printf ', "after": '
  held_against "$folder" "$folder/updated.nc"
  printf '}\n'
}

separator='['
{
  for world in carpark aisles warehouse; do
    for moved in 0 0.4; do
      printf '%s' "$separator"
      building $world $moved
      separator=','
    done
  done
  printf ']\n'
} > "$out/update.json.part"
mv "$out/update.json.part" "$out/update.json"
echo "$out/update.json" >&2
