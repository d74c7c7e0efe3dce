#!/usr/bin/env bash
# Checks that each layer uses only what docs/structure.md lets it use: other layers, packages, and
# for everything that reaches a State no function whose bits depend on the machine.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
faults=0

# code <path...>: file:line:text of all sources there, without // comments and quoted text.
code() {
  find "$@" -name '*.[ch]pp' -print0 | sort -z | xargs -0 awk '
    !/^#include/ { gsub(/"([^"\\]|\\.)*"/, "\"\"") }
    { sub(/\/\/.*/, "") }
    NF { print FILENAME ":" FNR ":" $0 }'
}

# forbid <pattern> <why> <path...>
forbid() {
  local found
  if found=$(code "${@:3}" | grep -E -- "^[^:]*:[0-9]+:.*$1"); then
    printf '%s:\n%s\n' "$2" "$found"
    faults=1
  fi
}

# only_in <where, a pattern of paths> <pattern> <why>
only_in() {
  local found
  if found=$(code include src render | grep -vE "^($1)" | grep -E -- "^[^:]*:[0-9]+:.*$2"); then
    printf '%s:\n%s\n' "$3" "$found"
    faults=1
  fi
}

# layer <folder> <layers it may include...>, its own included
layer() {
  local allowed
  allowed=$(IFS='|' && echo "${*}")
  local found
  if found=$(code "src/$1" | grep -E '#include "[a-z]+/' |
             grep -vE "#include \"(lilytank|$allowed)/"); then
    printf '%s may include only itself and: %s\n%s\n' "src/$1" "${*:2}" "$found"
    faults=1
  fi
}

only_in 'src/study/' '#include <(tbb|oneapi)/' 'TBB belongs to src/study'
only_in 'src/study/' '#include <(thread|future|mutex|condition_variable|execution)>' \
  'threads belong to src/study'
only_in 'render/' '#include <cairo' 'Cairo belongs to render'
only_in 'src/cli/' '#include <cxxopts' 'cxxopts belongs to src/cli'
only_in 'src/(statistics|tracks)/' '#include <boost/' 'Boost.Math belongs to src/statistics and src/tracks'
only_in 'src/io/' '#include <toml' 'TOML belongs to src/io'
only_in 'src/io/' '#include <nlohmann' 'JSON belongs to src/io'
only_in 'src/io/' '#include <openssl' 'hashes of files belong to src/io'
only_in 'src/math/' '#include <Random123' 'Random123 belongs to src/math'
only_in 'nowhere' '#include <random>|[^_[:alnum:]]s?rand\(' \
  'random numbers come from lilytank/random.hpp only'

core=(src/math src/model src/physics src/forces src/control src/world)
steady=("${core[@]}" src/search)  # whose bits must not depend on the machine
functions='(a?(sin|cos|tan)h?|atan2|exp(2|m1)?|log(2|10|1p)?|pow|hypot|cbrt|fma|erfc?|[lt]gamma)f?l?'
forbid "(std::|::|[^_.>:[:alnum:]])$functions\(" \
  'bits of libm differ between machines: use lilytank/math.hpp' "${steady[@]}" include/lilytank/math.hpp
forbid '#include <(chrono|ctime|time\.h|unordered_map|unordered_set|iostream)>' \
  'no clock, no hashed order and no console in what steps a world or a search' "${steady[@]}"
forbid '#include [<"](jobs|io|study|cli|statistics|smoothing|tracks|assemblies)/' 'the public headers know no layer' include

layer text text
layer math math
layer model model text
layer physics physics
layer forces forces math model
layer control control physics math text model
layer world world control forces physics text model
layer search search text
layer io io statistics text
layer jobs jobs io tracks smoothing recording assemblies statistics text
layer statistics statistics text
layer assemblies assemblies text
layer recording recording io math statistics text
layer smoothing smoothing statistics text
layer tracks tracks smoothing io statistics text
layer flow flow recording io tracks smoothing recording assemblies statistics text
layer synthesis synthesis io tracks smoothing recording assemblies statistics text
layer study study jobs io statistics text
layer optimize optimize study synthesis io tracks smoothing recording assemblies statistics text
layer calibrate calibrate study io tracks smoothing recording assemblies statistics text
layer diagnose diagnose calibrate study forces io tracks smoothing recording assemblies statistics text
layer bodies bodies study recording io tracks smoothing recording assemblies statistics text
layer cli cli bodies diagnose calibrate optimize study jobs recording flow synthesis io tracks smoothing recording assemblies statistics text model

((faults == 0)) && echo "layers: every include and function is where it may be"
# Two types of one name in one namespace are one type to the linker, which takes the first one's
# functions for both.
twice=$(find include src render -name '*.hpp' -print0 |
        xargs -0 grep -hoE '^(struct|class|enum class) [A-Za-z]+( final)?( :.*)? \{' |
        sed -E 's/^(struct|enum class|class) ([A-Za-z]+).*/\2/' | sort | uniq -d | grep -vx 'Impl')
if [[ -n $twice ]]; then
  printf 'more than one type is named:\n%s\n' "$twice"
  faults=1
fi

exit "$faults"
