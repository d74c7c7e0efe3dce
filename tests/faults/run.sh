#!/usr/bin/env bash
# Injects faults into the program and prints a table: the same bytes as without the fault, a refusal
# of one line, or wrong. After every fault the same command is given again without it and must end in
# the same bytes. Exit code 1 if any outcome is wrong.
#
# usage: run.sh PROGRAM [REPEATS [ROW]]     REPEATS: times that random faults are tried (1)
#                                           ROW: only rows whose name holds this text
set -uo pipefail
program=$(realpath "$1")
repeats=${2:-1}
only=${3:-}
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
export LC_ALL=C
ulimit -c 0
RANDOM=1

home=$(mktemp -d)
chmod 755 "$home"
mounts=()
clean_up() {
  local children
  children=$(jobs -p)
  [[ -z $children ]] || kill -9 $children 2> /dev/null
  for place in "${mounts[@]}"; do umount "$place" 2> /dev/null; done
  chmod -R u+rwX "$home" 2> /dev/null
  rm -rf "$home"
}
trap clean_up EXIT
mkdir "$home/bin"
cp "$program" "$home/bin/lilytank"  # where any user may run it
lily=$home/bin/lilytank
in=$home/in
export TMPDIR=$home

# ---- the table

rows=()
declare -A same=() refused=() wrong=() skipped=()
row() {  # <name>: begins a row; false where it is not wanted
  [[ $1 == *"$only"* ]] || return 1
  row=$1
  rows+=("$row")
  same[$row]=0 refused[$row]=0 wrong[$row]=0
}
count_same() { same[$row]=$((${same[$row]} + 1)); }
count_refused() { refused[$row]=$((${refused[$row]} + 1)); }
count_wrong() {  # <what was tried> <what is wrong>
  wrong[$row]=$((${wrong[$row]} + 1))
  printf 'wrong: %s: %s: %s\n' "$row" "$1" "$2" | cat -v >&2
}
skip_row() { skipped[$row]=$1; }

# ---- what is run; each writes into the directory $1. "${by[@]}" goes before the program.

by=()
c_run() { "${by[@]}" "$lily" run "$in/tank.toml" --quiet --out "$1/run"; }
c_study() { "${by[@]}" "$lily" study "$in/pairs.toml" --quiet --threads 2 --out "$1/study"; }
c_optimize() { "${by[@]}" "$lily" optimize "$in/best.toml" --quiet --threads 2 --out "$1/best"; }
c_others() { "${by[@]}" "$lily" study "$in/others.toml" --quiet --threads 2 --out "$1/study"; }
c_bar() { "${by[@]}" "$lily" synthesize "$in/bar.txt" --out "$1/cross.rules"; }
c_synthesize() { "${by[@]}" "$lily" synthesize "$in/cross.txt" --out "$1/cross.rules"; }
c_convert() { "${by[@]}" "$lily" recording convert "$in/tracks.csv" --out "$1/tracks.csv"; }
c_film() { "${by[@]}" "$lily" recording convert "$in/done" --out "$1/film.csv"; }
c_rates() { "${by[@]}" "$lily" check "$in/pair.rules" --lattice 0 --rates "$in/done" --gillespie 10 --out "$1/check"; }
c_draw() { "${by[@]}" "$lily" render "$in/done" --svg "$1/frame.svg"; }
writers=(run study optimize synthesize convert)
readers=(film rates)

digest() {  # <directory>: names and bytes of all files; rows of a study in any order, in any file
  (cd "$1" 2> /dev/null || exit
   find . -type f ! -name 'rows-*.csv' -print0 | sort -z | xargs -0r sha256sum
   find . -type f -name 'rows-*.csv' -print0 | xargs -0r cat | sort -u | sha256sum)
}
one_line() {  # <file>: whether it holds one printable line
  (($(wc -l < "$1") == 1)) && [[ -n $(tr -d ' \n' < "$1") ]] && ! grep -qP '[\x00-\x08\x0b-\x1f\x7f]' "$1"
}
fresh() { out=$(mktemp -d "$home/out.XXXXXX"); chmod 777 "$out"; }
discard() { chmod -R u+rwX "$out"; rm -rf "$out"; }

refusal() {  # <tried> <code> <stderr>: counts a refusal, or something wrong
  if (($2 != 2)); then
    count_wrong "$1" "exit code $2, $(head -c 300 "$3")"
  elif ! one_line "$3"; then
    count_wrong "$1" "not one printable line: $(head -c 300 "$3")"
  else
    count_refused
  fi
}
same_bytes() {  # <tried> <reference>
  if [[ $(digest "$out") == "$(digest "$home/ref/$2")" ]]; then return 0; fi
  count_wrong "$1" "other bytes: $(diff <(digest "$out") <(digest "$home/ref/$2") | awk 'NF > 2 {print $3}' | sort -u | head -4 | tr '\n' ' ')"
  return 1
}
again() {  # <tried> <command>: the same command without the fault
  c_"$2" "$out" > /dev/null 2> "$home/err"
  local code=$?
  if ((code != 0)); then
    count_wrong "$1, then again" "exit code $code, $(head -c 300 "$home/err")"
    return 1
  fi
  same_bytes "$1, then again" "$2"
}
attempt() {  # <tried> <fault: a function that runs the rest> <command>
  fresh
  ("$2" c_"$3" "$out") > /dev/null 2> "$home/err"
  local code=$?
  if ((code == 0)); then
    same_bytes "$1 $3" "$3" && count_same
  else
    refusal "$1 $3" "$code" "$home/err"
    again "$1 $3" "$3"
  fi
  discard
}
refuses() {  # <tried> <argument...>: must be refused
  "${by[@]}" "$lily" "${@:2}" > /dev/null 2> "$home/err" < /dev/null
  refusal "$1" $? "$home/err"
}
survives() {  # <tried> <argument...>: done or refused
  "${by[@]}" "$lily" "${@:2}" > /dev/null 2> "$home/err" < /dev/null
  local code=$?
  if ((code == 0)); then count_same; else refusal "$1" $code "$home/err"; fi
}

# ---- inputs and references

source "$here/inputs.sh"
make_inputs
for name in "${writers[@]}" others bar "${readers[@]}" draw; do
  mkdir -p "$home/ref/$name"
  if ! c_$name "$home/ref/$name" > /dev/null 2> "$home/err"; then
    [[ $name == draw ]] && continue  # built without the renderer
    echo "the command '$name' fails without any fault: $(cat "$home/err")" >&2
    exit 1
  fi
  [[ $name != draw ]] || readers+=(draw)
done
inputs_before=$(digest "$in")
nobody=()
if ((EUID != 0)); then
  nobody=(env)
elif command -v setpriv > /dev/null && setpriv --reuid=65534 --regid=65534 --clear-groups \
     "$lily" --version > /dev/null 2>&1; then
  nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
fi

source "$here/interruptions.sh"
source "$here/surroundings.sh"
source "$here/names.sh"
source "$here/overwriting.sh"
begin=$SECONDS
interruption_rows
surrounding_rows
name_rows
overwriting_rows
if row "inputs afterwards"; then
  if [[ $(digest "$in") == "$inputs_before" ]]; then count_same; else count_wrong inputs "they have changed"; fi
fi

bad=0
printf '%-44s %10s %8s %6s\n' fault 'same bytes' refused wrong
for row in "${rows[@]}"; do
  if [[ -n ${skipped[$row]:-} ]]; then
    printf '%-44s skipped: %s\n' "$row" "${skipped[$row]}"
    continue
  fi
  printf '%-44s %10d %8d %6d\n' "$row" "${same[$row]}" "${refused[$row]}" "${wrong[$row]}"
  bad=$((bad + ${wrong[$row]}))
done
echo "$bad wrong, $((SECONDS - begin)) s"
((bad == 0))
