#!/usr/bin/env bash
# Fuzzes readers by libFuzzer, which follows what an input covers. Needs clang with its compiler-rt
# (Debian: clang, libclang-rt-14-dev) and a Ninja build of fuzz_readers, whose sources and libraries it takes.
#
# usage: libfuzzer.sh BUILD SECONDS READER...     corpora and findings are kept in BUILD/libfuzzer
set -euo pipefail
build=$(realpath "$1")
seconds=$2
shift 2
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
place=$build/libfuzzer
mkdir -p "$place/objects"

mapfile -t sources < <(ninja -C "$build" -t query tests/fuzz_readers |
                       sed -nE 's|^ *tests/CMakeFiles/fuzz_readers.dir/(.*)\.o$|\1|p' |
                       sed -E "s|^__/|$root/|; s|^fuzz/|$root/tests/fuzz/|; s|/main\.cpp$|/libfuzzer.cpp|")
export flags="-std=c++20 -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
  -I$root/src -I$root/tests -I$root/include -isystem /usr/include/eigen3 -DEIGEN_NO_CPUID"
for source in "${sources[@]}"; do
  object=$place/objects/$(sed "s|^$root/||; s|/|_|g" <<< "$source").o
  [[ $object -nt $source ]] || echo "$source $object"
done | xargs -r -P "$(nproc)" -L 1 bash -c 'clang++ $flags -c "$0" -o "$1"'
clang++ -fsanitize=fuzzer,address,undefined -o "$place/readers" "$place"/objects/*.o \
  "$build"/liblilytank_{diagnose,calibrate,study,search,io,core}.a -ltomlplusplus -lhwy -lcrypto -lz

for reader in "$@"; do
  echo "== $reader"
  mkdir -p "$place/$reader"
  LILYTANK_READER=$reader LILYTANK_CORPUS=$place/$reader "$place/readers" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2000 \
    -detect_leaks=0 -verbosity=0 -print_final_stats=1 -artifact_prefix="$place/$reader-" "$place/$reader" 2>&1 |
    tail -n 25
done
