#!/usr/bin/env bash
# Checks that the page of each verb names every option that the program has.
#   options.sh LILYTANK
set -euo pipefail
lilytank=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
faults=0

# page <page> <verb...>
page() {
  local verb option
  for verb in "${@:2}"; do
    # shellcheck disable=SC2086  # "recording check" is two words
    for option in $("$lilytank" $verb --help | grep -oE '^ +(-[a-z], )?--[a-z-]+' | grep -oE '\-\-[a-z-]+'); do
      [[ $option == --help || $option == --quiet ]] && continue
      grep -qF -e "\`$option" "$1" && continue
      echo "$1: '$option' of lilytank $verb is missing"
      faults=$((faults + 1))
    done
  done
}

page scenarios/README.md run study
page docs/recordings.md 'recording info' 'recording check' 'recording convert'
page docs/analysis.md analyze
page docs/flow.md flow
page docs/calibration.md calibrate
page docs/diagnosis.md diagnose
page docs/validation.md prove
page docs/optimization.md optimize
page docs/synthesis.md synthesize check
page docs/rendering.md render
((faults == 0)) && echo "options: every page names all options of its verb"
exit $((faults > 0))
