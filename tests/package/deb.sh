#!/usr/bin/env bash
# Makes the Debian package of a build tree and looks into it.
#   deb.sh BUILD                   ends with 77 (skipped) where the tools of Debian are not installed
set -euo pipefail
if ! command -v dpkg-deb > /dev/null || ! command -v dpkg-shlibdeps > /dev/null; then
  echo "dpkg-dev is not installed: no package made"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cpack --config "$1/CPackConfig.cmake" -B "$work" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip > "$work/log" ||
  { cat "$work/log"; exit 1; }
deb=$(find "$work" -maxdepth 1 -name 'lilytank_*.deb')
dpkg-deb -c "$deb" > "$work/list"
for file in bin/lilytank share/man/man1/lilytank.1 share/man/man1/lilytank-run.1 include/lilytank/world.hpp \
            share/bash-completion/completions/lilytank share/zsh/vendor-completions/_lilytank \
            share/fish/vendor_completions.d/lilytank.fish share/lilytank/scenarios/chain5.toml; do
  grep -qE " \./usr/$file$" "$work/list" || { echo "the package has no $file"; exit 1; }
done
depends=$(dpkg-deb -f "$deb" Depends)
[[ $depends == *libtbb12* && $depends == *libstdc++6* ]] || { echo "the package depends on: $depends"; exit 1; }
dpkg-deb -x "$deb" "$work/root"
"$work/root/usr/bin/lilytank" --version
