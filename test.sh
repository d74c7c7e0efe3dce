#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds with warnings as errors, and runs every test. With --all
# also the long versions of two of them: an hour of damaged files, and twenty times the faults.
# Ends with the closing line of ctest; the exit code is 0 only if everything passed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source .ci/packages.sh

((EUID == 0)) || slurm_packages=()
need_packages "${build_packages[@]}" "${film_packages[@]}" "${test_packages[@]}" \
              "${slurm_packages[@]}" "${bench_packages[@]}"

run_tests() {  # <tree> [ctest option...]
  ctest --test-dir "$1" --parallel "$(nproc)" --output-on-failure --no-tests=error \
        --no-label-summary "${@:2}"
}

# Assertions on, no renderer, no vectors: other code must give the same golden fingerprints.
configure build-debug -DCMAKE_BUILD_TYPE=Debug -DLILYTANK_SIMD=OFF -DLILYTANK_RENDER=OFF -DLILYTANK_BENCH=OFF \
                      -DLILYTANK_TESTS=ON -DLILYTANK_WERROR=ON
cmake --build build-debug --target unit_tests analytic_tests determinism_tests
run_tests build-debug --exclude-regex '_NOT_BUILT$' --label-exclude '^(tree|slurm|program)$'

configure build -DCMAKE_BUILD_TYPE=Release -DLILYTANK_RENDER=ON -DLILYTANK_BENCH=ON \
                -DLILYTANK_TESTS=ON -DLILYTANK_WERROR=ON
cmake --build build
run_tests build

if [[ ${1:-} == --all ]]; then
  build/tests/fuzz_readers 3600 "$RANDOM"
  bash tests/faults/run.sh build/lilytank 20
fi
