# Files in the way of results: no verb replaces one without --force, and with it each does.

in_the_way() {  # <file in $out> <argument...>: plants the file; the command is refused, all stays
  local file=$out/$1 before
  mkdir -p "${file%/*}"
  echo mine > "$file"
  before=$(digest "$out")
  refuses "${1##*/} in the way of ${*:2:2}" "${@:2}"
  [[ $(digest "$out") == "$before" ]] ||
    count_wrong "${1##*/} in the way of ${*:2:2}" "something has changed"
}
replaced() {  # <file in $out> <argument...>: refused; with --force replaced; then the same command
  in_the_way "$@"
  local tried="${1##*/}, ${*:2:2} --force"
  if ! "$lily" "${@:2}" --force > /dev/null 2> "$home/err" < /dev/null; then
    count_wrong "$tried" "$(head -c 300 "$home/err")"
  elif grep -sqx mine "$out/$1"; then
    count_wrong "$tried" "it is not replaced"
  elif ! "$lily" "${@:2}" > /dev/null 2> "$home/err" < /dev/null; then
    count_wrong "$tried, then again" "$(head -c 300 "$home/err")"
  else
    count_same
  fi
}

make_dense() {  # a run whose poses are stored often enough for a film without a note
  [[ -d $home/dense ]] ||
    "$lily" run "$in/tank.toml" --quiet --set output.rate=40 --out "$home/dense" > /dev/null 2>&1
}

make_experiment() {  # lilies and balls, with too little of both for an estimate
  cp "$in/tracks.csv" "$home/lilies.csv"
  cut -d, -f1-5 "$in/tracks.csv" > "$home/balls.csv"
  cat > "$home/experiment.toml" <<'END'
[[recording]]
file = "lilies.csv"
body = "lily"
latches = "off"
[[recording]]
file = "balls.csv"
body = "ball"
END
}

overwriting() {
  local name
  fresh
  make_dense
  replaced cross.rules synthesize "$in/cross.txt" --out "$out/cross.rules"
  "$lily" synthesize "$in/cross.txt" --all "$home/all" > /dev/null 2>&1
  name=$(ls "$home/all" | head -1)
  replaced "all/$name" synthesize "$in/cross.txt" --all "$out/all"
  for name in kappa bngl; do
    replaced "rules.$name" check "$in/pair.rules" --lattice 0 "--$name" "$out/rules.$name"
  done
  replaced check/yield.csv check "$in/pair.rules" --lattice 0 --rates "$in/done" --gillespie 10 \
    --out "$out/check"
  replaced measured/check.json check "$in/pair.rules" --lattice 0 --measure "$in/tank.toml" \
    --worlds 1 --duration 20 --gillespie 10 --quiet --out "$out/measured"
  replaced view.html view "$home/dense" --quiet --out "$out/view.html"
  replaced converted.csv recording convert "$in/tracks.csv" --out "$out/converted.csv"
  replaced filmed.csv recording convert "$home/dense" --out "$out/filmed.csv"
  replaced findings.csv recording check "$in/tracks.csv" --csv "$out/findings.csv"
  for name in summary.csv msd_all.csv report.html; do
    in_the_way "analysis-$name/$name" analyze "$in/tracks.csv" --resamples 20 \
      --out "$out/analysis-$name"
  done
  replaced analysis/summary.txt analyze "$in/tracks.csv" --resamples 20 --out "$out/analysis"
  for name in summary.txt yield.png report.html; do
    replaced "run-$name/$name" run "$in/tank.toml" --quiet --out "$out/run-$name"
  done
  replaced study/table.csv study "$in/pairs.toml" --quiet --out "$out/study"
  replaced best/optimum.toml optimize "$in/best.toml" --quiet --out "$out/best"
  make_experiment
  in_the_way flow/flow_smooth.csv flow "$home/experiment.toml" --quiet --out "$out/flow"
  in_the_way calibrate/calibrated.toml calibrate "$home/experiment.toml" --flow scenario --quiet \
    --out "$out/calibrate"
  in_the_way recover/recovery.csv calibrate "$in/bare.toml" --recover 1 --quiet \
    --out "$out/recover"
  in_the_way proof/proof.csv prove --worlds 1 --only null --known-flow --quiet --out "$out/proof"
  discard
}
overwriting_pictures() {
  local name
  fresh
  make_dense
  replaced stages.svg synthesize "$in/cross.txt" --out "$out/stages.rules" \
    --figure "$out/stages.svg"
  for name in svg png; do
    replaced "frame.$name" render "$home/dense" --quiet "--$name" "$out/frame.$name"
  done
  replaced stills/frame_000001.png render "$home/dense" --quiet --size 120 --fps 2 --speed 20 \
    --stills "$out/stills"
  in_the_way stills/frame_000999.png render "$home/dense" --quiet --size 120 --fps 2 --speed 20 \
    --stills "$out/stills"
  if command -v ffmpeg > /dev/null; then
    replaced film.mp4 render "$home/dense" --quiet --size 120 --speed 50 --mp4 "$out/film.mp4"
    in_the_way film.gif render "$home/dense" --quiet --size 120 --speed 50 --mp4 "$out/film.mp4" \
      --gif "$out/film.gif"
    "$lily" run "$in/tank.toml" --quiet --out "$out/run" > /dev/null 2>&1
    in_the_way run/yield.png run "$in/tank.toml" --quiet --video --out "$out/run"
  fi
  discard
}

overwriting_rows() {
  if row "files in the way of results"; then overwriting; fi
  if row "files in the way of pictures"; then
    if [[ -d $home/ref/draw && -n $(ls "$home/ref/draw") ]]; then
      overwriting_pictures
    else
      skip_row "built without the renderer"
    fi
  fi
}
