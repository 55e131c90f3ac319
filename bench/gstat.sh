#!/usr/bin/env bash
# Regression of one part of a survey by mstsl and by gstat with 50 neighbours, side by side, both against the dense
# solution: tools needed are R with gstat (Debian: r-cran-gstat) and the benchmarks' build (-DMSTSL_BUILD_BENCHMARKS=ON).
#   bench/gstat.sh BUILD/bench/field_map_part [FOLDER]
set -euo pipefail
program=${1:?usage: bench/gstat.sh BUILD/bench/field_map_part [FOLDER]}
folder=${2:-out/gstat}
command -v Rscript >/dev/null || { echo "gstat.sh: Rscript is not there; install r-cran-gstat" >&2; exit 1; }
mkdir -p "$folder"
"$program" make "$folder"
Rscript "$(dirname "$0")/gstat.R" "$folder"
"$program" compare "$folder"
