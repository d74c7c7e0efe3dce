#!/bin/sh
# For each target: searches the probabilities; from their optimum a hybrid strategy and the ruleset;
# from the best ruleset the pump power by completed copies. One study per target then compares all
# strategies.
#
#   scenarios/optimize/table.sh [OUT [TARGET...]]
#
# Environment: LILYTANK, the program (default: that of the build or installation of this file, else the
# one in PATH); HORIZON, duration of the searched runs (4 h, as in the comparison); REPLICATES of each
# strategy in the comparison (200); THREADS (one per core). The same command resumes after an interruption.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
scenarios=$(dirname "$here")
for program in "$scenarios/../build/lilytank" "$scenarios/../../../bin/lilytank" lilytank; do
  if command -v "$program" > /dev/null; then break; fi
done
lilytank=${LILYTANK:-$program}
out=${1:-out/optimize}
[ $# -gt 0 ] && shift
[ $# -gt 0 ] || set -- chain5 cross5 l4 t4 o4 p5 caterpillar7
mkdir -p "$out"
out=$(cd "$out" && pwd)
threads=${THREADS:+--threads $THREADS}

for target; do
  mkdir -p "$out/$target"
  empirical=$out/$target/empirical.toml
  case $target in
    chain5) cp "$scenarios/p_empirical_chain.toml" "$empirical"; paper=$scenarios/p_optimised_chain.toml ;;
    cross5) cp "$scenarios/p_empirical_cross.toml" "$empirical"; paper=$scenarios/p_optimised_cross.toml ;;
    *) echo "# The ruleset's own probabilities." > "$empirical"; paper= ;;
  esac
  search() {  # KIND NAME [OVERLAY]
    "$lilytank" optimize "$here/$1.toml" --out "$out/$target/$2" --no-compare $threads \
      --overlay "$scenarios/$target.toml" --overlay "$empirical" \
      --overlay "$scenarios/moment_matched.toml" ${3:+--overlay "$3"} \
      --set run.duration="${HORIZON:-4 h}"
  }
  search probabilities p
  best=$out/$target/p/optimum.toml
  search hybrid hybrid "$best"
  search race joint "$best"
  search agitation agitation "$out/$target/joint/optimum.toml"
  # The later optimum overrides the one from which its search started.
  together=$out/$target/joint_agitation.toml
  echo 'base = ["joint/optimum.toml", "agitation/optimum.toml"]' > "$together"
  {
    echo "[study]"
    echo "name = \"$target\""
    echo "scenario = [\"$scenarios/$target.toml\", \"$scenarios/moment_matched.toml\"]"
    echo "replicates = ${REPLICATES:-200}"
    echo "seed = 1000"
    echo "until = \"settled\""
    echo "[[axis]]"
    echo "name = \"strategy\""
    echo "overlays = [\"$empirical\", ${paper:+\"$paper\",} \"$best\", \"$out/$target/hybrid/optimum.toml\","
    echo "  \"$out/$target/joint/optimum.toml\", \"$together\"]"
    echo "labels = [\"p_e\", ${paper:+\"p_o\",} \"optimum\", \"hybrid\", \"joint\", \"joint, agitation\"]"
  } > "$out/$target/compare.toml"
  "$lilytank" study "$out/$target/compare.toml" --out "$out/$target/compare" $threads
done
