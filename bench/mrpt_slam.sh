#!/usr/bin/env bash
# MRPT's 2-D SLAM on the real logs that tools/real_mapping.sh maps, held against the same poses by the same measures.
#
#   bench/mrpt_slam.sh MRPT_SLAM DATA OUT
#
# MRPT_SLAM is the built program of mrpt_slam.cpp, DATA the folder with carmen/. Ends with OUT/mrpt.json;
# docs/results/mapping/mrpt.json is a copy of one.
set -euo pipefail

[ $# -eq 3 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
program=$1 data=$2 out=$3
settings=$(dirname "$0")/mrpt
mkdir -p "$out"

separator='{'
{
  for log in freiburg-079 intel aces seattle; do
    for way in icp icp-best rbpf; do
      echo "== $log, $way" >&2
      printf '%s"%s, %s": ' "$separator" "$log" "$way"
      # MRPT's warnings, one a scan and particle, go to stdout too.
      "$program" "${way%-best}" "$settings/$way.ini" "$data/carmen/$log-corrected.log.gz" /corrected_pose 2>/dev/null | tail -1
      separator=','
    done
  done
  printf '}\n'
} > "$out/mrpt.json.part"
mv "$out/mrpt.json.part" "$out/mrpt.json"
echo "$out/mrpt.json" >&2
