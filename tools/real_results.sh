#!/usr/bin/env bash
# The figures on real recordings, from the recordings to the table: convert, map the field, localize every run, evaluate.
#
#   tools/real_results.sh MSTSL DATA OUT [SEED [METHOD...]]
#
# MSTSL is the built command, DATA the folder with cea-corridor/, kaist-n1-7f/ and carmen/, OUT a folder for logs and
# results. Ends with OUT/results.json: for each data set what is real, the commands, and what `mstsl evaluate` says.
# METHODs are those of `mstsl localize`; without any, two-step and joint, both on the same logs.
# A folder that is already there is used as it is, so that a run can be continued; remove it to start anew.
set -euo pipefail

[ $# -ge 3 ] || { sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 data=$2 out=$3 seed=${4:-1000}
methods=("${@:5}")
[ ${#methods[@]} -gt 0 ] || methods=(two-step joint)
mkdir -p "$out"

quoted() { printf '"%s"' "$(printf '%s' "$1" | sed 's/\\/\\\\/g; s/"/\\"/g')"; }

localize_all() {  # localize_all FOLDER FIELD METHOD K
  local folder=$1 field=$2 method=$3 k=$4 run status
  for run in "$folder"/run_*.mcap; do
    local estimates=${run%.mcap}_$method.jsonl
    [ -s "$estimates" ] && continue
    status=0
    "$mstsl" localize --map "$folder/map.yaml" --field "$field" --method "$method" -k "$k" --seed "$seed" --quiet \
      -o "$estimates" "$run" || status=$?
    [ $status -eq 0 ] || [ $status -eq 3 ] || return $status  # 3: it ended without a fix, which is a result too
  done
}

# result NAME REAL METHOD K CONVERT_OPTION... : one data set from recording to figures, one JSON object on stdout
result() {
  local name=$1 real=$2 method=$3 k=$4
  shift 4
  local folder=$out/$name field=$out/$name/field.nc
  echo "== $name" >&2
  [ -f "$folder/README.txt" ] || "$mstsl" convert "$@" --seed "$seed" --quiet -o "$folder" >&2
  [ -f "$field" ] || "$mstsl" map magnetic --map "$folder/map.yaml" --pose-topic /ground_truth --quiet -o "$field" \
    "$folder"/survey_*.mcap >&2
  localize_all "$folder" "$field" "$method" "$k"
  local truths=() estimates=() run
  for run in "$folder"/run_*.mcap; do
    local number=${run##*/run_}
    truths+=(--truth "$folder/truth_${number%.mcap}.csv")
    estimates+=("${run%.mcap}_$method.jsonl")
  done
  "$mstsl" evaluate "${estimates[@]}" "${truths[@]}" >&2
  printf '{"dataset": %s, "real": %s, "method": %s, "hypotheses": %s, "seed": %s, "convert": %s, "evaluation": %s}' \
    "$(quoted "$name")" "$(quoted "$real")" "$(quoted "$method")" "$k" "$seed" "$(quoted "${*//$data\//}")" \
    "$("$mstsl" evaluate --json "${estimates[@]}" "${truths[@]}")"
}

separator='['
# each NAME REAL K CONVERT_OPTION... : the same data set with every method
each() {
  local name=$1 real=$2 k=$3 method
  shift 3
  for method in "${methods[@]}"; do
    printf '%s\n' "$separator"
    result "$name" "$real" "$method" "$k" "$@"
    separator=','
  done
}

field='field; lidar and odometry simulated'
plan='floor plan and field; lidar and odometry simulated'
robot='lidar and odometry; field simulated over the real map'
{
  each cea-corridor "$field" 5 --dataset cea-corridor "$data/cea-corridor" --runs 50
  each kaist-n1-7f "$plan" 5 --dataset kaist-n1-7f "$data/kaist-n1-7f" --runs 20
  # Aces comes back so late that only its last fifth revisits the rest: 15 overlapping runs over 27 m.
  each aces "$robot" 5 --dataset carmen "$data/carmen/aces-corrected.log.gz" --runs 15 --mapped-share 0.8
  each intel "$robot" 5 --dataset carmen "$data/carmen/intel-corrected.log.gz" --runs 50
  each freiburg-079 "$robot" 5 --dataset carmen "$data/carmen/freiburg-079-corrected.log.gz" --runs 50
  each seattle "$robot" 5 --dataset carmen "$data/carmen/seattle-corrected.log.gz" --runs 50 --mapped-share 0.5
  printf '\n]\n'
} > "$out/results.json.part"
mv "$out/results.json.part" "$out/results.json"
echo "$out/results.json" >&2
