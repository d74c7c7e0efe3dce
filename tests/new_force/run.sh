#!/usr/bin/env bash
# new_force/run.sh SOURCE [COMPILER [GENERATOR]]: follows "Adding a force" of docs/structure.md in a copy of the
# tree. The simulator, the calibration and the diagnosis of that copy must know the force.
set -euo pipefail
source=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cp -r "$source"/{CMakeLists.txt,cmake,include,src,scenarios} "$tree"
cp "$source/tests/new_force/spring_to_middle.cpp" "$tree/src/forces"
cp "$source/tests/new_force/catalogue.cpp" "$tree"
sed -i 's/^const ForceTerm& empirical_force();/&\nconst ForceTerm\& spring_to_middle();/' "$tree/src/forces/library.hpp"
# At the end of the list, whichever term is last.
sed -i 's/()};$/(), \&spring_to_middle()};/' "$tree/src/forces/library.cpp"
cat >> "$tree/CMakeLists.txt" << 'CMAKE'
add_executable(catalogue catalogue.cpp)
target_include_directories(catalogue PRIVATE src)
target_link_libraries(catalogue PRIVATE lilytank_diagnose)
CMAKE
cmake -S "$tree" -B "$tree/build" ${2:+-DCMAKE_CXX_COMPILER="$2"} ${3:+-G "$3"} -DCMAKE_BUILD_TYPE=Release \
      -DLILYTANK_TESTS=OFF -DLILYTANK_BENCH=OFF -DLILYTANK_RENDER=OFF > /dev/null
cmake --build "$tree/build" --target lilytank catalogue -j "$(nproc)" > "$tree/log" || { tail -30 "$tree/log"; exit 1; }

faults=0
check() {  # <what> <command...>
  "${@:2}" && return
  echo "$1"
  faults=1
}
program=$tree/build/lilytank
run() {  # <name> <stiffness>: the fingerprint of a minute
  "$program" run "$tree/scenarios/tank_lilies.toml" --set run.duration='1 min' \
    --set forces.spring_to_middle.stiffness="$2" --out "$tree/$1" --quiet > "$tree/$1.txt"
}
"$program" forces > "$tree/forces"
check 'forces does not list the term' grep -q spring_to_middle "$tree/forces"
run with 0.1
run without 0
check 'the resolved scenario lacks the term' grep -q 'spring_to_middle' "$tree/with/resolved.toml"
check 'the term does not move modules' bash -c '! cmp -s "$0" "$1"' "$tree"/with{,out}/trajectory.bin
"$tree/build/catalogue" > "$tree/effects"
check 'diagnose does not search for the term, last of all' \
  test "$(tail -1 "$tree/effects")" = 'spring_to_middle forces.spring_to_middle.stiffness 0 1'
((faults == 0)) && echo 'new_force: simulation, calibration and diagnosis know a new force'
exit "$faults"
