#!/usr/bin/env bash
# Maps of real logs, made from scans and wheels alone, against the poses that come with the logs.
#
#   tools/real_mapping.sh MSTSL DATA OUT
#
# MSTSL is the built command, DATA the folder with carmen/, OUT a folder for maps and pictures. Ends with OUT/real.json: for
# each log what `mstsl map occupancy --json` says, without the single closures, and the CPU seconds it took.
set -euo pipefail

[ $# -eq 3 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0" >&2; exit 2; }
mstsl=$1 data=$2 out=$3
mkdir -p "$out"
for log in freiburg-079 intel aces seattle; do
  echo "== $log" >&2
  TIMEFORMAT='%U'
  { time "$mstsl" map occupancy --json --quiet --truth-topic /corrected_pose --picture "$out/$log.png" -o "$out/$log.yaml" \
    "$data/carmen/$log-corrected.log.gz" >"$out/$log.json"; } 2>"$out/$log.cpu_s"
done
python3 - "$out" <<'PY'
import json, pathlib, sys
out = pathlib.Path(sys.argv[1])
logs = {}
for log in ("freiburg-079", "intel", "aces", "seattle"):
    report = json.loads((out / f"{log}.json").read_text())
    report.pop("closures")
    logs[log] = report | {"cpu_s": float((out / f"{log}.cpu_s").read_text().split()[-1])}
(out / "real.json").write_text(json.dumps({"logs": logs}, indent=1) + "\n")
PY
