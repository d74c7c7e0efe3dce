#!/usr/bin/env bash
# Runs random scenarios and measures their overlaps with another program. Prints a table; exit 1 if
# an overlap exceeds 0.5 mm or is deeper than the run reports.
#   run.sh LILYTANK OVERLAP_CHECK SCENARIOS [FIRST] [COUNT] [STEPS]
# STEPS: module-steps of each scenario (0: a few seconds).
set -uo pipefail
lilytank=$1 check=$2 scenarios=$3 first=${4:-1} count=${5:-100} steps=${6:-0}
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

# Two modules 34.4 mm apart, turned by the same angle: 0.6 mm, which must be found.
mkdir "$work/known"
printf '[tank]\nradius = 0.3\n[module]\ncount = 2\nside = 0.035\n[ball]\ncount = 0\nradius = 0.01\n' \
  > "$work/known/resolved.toml"
printf '"deepest_overlap_m": 0.00061\n' > "$work/known/summary.json"
printf 'frame,time,id,x,y,theta\n0,0,0,0,0,1.0471976\n0,0,1,0.0172,0.02979127,1.0471976\n' \
  > "$work/known/trajectory.csv"
found=$("$check" check "$work/known")
if [[ $found != *' 0.6000 '*'beyond 0.5 mm' ]]; then
  echo "a known overlap of 0.6 mm is not found: $found"
  exit 1
fi

faults=0 diverged=0
echo "scenario frames  pairs/mm   wall/mm  reported"
for ((k = first; k < first + count; ++k)); do
  read -r file options <<< "$("$check" draw "$k" "$steps")"
  # shellcheck disable=SC2086  # the options hold no blanks
  "$lilytank" run "$scenarios/$file" $options --quiet --out "$work/run" > "$work/out" 2>&1
  status=$?
  printf '%8d' "$k"
  if ((status > 1)); then
    printf '  exit code %d: %s\n' "$status" "$(tail -n 1 "$work/out")"
    faults=$((faults + 1))
    continue
  fi
  ((status == 0)) || diverged=$((diverged + 1))
  "$check" check "$work/run" || faults=$((faults + 1))
  rm -rf "$work/run"
done
echo "$count scenarios, $diverged diverged, $faults with an overlap that is too deep or not reported"
((faults == 0))
