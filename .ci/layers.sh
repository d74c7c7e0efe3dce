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

# home <layer> <public headers...>: the layer that each header in include/lilytank belongs to.
declare -A homes
home() {
  local header
  for header in "${@:2}"; do homes[$header]=$1; done
}

# headers_of <layer>: its public headers, as paths.
headers_of() {
  local header
  for header in "${!homes[@]}"; do
    [[ ${homes[$header]} == "$1" ]] && echo "include/lilytank/$header.hpp"
  done
}

# layer <name> <layers it may include...>: its folder and its public headers include only these and itself.
layer() {
  local allowed found folder=src/$1
  [[ $1 == render ]] && folder=render
  local -a paths=()
  [[ -d $folder ]] && paths+=("$folder")
  mapfile -t -O "${#paths[@]}" paths < <(headers_of "$1")
  allowed=$(IFS='|' && echo "${*}")
  if found=$(code "${paths[@]}" | grep -E '#include "[a-z]+/' | sed -E -f "$places" |
             grep -vE "#include \"($allowed)/"); then
    printf '%s may include only itself and: %s\n%s\n' "$1" "${*:2}" "$found"
    faults=1
  fi
}

only_in 'src/study/' '#include <(tbb|oneapi)/' 'TBB belongs to src/study'
only_in 'src/study/|src/cli/progress\.|src/python/(job|verb)\.' \
  '#include <(thread|future|mutex|condition_variable|execution)>' \
  'threads belong to src/study, src/cli/progress and src/python'
only_in 'src/python/' '#include <pybind11' 'pybind11 belongs to src/python'
only_in 'render/' '#include <cairo' 'Cairo belongs to render'
only_in 'src/jobs/netcdf.cpp' '#include <netcdf' 'NetCDF belongs to src/jobs/netcdf.cpp'
only_in 'src/cli/' '#include <cxxopts' 'cxxopts belongs to src/cli'
only_in 'src/proof/box2d_bodies.hpp' '#include <box2d' 'Box2D belongs to src/proof/box2d_bodies.hpp'
only_in 'src/statistics/quantiles.cpp' '#include <boost/' 'Boost.Math belongs to src/statistics/quantiles.cpp'
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
home text error job_control
home math math random
home model effect event flow_field force model ruleset state
home world start world
home search search
home statistics normality statistics
home assemblies assembly_record
home io file_digest model_parameter report run_events scenario table_layout trajectory
home jobs run data_file
home recording camera experiment recording recording_io
home smoothing smoothing
home tracks analysis distributions metrics motion_summary
home flow coverage flow_estimate flow_report
home synthesis kinetics lattice synthesis target
home study measure search_run study study_summary study_table
home optimize optimize
home emulator emulator fit_parameter flow_maps
home calibrate calibration response_surface recovery
home filter predictor
home finder diagnosis diagnosis_subject next_experiment
home proof proof proof_grid
home bodies bodies
home view view
home render render

places=$(mktemp)
trap 'rm -f "$places"' EXIT
for header in "${!homes[@]}"; do
  echo "s|#include \"lilytank/$header\\.hpp\"|#include \"${homes[$header]}/$header.hpp\"|"
done > "$places"
for file in include/lilytank/*.hpp; do
  header=$(basename "$file" .hpp)
  if [[ -z ${homes[$header]:-} ]]; then
    echo "$file belongs to no layer: name it in .ci/layers.sh"
    faults=1
  fi
done

layer text
layer math
layer search math text
layer model math text
layer physics model math
layer forces model math
layer control physics model math text
layer world control forces physics model math text
layer statistics math text
base=(world model statistics math text)
layer assemblies "${base[@]}"
layer io "${base[@]}"
layer jobs io assemblies "${base[@]}"
layer recording io "${base[@]}"
layer smoothing recording "${base[@]}"
layer tracks smoothing recording io "${base[@]}"
layer flow tracks smoothing recording io "${base[@]}"
layer synthesis assemblies io "${base[@]}"
layer study synthesis jobs search assemblies io "${base[@]}"
layer optimize study synthesis jobs search assemblies io "${base[@]}"
base+=(io assemblies recording smoothing tracks flow emulator)
layer emulator "${base[@]}"
layer filter "${base[@]}"
layer effects study forces "${base[@]}"
layer scores effects filter study forces "${base[@]}"
layer calibrate scores effects filter study jobs search forces "${base[@]}"
layer finder scores effects filter calibrate study jobs forces "${base[@]}"
layer proof finder scores effects filter calibrate study jobs forces "${base[@]}"
layer bodies finder study jobs "${base[@]}"
base+=(bodies proof finder scores effects filter calibrate optimize study search synthesis jobs)
layer view "${base[@]}"
layer render view "${base[@]}"
layer cli render view forces "${base[@]}"
layer python cli render view forces "${base[@]}"

((faults == 0)) && echo "layers: every include and function is where it may be"
# Two types of one name in one namespace are one type to the linker, which takes the first one's
# functions for both. What *_inl.hpp defines is local to the file that includes it.
twice=$(find include src render -name '*.hpp' ! -name '*_inl.hpp' -print0 |
        xargs -0 grep -hoE '^(struct|class|enum class) [A-Za-z]+( final)?( :.*)? \{' |
        sed -E 's/^(struct|enum class|class) ([A-Za-z]+).*/\2/' | sort | uniq -d | grep -vx 'Impl')
if [[ -n $twice ]]; then
  printf 'more than one type is named:\n%s\n' "$twice"
  faults=1
fi

exit "$faults"
