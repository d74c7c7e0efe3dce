#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds with warnings as errors, and runs the tests. With --all
# also the long ones: statistics on more worlds and steps (suites Long..., each with a shorter sibling that
# always runs), every test of the libraries with assertions on, an hour of damaged files, twenty times the
# faults.
# Ends with the closing line of ctest; the exit code is 0 only if everything passed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source .ci/packages.sh

all=
case ${1:-} in
  '') ;;
  --all) all=yes ;;
  *) echo "usage: ./test.sh [--all]" >&2; exit 2 ;;
esac

((EUID == 0)) || slurm_packages=()
need_packages "${build_packages[@]}" libgtest-dev
{  # beside the first build, which does without them
  need_packages "${film_packages[@]}" "${test_packages[@]}" "${slurm_packages[@]}" "${bench_packages[@]}"
  need_packages "${python_packages[@]}" "${table_packages[@]}" || true  # the next steps say what that means
} &
other_packages_ready=$!

run_tests() {  # <tree> [ctest option...]
  # One more than cores: some tests mostly wait.
  ctest --test-dir "$1" --parallel "$(($(nproc) + 1))" --output-on-failure --no-tests=error \
        --no-label-summary "${@:2}"
}

# Assertions on, no renderer, no vectors: other code must give the same golden fingerprints.
configure build-debug -DCMAKE_BUILD_TYPE=Debug -DLILYTANK_SIMD=OFF -DLILYTANK_RENDER=OFF -DLILYTANK_BENCH=OFF \
                      -DLILYTANK_TESTS=ON -DLILYTANK_WERROR=ON
cmake --build build-debug --target core_tests determinism_tests ${all:+unit_tests analytic_tests}
run_tests build-debug --exclude-regex '_NOT_BUILT' --label-exclude '^(tree|slurm|program)$'

wait "$other_packages_ready"
python=(-DLILYTANK_PYTHON=OFF)
if need_packages "${python_packages[@]}"; then
  python=(-DLILYTANK_PYTHON=ON "-DPython_EXECUTABLE=$(PATH=/usr/bin:$PATH command -v python3)")
else
  echo "The Python package is not tested."
fi
need_packages "${table_packages[@]}" || echo "Conversions to pandas and xarray are not tested."

configure build -DCMAKE_BUILD_TYPE=Release -DLILYTANK_RENDER=ON -DLILYTANK_BENCH=ON \
                -DLILYTANK_TESTS=ON -DLILYTANK_WERROR=ON "${python[@]}"
cmake --build build
if [[ $all ]]; then
  run_tests build
  build/tests/fuzz_readers 3600 "$RANDOM"
  bash tests/faults/run.sh build/lilytank 20
else
  run_tests build --label-exclude '^long$'
fi
