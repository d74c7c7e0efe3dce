#!/usr/bin/env bash
# The paper's Fig. 4 with the built-in tank: mean squared displacement of 24 balls for five pump
# powers and three water levels, as one plot (msd_all.png) with its table.
#
#   scenarios/figure4.sh [OUT]
#
# Environment: LILYTANK, the program (default: that of the build or installation of this file, else the
# one in PATH).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=${1:-out/figure4}
for program in "$here/../build/lilytank" "$here/../../../bin/lilytank" lilytank; do
  if command -v "$program" > /dev/null; then break; fi
done
lilytank=${LILYTANK:-$program}
runs=()
for level in -7 -8 -9; do
  for power in 50 60 69 80 90; do
    run=$out/level$level-power$power
    "$lilytank" run "$here/tank_balls.toml" --quiet --out "$run" --set output.rate=10 \
      --set flow.pump_power="$power %" --set flow.water_level="$level cm" > /dev/null
    runs+=("$run")
  done
done
# The first 20 s are excluded: the balls reach their orbits.
"$lilytank" analyze "${runs[@]}" --msd-only --label flow.pump_power --panel flow.water_level \
  --from '20 s' --longest-lag '15 s' --out "$out/analysis"
