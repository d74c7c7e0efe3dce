# Kills, races, flipped bytes.

killed() {  # <signal> <seconds> <command>: ends the command by the signal after some time
  fresh
  by=(exec)  # so that the process has the program's number
  c_"$3" "$out" > /dev/null 2> "$home/err" &
  local pid=$!
  by=()
  sleep "$2"
  kill "-$1" "$pid" 2> /dev/null
  wait "$pid" 2> /dev/null
  again "$1 after $2 s $3" "$3" && count_same
  discard
}
some_time() { printf '0.%03d' $((RANDOM % 400)); }

race() {  # <command> <command>: two at once on one core, in one directory; the second may be another
  local codes=(0 0) k
  fresh
  (exec_on_core "c_$1" "$out") > /dev/null 2> "$home/err0" &
  local first=$!
  (exec_on_core "c_$2" "$out") > /dev/null 2> "$home/err1" &
  local second=$!
  wait $first; codes[0]=$?
  wait $second; codes[1]=$?
  for k in 0 1; do
    ((codes[k] == 0)) || refusal "race of $1 and $2" "${codes[k]}" "$home/err$k"
  done
  if [[ $1 == synthesize ]]; then  # one of the two, whole
    if [[ $(digest "$out") == "$(digest "$home/ref/$2")" ]]; then
      count_same
    else
      same_bytes "race of $1 and $2" "$1" && count_same
    fi
  elif [[ $1 == "$2" ]]; then
    again "race of $1 and $2" "$1" && count_same
  elif c_"$1" "$out" > /dev/null 2>&1; then
    same_bytes "race of $1 and $2" "$1" && count_same
  elif c_"$2" "$out" > /dev/null 2>&1; then
    same_bytes "race of $1 and $2" "$2" && count_same
  else
    count_wrong "race of $1 and $2" "both are refused for good"
  fi
  discard
}
exec_on_core() { taskset -cp "$core" "$BASHPID" > /dev/null 2>&1; "$@"; }
flip() {  # <file>: one random bit; <offset> instead of a random place
  local size offset byte
  size=$(stat -c %s "$1")
  ((size > 0)) || return 1
  offset=${2:-$(((RANDOM * 32768 + RANDOM) % size))}
  byte=$(od -An -tu1 -j "$offset" -N 1 "$1")
  printf "$(printf '\\x%02x' $((byte ^ (1 << RANDOM % 8))))" |
    dd of="$1" bs=1 seek="$offset" conv=notrunc status=none
  flipped="${1##*/} at $offset"
}
flipped_run() {  # <file of a run>: reads it with everything that reads runs
  local name code
  fresh
  mv "$in/done" "$home/whole"  # captions name what was read: the damaged copy takes its place
  cp -r "$home/whole" "$in/done"
  if flip "$in/done/$1"; then
    for name in "${readers[@]}"; do
      rm -rf "${out:?}"/*
      code=0
      c_$name "$out" > /dev/null 2> "$home/err" || code=$?
      if ((code == 0)); then
        same_bytes "$flipped, $name" "$name" && count_same
      else
        refusal "$flipped, $name" $code "$home/err"
      fi
    done
  fi
  rm -rf "$in/done"
  mv "$home/whole" "$in/done"
  discard
}
flipped_again() {  # <command> <file>: the command again on its damaged results
  fresh
  cp -r "$home/ref/$1/." "$out"
  if flip "$out/$2"; then
    c_"$1" "$out" > /dev/null 2> "$home/err"
    local code=$?
    if ((code == 0)); then
      same_bytes "$flipped, $1 again" "$1" && count_same
    else
      refusal "$flipped, $1 again" $code "$home/err"
    fi
  fi
  discard
}

interruption_rows() {
  local i name file core
  core=$(taskset -cp $$ | sed 's/.*: *\([0-9]*\).*/\1/')
  if row "kill -9 at random moments"; then
    for ((i = 0; i < 2 * repeats; i++)); do
      for name in "${writers[@]}"; do killed KILL "$(some_time)" "$name"; done
    done
  fi
  if row "TERM at random moments"; then
    for ((i = 0; i < repeats; i++)); do
      for name in run study optimize; do killed TERM "$(some_time)" "$name"; done
    done
  fi
  if row "two processes, one directory"; then
    for ((i = 0; i < 2 * repeats; i++)); do
      race run run; race study study; race study others; race optimize optimize
    done
    for ((i = 0; i < 10 * repeats; i++)); do race synthesize bar; done
  fi
  if row "flipped bytes, readers of a run"; then
    for ((i = 0; i < repeats; i++)); do
      for file in trajectory.bin events.csv metrics.csv resolved.toml checkpoint.bin summary.json \
                  ruleset.rules; do
        flipped_run "$file"
      done
    done
  fi
  if row "flipped bytes, the same command again"; then
    for ((i = 0; i < repeats; i++)); do
      for file in trajectory.bin events.csv metrics.csv resolved.toml checkpoint.bin; do
        flipped_again run "run/$file"
      done
      for file in rows-0001.csv study.toml table.csv summary.csv; do
        flipped_again study "study/$file"
      done
      for file in search.state evaluations.csv history.csv optimum.toml; do
        flipped_again optimize "best/$file"
      done
    done
  fi
}
