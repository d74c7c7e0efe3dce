#!/usr/bin/env bash
# Makes the figures of the documentation, in some ten minutes on two cores. Finished steps are skipped when it is
# repeated.
#   docs/figures/make.sh build/lilytank
set -euo pipefail
program=$(realpath "${1:?usage: docs/figures/make.sh LILYTANK}")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=out/tour

# picture <from> <to> <width>
picture() {
  ffmpeg -v error -y -i "$1" -vf "scale=$3:-1:flags=lanczos" -pix_fmt rgb24 "docs/$2.png"
}

"$program" run scenarios/chain5.toml --seed 1 --set output.rate=2 --out $out/run --quiet > /dev/null
"$program" render $out/run --at 1150 --png $out/run/frame.png > /dev/null
"$program" study scenarios/studies/tour.toml --set run.duration='2 h' --out $out/study > /dev/null
"$program" flow scenarios/experiments/tour.toml --out $out/flow > /dev/null
"$program" calibrate scenarios/experiments/tour.toml --out $out/calibration > /dev/null
"$program" diagnose scenarios/experiments/tour.toml --budget 3 --out $out/diagnosis > /dev/null

picture $out/run/frame.png tour/run 800
picture $out/study/yield.png tour/yield 800
picture $out/flow/flow_smooth.png tour/flow 700
picture $out/calibration/msd.png tour/msd 600
picture $out/diagnosis/laws.png tour/laws 700
picture $out/diagnosis/fit.png tour/fit 800
