# Disks, streams, locales, limits.

small_disk() {  # <KiB>: mounts a disk of that size at $out, where this process may
  ((EUID == 0)) && mount -t tmpfs -o "size=${1}k" lilytank-faults "$out" 2> /dev/null || return 1
  mounts+=("$out")
}
full_disk() {  # <KiB> <command>
  fresh
  if ! small_disk "$1"; then
    skip_row "only root can mount a small disk"
    discard
    return
  fi
  c_"$2" "$out" > /dev/null 2> "$home/err"
  local code=$?
  if ((code == 0)); then
    same_bytes "$1 KiB, $2" "$2" && count_same
  else
    refusal "$1 KiB, $2" $code "$home/err"
    mount -o remount,size=64m "$out"
    again "$1 KiB, $2" "$2"
  fi
  umount "$out"
  unset "mounts[-1]"
  discard
}
read_only() {  # <command>
  fresh
  chmod 555 "$out"
  by=("${nobody[@]}")
  c_"$1" "$out" > /dev/null 2> "$home/err"
  refusal "read-only, $1" $? "$home/err"
  by=()
  chmod 777 "$out"
  [[ -z $(ls -A "$out") ]] || count_wrong "read-only, $1" "something was written"
  again "read-only, $1" "$1"
  discard
}

# Faults: each runs the rest of its words.
out_closed() { "$@" >&-; }
err_closed() { "$@" 2>&-; }
in_closed() { "$@" <&-; }
all_closed() { "$@" <&- >&- 2>&-; }
out_err_closed() { "$@" >&- 2>&-; }
german() { LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 "$@"; }
absent_locale() { LC_ALL=xx_XX.nothing "$@"; }
turkish() { LC_ALL=tr_TR.UTF-8 LANGUAGE=tr TZ=Asia/Kathmandu "$@"; }
no_environment() { by=(env -i); "$@"; }
memory() { ulimit -v "$limit"; "$@"; }
open_files() { ulimit -n "$limit"; "$@"; }
file_size() { ulimit -f "$limit"; "$@"; }
threads() { by=(exec "${nobody[@]}"); ulimit -u "$limit"; "$@"; }

closed_streams() {  # <fault> <command>: with standard error closed nobody sees a refusal
  fresh
  ("$1" c_"$2" "$out") > /dev/null 2> "$home/err"
  local code=$?
  if ((code == 0)); then
    same_bytes "$1 $2" "$2" && count_same
  elif ((code != 2)); then
    count_wrong "$1 $2" "exit code $code"
  else
    count_refused
    again "$1 $2" "$2"
  fi
  discard
}
limited() {  # <fault> <limit> <command>: where the loader fails, this program has not begun
  limit=$2
  fresh
  ("$1" c_"$3" "$out") > /dev/null 2> "$home/err"
  local code=$?
  if ((code == 0)); then
    same_bytes "$1 $2 $3" "$3" && count_same
  elif ((code != 127)) && ! grep -q -e 'loading shared libraries' -e 'cannot fork' -e 'fork: ' "$home/err"; then
    refusal "$1 $2 $3" $code "$home/err"
    again "$1 $2 $3" "$3"
  fi
  discard
}
processor_time() {  # ended by the system after a second: then the command goes on
  fresh
  local job=(run "$in/tank.toml" --quiet --set run.duration=8000 --set output.rate=0.1)
  (ulimit -t 1; exec "$lily" "${job[@]}" --out "$out/run") > /dev/null 2>&1
  "$lily" "${job[@]}" --out "$out/run" > /dev/null 2> "$home/err" ||
    count_wrong "ulimit -t" "$(cat "$home/err")"
  "$lily" "${job[@]}" --out "$out/whole" > /dev/null 2>&1
  if [[ $(digest "$out/whole") == "$(digest "$out/run")" ]]; then
    count_same
  else
    count_wrong "ulimit -t" "other bytes"
  fi
  discard
}
device_full() {  # a node of our own: a file moved over /dev/full would stay there
  local device=$home/full
  if ! { mknod "$device" c 1 7 && head -c 1 "$device"; } > /dev/null 2>&1; then device=/dev/full; fi
  local words
  for words in "info $in/tank.toml" forces help "check $in/pair.rules --lattice 0" \
               "run $in/tank.toml --dry-run --out $home/none"; do
    "$lily" $words > "$device" 2> "$home/err"
    refusal "$words to a full device" $? "$home/err"
  done
  [[ $device != /dev/full || $EUID != 0 ]] || return
  refuses "synthesize --out FULL" synthesize "$in/cross.txt" --out "$device"
  refuses "convert --out FULL" recording convert "$in/tracks.csv" --out "$device"
  [[ -c $device ]] || count_wrong "output to a full device" "the device is gone"
}

surrounding_rows() {
  local size name fault
  if row "full disk"; then
    for size in 8 40 $((repeats > 1 ? 120 : 40)); do
      for name in "${writers[@]}"; do full_disk "$size" "$name"; done
    done
  fi
  if row "limited size of files (ulimit -f)"; then
    for size in 1 4; do
      for name in "${writers[@]}"; do limited file_size "$size" "$name"; done
    done
  fi
  if row "read-only directory"; then
    if ((${#nobody[@]})); then
      for name in "${writers[@]}"; do read_only "$name"; done
    else
      skip_row "no other user can run the program"
    fi
  fi
  if row "closed standard streams"; then
    for fault in out_closed err_closed in_closed out_err_closed all_closed; do
      for name in "${writers[@]}"; do closed_streams "$fault" "$name"; done
    done
  fi
  if row "other locales and time zones"; then
    for fault in german absent_locale turkish no_environment; do
      for name in run synthesize convert "${readers[@]}"; do attempt "$fault" "$fault" "$name"; done
    done
  fi
  if row "limited memory (ulimit -v)"; then
    for size in 20000 40000 80000 200000; do
      for name in run study convert synthesize; do limited memory "$size" "$name"; done
    done
  fi
  if row "limited threads (ulimit -u)"; then
    if ((${#nobody[@]})); then
      for name in study optimize; do
        limited threads 1 "$name"; limited threads 2 "$name"
      done
    else
      skip_row "no other user can run the program"
    fi
  fi
  if row "few open files (ulimit -n)"; then
    for size in 3 4 5 6 7 8; do
      for name in run study convert; do limited open_files "$size" "$name"; done
    done
  fi
  if row "limited processor time (ulimit -t)"; then processor_time; fi
  if row "output to a full device"; then device_full; fi
}
