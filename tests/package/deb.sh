#!/usr/bin/env bash
# Makes the Debian packages of a build tree and looks into them.
#   deb.sh BUILD WITH_PYTHON       ends with 77 (skipped) where the tools of Debian are not installed
set -euo pipefail
if ! command -v dpkg-deb > /dev/null || ! command -v dpkg-shlibdeps > /dev/null; then
  echo "dpkg-dev is not installed: no package made"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cpack --config "$1/CPackConfig.cmake" -B "$work" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip > "$work/log" ||
  { cat "$work/log"; exit 1; }

fail() { echo "$1"; exit 1; }

# holds <package> <section> <dependencies> <file below usr/>...
holds() {
  local deb package=$1 section=$2 dependency file depends
  deb=$(find "$work" -maxdepth 1 -name "$1_*.deb")
  [[ $deb ]] || fail "there is no package $package"
  [[ $(dpkg-deb -f "$deb" Section) == "$section" ]] || fail "$package is not in section $section"
  [[ $(dpkg-deb -f "$deb" Description) == *$'\n'* ]] || fail "$package has no long description"
  depends=$(dpkg-deb -f "$deb" Depends)
  for dependency in $3; do
    [[ ", $depends" == *", $dependency"[\ ,]* || ", $depends" == *", $dependency" ]] ||
      fail "$package does not depend on $dependency but on: $depends"
  done
  dpkg-deb -c "$deb" > "$work/$package.list"
  for file in "share/doc/$package/copyright" "${@:4}"; do
    grep -qE " \./usr/$file$" "$work/$package.list" || fail "$package has no $file"
  done
  dpkg-deb -x "$deb" "$work/root"
}

holds lilytank science "libtbb12 libstdc++6" bin/lilytank share/man/man1/lilytank.1 share/man/man1/lilytank-run.1 \
  share/bash-completion/completions/lilytank share/zsh/vendor-completions/_lilytank \
  share/fish/vendor_completions.d/lilytank.fish share/lilytank/scenarios/chain5.toml \
  share/lilytank/scenarios/experiments/tour.toml share/lilytank/scenarios/experiments/tour_lily_1.csv.gz
holds liblilytank-dev libdevel "libeigen3-dev libtbb-dev" include/lilytank/world.hpp 'lib/.*liblilytank_core\.a' \
  'lib/.*lilytankConfig\.cmake' 'lib/.*lilytankTargets\.cmake'
! grep -E ' \./usr/(include|lib)/.*[^/]$' "$work/lilytank.list" || fail "lilytank has files of liblilytank-dev"
"$work/root/usr/bin/lilytank" --version
[[ $2 == ON ]] || exit 0

holds python3-lilytank python "python3 python3-numpy libtbb12" 'lib/python3/dist-packages/lilytank/_core\..*\.so' \
  lib/python3/dist-packages/lilytank/__init__.py lib/python3/dist-packages/lilytank/_core.pyi \
  lib/python3/dist-packages/lilytank/py.typed
cd "$work"
PYTHONPATH=$work/root/usr/lib/python3/dist-packages /usr/bin/python3 - << 'END'
import lilytank

run = lilytank.run(lilytank.Scenario({"run.duration": 5, "module.count": 4}))
assert run.trajectory.x.shape[1] == 4 and "/root/usr/lib/" in lilytank.__file__
END
