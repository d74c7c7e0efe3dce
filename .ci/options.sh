#!/usr/bin/env bash
# Checks that the table of options on the page of each verb is the program's. A table stands between the lines
# `<!-- options: VERB -->` and `<!-- end -->`.
#   options.sh LILYTANK            prints the pages with other tables; exit code 1
#   options.sh --write LILYTANK    writes the tables
set -euo pipefail
write=0
if [[ ${1:-} == --write ]]; then
  write=1
  shift
fi
lilytank=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
faults=0
verbs=(run study 'study merge' 'study slurm' 'recording info' 'recording check' 'recording convert' analyze flow
  calibrate diagnose prove optimize synthesize check render view export)

# table <verb>: its options as a Markdown table.
table() {
  # shellcheck disable=SC2086  # "recording check" is two words
  "$lilytank" $1 --help | perl -ne '
    if (/^ +(?:-\w, )?(--[\w-]+(?: \S+)?)(?: {2,}(.*))?$/) { push @options, [$1, $2 // ""]; }
    elsif (@options && /^ {10,}(\S.*)/) { $options[-1][1] .= ($options[-1][1] =~ /\S$/ ? " " : "") . $1; }
    END {
      print "| option | meaning |\n|---|---|\n";
      for (@options) {
        my ($name, $text) = @$_;
        next if $name =~ /^--help/;
        s/\|/\\|/g, s/ +/ /g, s/ $// for $name, $text;
        $text =~ s/</&lt;/g;
        print "| `$name` | $text |\n";
      }
    }'
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for verb in "${verbs[@]}"; do
  page=$(grep -lF -- "<!-- options: $verb -->" docs/*.md || true)
  if [[ $(wc -w <<< "$page") != 1 ]]; then
    echo "the options of lilytank $verb have no page, or more than one: $page"
    faults=$((faults + 1))
    continue
  fi
  table "$verb" > "$work/table"
  awk -v begin="<!-- options: $verb -->" -v table="$work/table" '
    $0 == begin { print; print ""; while ((getline line < table) > 0) print line; print ""; inside = 1; next }
    $0 == "<!-- end -->" { inside = 0 }
    !inside' "$page" > "$work/page"
  cmp -s "$page" "$work/page" && continue
  if ((write)); then
    cat "$work/page" > "$page"
  else
    echo "$page: the options of lilytank $verb differ from the program's; run .ci/options.sh --write LILYTANK"
    faults=$((faults + 1))
  fi
done
((faults == 0)) && echo "options: the table of every verb is the program's"
exit $((faults > 0))
