#!/usr/bin/env bash
# Checks that texts use the field's standard terms. Prints how often each nonstandard term occurs, and
# fails if there is one. Code in fences and backticks and the targets of links do not count.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Of the sources, their strings: help texts, messages, reports.
texts=$(find README.md CHANGELOG.md CONTRIBUTING.md docs scenarios bench -name '*.md' | sort)
sources=$(find src render -name '*.[ch]pp' | sort)

exec perl - $texts -- $sources << 'PERL'
use strict;
use warnings;

# Nonstandard term => standard terms.
my @terms = (
  [qr/\b(?:told|tells?|telling)\b/i, 'reported, determined, distinguished'],
  [qr/\b(?:asks?|asked|asking)\b/i, 'tested, evaluated, requires'],
  [qr/\bwhose (?:a|an|the)\b/i, 'ownership'],
  [qr/^#+ [^\n]*\b(?:whose|what|how|why)\b[^\n]*$/im, 'a heading that names a thing: Method, Limitations'],
  [qr/\b(?:what|something|nothing) (?:is|was) left\b|\bleaves? (?:something|nothing)\b/i, 'remainder, residual'],
  [qr/\b(?:nothing|something)(?: is)? missing\b|\bleaves? out\b/i, 'null experiment, omitted effect'],
  [qr/\bcomplete (?:experiments?|recordings?|ones?)\b/i, 'null experiment'],
  [qr/\b(?:laid|lays?) over\b/i, 'overrides, overlay'],
  [qr/\bsealed?\b/i, 'blinded synthetic benchmark'],
  [qr/\batlas\b/i, 'simulated reference ensemble'],
  [qr/\bkept apart\b/i, 'distinguished'],
  [qr/\bin (?:its|their) turn\b/i, 'then'],
  [qr/\b(?:takes?|took|taking) (?:up|over)\b/i, 'absorbs, replaces'],
  [qr/\b(?:kicks?|jolts?)\b/i, 'process noise, impulsive noise'],
  [qr/\bdraught\b/i, 'immersion depth'],
  [qr/\b(?:a|the|what|as a|by a|small|large|great) shares?\b/i, 'fraction'],
  [qr/\bbegun\b/i, 'initialised, started'],
  [qr/\bcop(?:y|ies) (?:\w+ )?(?:stands?|stood)\b|\bstanding copies\b/i, 'completed copies'],
  [qr/\blees?\b/i, 'wake'],
  [qr/\bturned (?:round|back)\b/i, 'inverse'],
  [qr/\bbelieves? in\b/i, 'winner\'s curse'],
  [qr/\bknown before\b/i, 'prior'],
  [qr/\bstandard deviations?(*SKIP)(*FAIL)|\bdeviations?\b/i, 'standard deviation, standard error'],
  [qr/\breal world\b(*SKIP)(*FAIL)|\bworlds?\b/, 'simulation run, replicate'],
);

# Lines on which such a word has its ordinary sense, and meanings of keys, which the sources determine: file,
# and text of the line.
my @ordinary = (
  ['docs/search.md', 'sk and tell'],
  ['bench/README.md', '| kB/world |'],
  # Symbols of equations are the keys' names; columns are the trackers'.
  ['src/calibrate/fit_conditions.cpp', '"module.draught"'],
  ['src/forces/added_mass.cpp', 'rho side^2 draught'],
  ['src/forces/correlated_gusts.cpp', 'deviation'],
  ['src/forces/face_drag.cpp', 'rho (draught side'],
  ['src/forces/magnus_lift.cpp', 'rho draught'],
  ['src/forces/vortex_shedding.cpp', 'rho draught'],
  ['src/io/scenario_keys.cpp', '"module.draught"'],
  ['src/recording/column_names.cpp', '"X (world)"'],
  ['src/recording/formats.cpp', '"(world)"'],
  ['src/recording/write_recording.cpp', '(world)"'],
  ['src/synthesis/rate_table.cpp', "the row 'worlds'"],
);

# What the terms are looked for in, with blanks for everything else: lines stay where they are.
sub blank { return $_[0] =~ s/[^\n]/ /gr; }
sub prose {
  my ($file, $text) = @_;
  if ($file =~ /pp$/) {
    $text =~ s/^#include.*/blank($&)/gem;
    # A string of one word is a key of a file or an option.
    $text =~ s{//[^\n]*|"((?:[^"\\\n]|\\.)*)"|[^"/\n]+|/}
              {defined $1 && $1 !~ /^[a-z_,%\/-]*(?:\\n)?$/ ? " $1 " : blank($&)}gex;
    return $text;
  }
  $text =~ s/^ *```.*?^ *```/blank($&)/gems;
  $text =~ s/`[^`]*`|\]\([^)]*\)/blank($&)/ges;
  return $text;
}

my (%count, %of);
my $faults = 0;
for my $file (@ARGV) {
  next if $file eq '--';
  open my $in, '<:encoding(UTF-8)', $file or die "$file: $!\n";
  my $text = do { local $/; <$in> };
  my @lines = split /\n/, $text, -1;
  my $prose = prose($file, $text);
  $prose =~ s/(?<=\S)\n +(?=\S)/"\n"/ge if $file !~ /pp$/;  # wrapped terms match across a line's end
  for my $term (@terms) {
    my ($pattern, $standard) = @$term;
    my $wrapped = "$pattern" =~ s/ (?=[\w(])/\\s/gr;
    $wrapped = "$pattern" if $wrapped =~ /#\+/;
    while ($prose =~ /$wrapped/g) {
      my ($word, $at) = ($&, $-[0]);
      my $number = 1 + (substr($prose, 0, $at) =~ tr/\n//);
      my $line = $lines[$number - 1];
      next if grep { $file eq $_->[0] && index($line, $_->[1]) >= 0 } @ordinary;
      $count{$standard}++, $of{$file =~ /pp$/ ? 'sources' : $file}++;
      $faults++;
      $word =~ s/\s+/ /g;
      print "$file:$number: \"$word\" (standard: $standard)\n";
    }
  }
}
printf "%5d  %s\n", $count{$_}, $_ for sort { $count{$b} <=> $count{$a} || $a cmp $b } keys %count;
printf "%5d  in %s\n", $of{$_}, $_ for sort keys %of;
print "words: $faults nonstandard terms\n";
exit($faults ? 1 : 0);
PERL
