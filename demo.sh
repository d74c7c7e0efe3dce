#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds, lets 15 Lilies build chains of five, and leaves a
# film, an interactive page, a plot of the yield and a summary in out/demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source .ci/packages.sh

out=out/demo

need_packages "${build_packages[@]}"
need_packages "${film_packages[@]}" &  # beside the build, which does without them
film_packages_ready=$!

# A tree that test.sh has configured is used as it is.
options=()
[[ -f build/CMakeCache.txt ]] || options=(-DLILYTANK_TESTS=OFF -DLILYTANK_BENCH=OFF)
configure build -DCMAKE_BUILD_TYPE=Release "${options[@]}"
cmake --build build --target lilytank
wait "$film_packages_ready"

build/lilytank run scenarios/demo.toml --out "$out" --force --video
build/lilytank view "$out" --force --quiet > /dev/null
echo "In $out: video.mp4, view.html (for a browser), yield.png, summary.txt, and the run's data"
