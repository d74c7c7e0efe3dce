#!/usr/bin/env bash
# Makes the figures of the documentation from shipped data, in some 25 minutes of processor time. Finished steps are
# skipped when it is repeated.
#   docs/figures/make.sh build/lilytank
set -euo pipefail
program=$(realpath "${1:?usage: docs/figures/make.sh LILYTANK}")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=out/tour
tour=scenarios/experiments/tour.toml

# picture <from> <to> <width>
picture() {
  ffmpeg -v error -y -i "$1" -vf "scale=$3:-1:flags=lanczos" -pix_fmt rgb24 "docs/$2.png"
}

# page <file> <to> <time, s>: a picture of a page of `lilytank view` with the width of a screen.
page() {
  chromium --headless --no-sandbox --disable-gpu --no-first-run --user-data-dir=$out/profile --window-size=1280,800 \
    --virtual-time-budget=4000 --screenshot=$out/page.png "file://$(realpath "$1")#t=$3" 2> /dev/null
  picture $out/page.png "$2" 1000
}

"$program" run scenarios/chain5.toml --seed 1 --set output.rate=2 --out $out/run --quiet > /dev/null
"$program" render $out/run --at 340 --png $out/run/frame.png > /dev/null
picture $out/run/frame.png tour/run 800

"$program" run scenarios/demo.toml --out $out/demo --quiet > /dev/null
"$program" render $out/demo --at 400 --png $out/demo/frame.png > /dev/null
picture $out/demo/frame.png figures/tank 1280
"$program" view $out/demo --force > /dev/null
page $out/demo/view.html figures/view 400

"$program" study scenarios/studies/tour.toml --set run.duration='2 h' --out $out/study > /dev/null
picture $out/study/yield.png tour/yield 800

"$program" synthesize scenarios/targets/cross5.txt --modules 15 --figure $out/stages.png > /dev/null
picture $out/stages.png figures/stages 900

"$program" analyze $tour --body lily --longest-lag '20 s' --out $out/analysis > /dev/null
picture $out/analysis/msd_all.png figures/analysis 700

"$program" run scenarios/tank_lilies.toml --seed 3 --set run.duration='20 s' --set output.rate=40 \
  --out $out/film --quiet > /dev/null
"$program" recording convert $out/film --camera rate=30 --camera swaps=0.5 --camera missed=0.01 \
  --out $out/film.csv.gz > /dev/null
"$program" render $out/film --at 2.2 --trail 2 --no-labels --png $out/swap.png > /dev/null
picture $out/swap.png figures/film 700

"$program" optimize scenarios/optimize/probabilities.toml --overlay scenarios/l4.toml --set run.duration='30 min' \
  --no-compare --out $out/optimize > /dev/null
picture $out/optimize/fitness.png figures/fitness 700

"$program" flow $tour --out $out/flow > /dev/null
picture $out/flow/flow_smooth.png tour/flow 700

"$program" calibrate $tour --out $out/calibration > /dev/null
picture $out/calibration/msd.png tour/msd 900
picture $out/calibration/estimates.png figures/estimates 900

"$program" diagnose $tour --budget 3 --out $out/diagnosis > /dev/null
picture $out/diagnosis/laws.png tour/laws 700
picture $out/diagnosis/fit.png tour/fit 800
"$program" view $out/diagnosis $tour --force > /dev/null
page $out/diagnosis/view.html figures/view_diagnosis 20

"$program" run scenarios/tank_lilies.toml $out/diagnosis/missing.toml --set module.count=10 \
  --set run.duration='12 min' --set output.rate=20 --out $out/with-effect --quiet > /dev/null
"$program" analyze $tour $out/with-effect --body lily --name recorded --name simulated --longest-lag '20 s' \
  --out $out/compared > /dev/null
picture $out/compared/pair_correlation.png tour/compared 700
