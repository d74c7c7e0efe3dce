# Names that are hostile, and files that are not what they should be.

hostile=($'new\nline' "quo'te" 'dou"ble' '-dash' '--' $'byte\xff' $'esc\x1b[31m' ' blank ' '$(touch pwned)'
         '`touch pwned`' ';touch pwned' '%s%n' '*' '\\' $'tab\there' 'a=b' 'ünïcode')

hostile_inputs() {
  local name dir=$home/names
  for name in "${hostile[@]}"; do
    mkdir "$dir"
    cp "$in/pair.rules" "$in/cross.txt" "$dir"
    cp "$in/tank.toml" "$dir/$name"
    fresh
    (cd "$dir" && "$lily" run --quiet --out "$out/run" -- "$name") > /dev/null 2> "$home/err" ||
      count_wrong "run -- $name" "$(cat "$home/err")"
    same_bytes "run -- $name" run && count_same
    discard
    cp "$in/pairs.toml" "$in/tank.toml" "$dir"
    mv "$dir/tank.toml" "$dir/$name"
    (cd "$dir" && "$lily" synthesize --out "./$name.rules" cross.txt) > /dev/null 2> "$home/err" &&
      cmp -s "$dir/$name.rules" "$home/ref/synthesize/cross.rules" || count_wrong "--out $name" "$(cat "$home/err")"
    (cd "$dir" && "$lily" run --quiet --out "./$name.out" -- "$name" > /dev/null 2> "$home/err")
    [[ $(digest "$dir/$name.out") == "$(digest "$home/ref/run/run")" ]] ||
      count_wrong "run --out $name" "$(cat "$home/err")"
    cd "$dir" || return
    refuses "missing $name" run -- "none $name"
    refuses "a directory $name" run -- "./$name.out"
    refuses "unknown word $name" "verb $name"
    refuses "a value $name" run "./$name" --set "$name=1"
    cd "$home" || return
    [[ ! -e $dir/pwned ]] || count_wrong "$name" "it was run as a command"
    rm -rf "$dir"
  done
}
slurm_script() {  # the sbatch script of a study with a hostile name must run nothing of it
  local name dir=$home/slurm
  for name in "${hostile[@]}" $'x\ntouch pwned' $'x\n#SBATCH --wrap=id'; do
    mkdir -p "$dir/bin"
    cp "$in"/{pairs.toml,tank.toml,pair.rules} "$dir"
    mv "$dir/pairs.toml" "$dir/$name.toml"
    printf '#!/bin/sh\nexit 0\n' > "$dir/bin/srun"
    chmod +x "$dir/bin/srun"
    (cd "$dir" && "$lily" study slurm --out "./$name" -- "./$name.toml") > "$home/script" 2> "$home/err"
    local code=$?
    if ((code != 0)); then
      refusal "study slurm $name" $code "$home/err"
    else
      (cd "$dir" && PATH=$dir/bin:$PATH SLURM_CPUS_PER_TASK=1 bash "$home/script") > /dev/null 2>&1
      if [[ -n $(find "$dir" -name pwned) ]] || grep -q '^#SBATCH --wrap' "$home/script"; then
        count_wrong "study slurm $name" "the name was run as a command"
      else
        count_same
      fi
    fi
    rm -rf "$dir"
  done
}
bystanders() {  # nothing but the named file changes
  fresh
  cp "$in/bar.txt" "$out/cross.rules"
  chmod 600 "$out/cross.rules"
  local file
  for file in cross.rules.tmp cross.rules.part .cross.rules.tmp; do echo mine > "$out/$file"; done
  "$lily" synthesize "$in/cross.txt" --out "$out/cross.rules" --force > /dev/null 2> "$home/err" ||
    count_wrong "beside other files" "$(cat "$home/err")"
  for file in cross.rules.tmp cross.rules.part .cross.rules.tmp; do
    if [[ $(cat "$out/$file" 2> /dev/null) == mine ]]; then count_same; else count_wrong "$file" "it has changed"; fi
  done
  [[ $(stat -c %a "$out/cross.rules") == 600 ]] || count_wrong "a file of mode 600" "$(stat -c %a "$out/cross.rules")"
  cmp -s "$out/cross.rules" "$home/ref/synthesize/cross.rules" || count_wrong "beside other files" "other bytes"
  discard
  fresh
  echo mine > "$out/target"
  ln -s target "$out/cross.rules.tmp"
  c_synthesize "$out" > /dev/null 2>&1
  if [[ $(cat "$out/target") == mine && ! -L $out/cross.rules ]]; then count_same; else count_wrong "a planted link" "it was followed"; fi
  discard
}
pipes() {
  fresh
  "$lily" run "$in/bare.toml" --quiet --out "$out/a" > /dev/null 2>&1
  "$lily" run /dev/stdin --quiet --out "$out/b" > /dev/null 2> "$home/err" < <(cat "$in/bare.toml")
  local code=$?
  if ((code == 0)); then
    if [[ $(digest "$out/a") == "$(digest "$out/b")" ]]; then count_same; else count_wrong "a scenario by a pipe" "other bytes"; fi
  else
    refusal "a scenario by a pipe" $code "$home/err"
  fi
  discard
  fresh
  "$lily" recording convert <(cat "$in/tracks.csv") --out "$out/tracks.csv" > /dev/null 2> "$home/err"
  code=$?
  if ((code == 0)); then same_bytes "a recording by a pipe" convert && count_same; else refusal "a recording by a pipe" $code "$home/err"; fi
  discard
  fresh
  "$lily" synthesize <(cat "$in/cross.txt") --out "$out/cross.rules" > /dev/null 2> "$home/err"
  code=$?
  if ((code == 0)); then same_bytes "a drawing by a pipe" synthesize && count_same; else refusal "a drawing by a pipe" $code "$home/err"; fi
  discard
}

# Every input that a verb names, as a file at $1.
each_input() {  # <refuses or survives> <what> <file>
  "$1" "$2: run" run "$3" --dry-run --out "$home/none"
  "$1" "$2: info" info "$3"
  "$1" "$2: study" study "$3" --dry-run --out "$home/none"
  "$1" "$2: optimize" optimize "$3" --dry-run --out "$home/none"
  "$1" "$2: synthesize" synthesize "$3" --out "$home/none.rules"
  "$1" "$2: check" check "$3" --lattice 0
  "$1" "$2: calibrate" calibrate "$3" --out "$home/none"
  "$1" "$2: diagnose" diagnose "$3" --out "$home/none"
  "$1" "$2: flow" flow "$3" --out "$home/none"
  "$1" "$2: recording" recording check "$3"
  "$1" "$2: analyze" analyze "$3" --out "$home/none"
  "$1" "$2: render" render "$3" --svg "$home/none.svg"
  "$1" "$2: rates" check "$in/pair.rules" --lattice 0 --rates "$3" --out "$home/none"
  "$1" "$2: flow.file" run "$in/tank.toml" --set flow.file="$3" --dry-run --out "$home/none"
  "$1" "$2: start.file" run "$in/tank.toml" --set start.file="$3" --dry-run --out "$home/none"
  "$1" "$2: ruleset.file" run "$in/tank.toml" --set ruleset.file="$3" --dry-run --out "$home/none"
  rm -rf "$home/none" "$home/none.rules" "$home/none.svg"
}
odd_files() {
  mkdir "$home/folder"
  : > "$home/empty"
  head -c 3000 /dev/urandom > "$home/noise"
  printf '\xff\xfe\x00\x1b[2J\n' > "$home/control"
  printf '"\\u001b[2J\\u0007" = 1\n' > "$home/escapes.toml"
  ln -s loop "$home/loop"
  ln -s nothing "$home/dangling"
  printf 'secret\n' > "$home/unreadable"
  chmod 000 "$home/unreadable"
  local what
  if row "a directory where a file is expected"; then
    each_input refuses "a directory" "$home/folder"
    refuses "a directory: synthesize --out" synthesize "$in/cross.txt" --out "$home/folder"
    for what in run study optimize; do
      refuses "a file: --out of $what" $what "$in/$(echo $what | sed 's/run/tank/; s/study/pairs/; s/optimize/best/').toml" \
              --out "$home/empty"
    done
  fi
  if row "empty files"; then each_input survives empty "$home/empty"; fi
  if row "noise and control characters"; then
    for what in noise control escapes.toml; do each_input survives $what "$home/$what"; done
  fi
  if row "links to nowhere"; then
    for what in loop dangling; do each_input refuses $what "$home/$what"; done
  fi
  if row "unreadable files"; then
    if ((${#nobody[@]})); then
      by=("${nobody[@]}")
      each_input refuses unreadable "$home/unreadable"
      by=()
    else
      skip_row "no other user can run the program"
    fi
  fi
}

name_rows() {
  if row "hostile names"; then hostile_inputs; fi
  if row "hostile names in sbatch scripts"; then slurm_script; fi
  if row "files beside the output"; then bystanders; fi
  if row "pipes as inputs"; then pipes; fi
  odd_files
}
