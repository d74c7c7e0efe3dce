#!/usr/bin/env bash
# Runs the commands of the documentation and of the verbs' --help (those of minutes with --dry-run): every line of
# a fenced block that begins with lilytank, in the order of its page, beside a copy of the scenarios. Runs are cut
# to five minutes of simulated time and pictures are small. A command that takes longer than seconds() is
# interrupted, and must then stop as Ctrl-C stops it (exit code 3). A command that reads the results of an
# interrupted or skipped one is skipped.
#   run.sh LILYTANK SOURCES
set -euo pipefail
lilytank=$(realpath "$1") sources=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$lilytank" "$work/bin/lilytank"
PATH=$work/bin:$PATH
done=0 cut=0 skipped=0 faults=0

# commands <page>: one a line, continued lines joined, comments and build/ gone.
commands() {
  perl -0777 -ne '
    while (/^```\w*\n(.*?)^```/gms) {
      my $block = $1;
      $block =~ s/ *\\\n */ /g;
      for (split /\n/, $block) {
        s/\s+#.*//;
        print "$_\n" if s{^(?:build/)?lilytank (?=[a-z])}{lilytank } && !/^lilytank ruleset/;
      }
    }' "$1"
}

# shortened <command>: placeholders filled in, and options that make it short.
shortened() {
  local line=$1
  [[ $line != *calibrate* && $line != *diagnose* ]] || line=${line//EXPERIMENT.toml/scenarios/experiments/tour.toml}
  line=${line//EXPERIMENT.toml/scenarios/experiments/tank.toml}
  line=${line// experiment.toml/ scenarios/experiments/tank.toml}
  line=${line//diagnose-NAME/diagnose-tour}
  line=${line//GRID.csv/out/flow-tank/flow_smooth.csv}
  line=${line//SECOND.toml/scenarios/experiments/tour.toml}
  line=${line//FIRST.toml/scenarios/experiments/tour.toml}
  line=${line//FILE.../scenarios/experiments/lily_1.csv.gz}
  line=${line// balls.csv.gz/ scenarios/experiments/balls_1.csv.gz}
  line=${line//\/usr\/share\/lilytank\//}
  line=${line//other.rules/scenarios/rulesets/chain5.rules}
  case $line in
    'lilytank run '*) line+=" --set run.duration='305 s' --quiet" ;;
    'lilytank render '*) line="${line/--at 340/--at 300} --size 120 --fps 1 --quiet" ;;
    'lilytank study slurm '*) ;;
    'lilytank prove --grid '*) line+=' --worlds 1 --cells balls=20s --cells lilies=20s --cells modules=5 --quiet' ;;
    'lilytank prove --'*) line+=' --worlds 2 --minutes 0.4 --known-flow --budget 1 --quiet' ;;
    'lilytank check '*--measure*) line+=' --worlds 1 --quiet' ;;
    'lilytank diagnose '*--tank*) line+=' --tank-results out/first --force --quiet' ;;
    'lilytank calibrate '* | 'lilytank diagnose '*) line+=' --force --quiet' ;;
    'lilytank analyze '*) line+=' --resamples 20 --longest-lag 2' ;;
  esac
  printf '%s' "$line"
}

# seconds <command>: after which it is interrupted. Jobs of minutes or hours are, in any case.
seconds() {
  [[ $1 =~ (^lilytank\ (calibrate|diagnose|optimize|prove|study)\ )|--bias && $1 != *--dry-run* ]] && echo 1 || echo 6
}

# outputs <command>: what it writes below out/: its --out, --png, --csv, ...; else the directory of its verb.
outputs() {
  local named
  named=$(grep -oE -- '--(out|csv|png|svg|mp4|gif|stills|figure|all)[ =]out/[^ ]+' <<< "$1" | grep -oE 'out/.*' || true)
  if [[ -n $named || $1 == *' --out '* ]]; then
    printf '%s\n' "$named"
    return
  fi
  case $1 in
    'lilytank calibrate '*) echo out/calibrate-tank out/calibrate-tour ;;
    'lilytank diagnose '*) echo out/diagnose-tank out/diagnose-tour ;;
    'lilytank flow '*) echo out/flow-tank ;;
    'lilytank optimize '* | 'lilytank study '*) grep -oE '[A-Za-z0-9_]+\.toml' <<< "$1" | sed 's/\.toml$//; s|^|out/|' ;;
    'lilytank run '*) grep -oE '[A-Za-z0-9_]+\.toml' <<< "$1" | sed -E 's|(.*)\.toml$|out/\1-seed1|' ;;
  esac
}

# inputs <command>: what it reads below out/.
inputs() {
  sed -E 's/--(out|csv|png|svg|mp4|gif|stills|figure|all)[ =]out\/[^ ]+//g' <<< "$1" | grep -oE '(^|[ =])out/[^ ]+' |
    tr -d ' =' || true
}

# depends <path>: it is, or is within, an output that an interrupted or skipped command owes.
depends() {
  local one
  for one in $owed; do [[ $1 == "$one" || $1 == "$one"/* ]] && return; done
  return 1
}

page() {
  local line code file owed=
  rm -rf "$work/page"
  mkdir "$work/page"
  cp -r "$sources/scenarios" "$work/page/scenarios"
  cd "$work/page"
  while IFS= read -r line; do
    line=$(shortened "$line")
    for file in $(inputs "$line"); do
      depends "$file" || continue
      skipped=$((skipped + 1)) owed+=" $(outputs "$line" | tr '\n' ' ')"
      continue 2
    done
    code=0
    timeout --preserve-status -s INT -k 200 "$(seconds "$line")" bash -c "exec $line" \
      < /dev/null > "$work/output" 2>&1 || code=$?
    case $code in
      0) done=$((done + 1)) ;;
      3 | 130) cut=$((cut + 1)) owed+=" $(outputs "$line" | tr '\n' ' ')" ;;  # 130: a short command stops at once
      *)
        faults=$((faults + 1))
        printf '%s: exit code %s\n  %s\n' "${1#"$sources"/}" "$code" "$line"
        tail -n 3 "$work/output" | sed 's/^/    /'
        ;;
    esac
  done < <(commands "$1")
}

# examples: those of all verbs as a page; what a shell redirects or pipes is left to it.
examples() {
  local verb
  echo '```'
  for verb in $("$lilytank" help | sed -nE 's/^  ([a-z]+) .*/\1/p' | grep -vx help); do
    "$lilytank" "$verb" --help | sed -n '/^Examples:$/,$s/^  lilytank /lilytank /p'
  done | sed -E '/^lilytank (study|optimize|calibrate|diagnose|prove) scen/s/( --dry-run)?$/ --dry-run/; s/ --open$//; s/ [>|] .*//'
  echo '```'
}
examples > "$work/help.md"

for one in "$work/help.md" "$sources"/README.md "$sources"/scenarios/README.md "$sources"/docs/*.md; do page "$one"; done
echo "commands of the documentation: $done ran, $cut were interrupted, $skipped need their results, $faults failed"
exit $((faults > 0))
