#!/usr/bin/env bash
# Schemas against Taplo: every shipped file conforms, and each misspelt one is refused by both Taplo and the
# program. Skipped (77) where npm is not installed or cannot install Taplo.
#   run.sh LILYTANK SOURCE
set -euo pipefail
lilytank=$(realpath "$1")
cd "$2"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if ! command -v npm > /dev/null; then
  echo "skipped: npm is not installed, and Taplo comes with it"
  exit 77
fi
if ! timeout 120 npm install --silent --prefix "$work/npm" @taplo/cli@0.7.0 > "$work/log" 2>&1; then
  echo "skipped: npm cannot install @taplo/cli"
  cat "$work/log"
  exit 77
fi
kinds=(scenario experiment bodies study optimize)
for kind in "${kinds[@]}"; do "$lilytank" schema "$kind" > "$work/$kind.json"; done

# taplo <kind> <file...>
taplo() {
  "$work/npm/node_modules/.bin/taplo" check --schema "file://$work/$1.json" "${@:2}" > "$work/log" 2>&1
}

# kind_of <file>: what a file is, by its tables.
kind_of() {
  if grep -q '^\[study\]' "$1"; then echo study
  elif grep -q '^\[optimize\]' "$1"; then echo optimize
  elif grep -q '^body = "point"' "$1"; then echo bodies
  elif grep -q '^\[\[recording\]\]' "$1"; then echo experiment
  else echo scenario; fi
}

faults=0
fault() {
  echo "$1"
  faults=$((faults + 1))
}

mapfile -t files < <(find scenarios docs -name '*.toml' | sort)
count=0
for kind in "${kinds[@]}"; do
  of_kind=()
  for file in "${files[@]}"; do
    if [[ $(kind_of "$file") == "$kind" ]]; then of_kind+=("$file"); fi
  done
  count=$((count + ${#of_kind[@]}))
  taplo "$kind" "${of_kind[@]}" || fault "$(cat "$work/log")"
done

# refused <kind> <command> <text>: a misspelt file, in the folder of its kind.
misspelt=0
refused() {
  misspelt=$((misspelt + 1))
  mkdir -p "$work/misspelt/$1"
  local file="$work/misspelt/$1/$misspelt.toml"
  printf '%b' "$3" > "$file"
  touch "$work/misspelt/$1/tracks.csv"
  local code=0
  # shellcheck disable=SC2086  # a command of several words
  (cd "$work/misspelt/$1" && "$lilytank" $2 "$misspelt.toml" > log 2>&1) || code=$?
  ((code == 2)) || fault "the program's exit code is $code for: $3"
}
tank="$PWD/scenarios/chain5.toml"
refused scenario info '[run]\ndurations = "1 h"\n'
refused scenario info '[tank]\nradius = "30 cmm"\n'
refused scenario info '[flow]\ngusts = "per_pont"\n'
refused scenario info '[module]\ncount = 1.5\n'
refused scenario info '[forces.face_drag]\nK_F = 11\n'
refused scenario info '[forces.dampng]\nD_linear = 0.1\n'
refused scenario info '[[command]]\nat = "1 h"\ndo = "pawse"\n'
refused experiment 'recording info' '[[recording]]\nfile = "tracks.csv"\nbody = "lilly"\n'
refused bodies diagnose '[experiment]\nbody = "point"\ndimension = 1\n[[recording]]\nfile = "tracks.csv"\ntime = "t"\nx = "x"\n'
refused bodies diagnose '[experiment]\nbody = "point"\n[baseline]\ngravitty = 9.8\n[[recording]]\nfile = "tracks.csv"\ntime = "t"\nx = "x"\n'
refused study 'study --dry-run' "[study]\\nscenario = \"$tank\"\\nreplicate = 3\\n"
refused optimize 'optimize --dry-run' "[optimize]\\nscenario = \"$tank\"\\nmethod = \"cmaes\"\\n"

# All of a kind at once: Taplo takes seconds to start.
for kind in "${kinds[@]}"; do
  of_kind=("$work/misspelt/$kind"/*.toml)
  ! taplo "$kind" "${of_kind[@]}" || fault "Taplo accepts all misspelt files of kind $kind"
  for file in "${of_kind[@]}"; do
    grep -q "invalid file.*$file" "$work/log" || fault "Taplo accepts: $(cat "$file")"
  done
done

((faults == 0)) && echo "schema: $count shipped files conform, $misspelt misspelt ones are refused by both"
exit $((faults > 0))
