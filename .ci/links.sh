#!/usr/bin/env bash
# Checks the documentation: every relative link leads to a file or a heading, every path of the repository that a
# command block names is there, and every verb and option in it is one of the program.
#   links.sh [LILYTANK]      without the program, verbs and options are not checked
set -euo pipefail
lilytank=${1:+$(realpath "$1")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
faults=0
fault() {
  echo "$1"
  faults=$((faults + 1))
}

# anchors <file>: the names by which its headings are linked.
anchors() {
  awk '/^```/ { code = !code } !code && /^#+ / { sub(/^#+ /, ""); print tolower($0) }' "$1" |
    sed -E 's/[`*]//g; s/\[([^]]*)\]\([^)]*\)/\1/g; s/[^a-z0-9 _-]//g; s/ /-/g'
}

# links <file>: target of every link outside code, a line each.
links() {
  awk '/^```/ { code = !code } !code' "$1" | sed -E 's/`[^`]*`//g' |
    grep -oE '\]\([^)]+\)' | sed -E 's/^\]\(//; s/\)$//' || true
}

texts=$(find README.md CHANGELOG.md CONTRIBUTING.md docs scenarios bench -name '*.md' | sort)
for text in $texts; do
  while IFS= read -r link; do
    [[ -z $link || $link == http* || $link == mailto:* ]] && continue
    target=${link%%#*} anchor=
    [[ $link == *'#'* ]] && anchor=${link#*#}
    file=$text
    [[ -n $target ]] && file=$(dirname "$text")/$target
    if [[ ! -e $file ]]; then
      fault "$text: the link '$link' leads nowhere"
    elif [[ -n $anchor ]] && ! anchors "$file" | grep -qxF -- "$anchor"; then
      fault "$text: '$target' has no heading '#$anchor'"
    fi
  done <<< "$(links "$text")"
done

# Commands in fences: paths of this repository, verbs and options.
declare -A options
for text in $texts; do
  while IFS= read -r line; do
    for word in $line; do
      word=${word//[\'\"]/}
      [[ $word =~ ^(scenarios|docs|tests|bench)/[A-Za-z0-9_./-]+$ && ! -e $word ]] &&
        fault "$text: '$word' is not there: $line"
    done
    [[ -n $lilytank && $line =~ ^(build/)?lilytank\ ([a-z]+)(\ ([a-z]+))? ]] || continue
    verb=${BASH_REMATCH[2]} second=${BASH_REMATCH[4]:-}
    [[ $verb == help || $verb == ruleset ]] && continue  # the latter begins a file of rules
    # Verbs with verbs of their own: `study merge`, `recording info`.
    page="$verb"
    [[ ($verb == study || $verb == recording) && $second =~ ^(merge|report|status|slurm|info|check|convert)$ ]] &&
      page="$verb $second"
    # shellcheck disable=SC2086  # a page is one or two words
    [[ -v options[$page] ]] || options[$page]=$("$lilytank" $page --help 2>&1) ||
      fault "$text: there is no verb '$page': $line"
    for option in $(grep -oE '(^| )--[a-z][a-z0-9-]*' <<< "${line%%#*}" || true); do
      grep -qE -- "(^|[ ,])$option([ =,]|\$)" <<< "${options[$page]}" ||
        fault "$text: 'lilytank $page' has no option $option: $line"
    done
  done <<< "$(awk '/^```/ { code = !code; next }
    code { if (/\\$/) { sub(/\\$/, ""); held = held $0 " "; next } print held $0; held = "" }' "$text" |
    sed -E 's/^ *\$ //; s/^ +//')"
done

((faults == 0)) && echo "links: every link, path, verb and option of the documentation is there"
exit $((faults > 0))
