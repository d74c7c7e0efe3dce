#!/usr/bin/env bash
set -euo pipefail
cmake -S . -B build -G Ninja ${CMAKE_ARGS} -DCMAKE_BUILD_TYPE=Release -DLILYTANK_TESTS=OFF -DLILYTANK_BENCH=OFF \
  -DLILYTANK_PYTHON=ON -DPython_EXECUTABLE="$PYTHON" -DLILYTANK_PYTHON_DIR="$SP_DIR" \
  -DRANDOM123_INCLUDE_DIR="$SRC_DIR/random123/include"
cmake --build build
cmake --install build
