# What demo.sh and test.sh need from Debian 12, and how they get it. Sourced by both.

build_packages=(g++ cmake ninja-build pkg-config libeigen3-dev libtbb-dev libtomlplusplus-dev
                libcxxopts-dev libhwy-dev librandom123-dev libboost-dev libcairo2-dev zlib1g-dev
                libssl-dev nlohmann-json3-dev)
film_packages=(ffmpeg fonts-dejavu-core)
# For texts, reports, NetCDF, recordings by Box2D, the Debian packages, the recipe for conda.
test_packages=(libgtest-dev perl chromium libnetcdf-dev libbox2d-dev dpkg-dev file python3-yaml python3-jinja2)
python_packages=(python3-dev pybind11-dev python3-numpy)
table_packages=(python3-pandas python3-xarray python3-netcdf4)  # for tests of conversions, which are skipped without
slurm_packages=(slurm-wlm)  # for tests/slurm, which only root can run
# Engines and optimisers to measure against: none of them steps a World.
bench_packages=(libbenchmark-dev libode-dev libbox2d-dev libchipmunk-dev libpagmo-dev)

# Installs those of the named packages that are not there yet. Needs no rights if none is missing.
need_packages() {
  if ! command -v dpkg-query > /dev/null; then
    echo "Not a Debian system: expecting to find here what Debian calls: $*"
    return 0
  fi
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null) == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo > /dev/null; then
      echo "Please install as root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" apt-get -qq update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o=Dpkg::Use-Pty=0 install \
    --no-install-recommends "${missing[@]}" > /dev/null
}

# configure <tree> [option...]: prepares a build tree; options are CMake's.
configure() {
  local tree=$1
  shift
  local options=(-S . -B "$tree" "$@")
  [[ -f $tree/CMakeCache.txt ]] || options+=(-G Ninja)
  # Precompiled headers are cached only where the compiler and the cache are told so.
  ! command -v ccache > /dev/null ||
    options+=("-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache"
              -DCMAKE_CXX_FLAGS=-fpch-preprocess)
  cmake "${options[@]}" --log-level=NOTICE
}
