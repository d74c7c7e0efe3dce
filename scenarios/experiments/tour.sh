#!/usr/bin/env bash
# Makes the recordings of tour.toml: one tank, filmed with balls and with Lilies whose latches are off, and with
# the effect of tour/truth.toml.
#   scenarios/experiments/tour.sh build/lilytank
set -euo pipefail
program=$(realpath "${1:?usage: scenarios/experiments/tour.sh LILYTANK}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# film <name> <seed> <minutes> <scenario> <overlay...>: a run at 5 ms steps, seen by a camera.
film() {
  local name=$1 seed=$2 minutes=$3
  "$program" run "${@:4}" --seed "$seed" --set "run.duration='$minutes min'" --set "run.dt='5 ms'" \
    --set output.rate=20 --out "$work/$name" --quiet > /dev/null
  "$program" recording convert "$work/$name" --out "$work/$name.csv" --camera rate=20 \
    --camera position_noise='0.3 mm' --camera heading_noise='0.01' --camera missed=0.01 \
    --camera seed="$seed" > /dev/null
  # Positions to 0.1 mm, headings to 1 mrad: 4 min of 10 Lilies are 0.5 MB.
  awk -F, -v OFS=, -v CONVFMT=%.10g 'NR == 1 { print; next }
    { $2 = sprintf("%.2f", $2); for (i = 4; i <= 5; i++) $i = sprintf("%.4f", $i)
      if (NF > 5 && $6 != "") $6 = sprintf("%.3f", $6); print }' "$work/$name.csv" |
    gzip -9n > "experiments/tour_$name.csv.gz"
}

film balls_1 1 4 tank_balls.toml experiments/tour/tank.toml
film balls_2 2 4 tank_balls.toml experiments/tour/tank.toml
for run in 1 2 3; do
  film "lily_$run" "$((10 + run))" 4 tank_lilies.toml --set module.count=10 experiments/tour/tank.toml experiments/tour/truth.toml
done
