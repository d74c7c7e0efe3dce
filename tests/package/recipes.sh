#!/usr/bin/env bash
# Checks the recipe for conda (cmake/conda) and the Dockerfile against the build: neither conda nor docker is needed.
#   recipes.sh SOURCES             ends with 77 (skipped) without python3-yaml and python3-jinja2
set -euo pipefail
cd "$1"
if ! /usr/bin/python3 -c 'import jinja2, yaml' 2> /dev/null; then
  echo "skipped: python3-yaml or python3-jinja2 is not installed"
  exit 77
fi
bash -n cmake/conda/build.sh
! command -v shellcheck > /dev/null || shellcheck --exclude=SC2086,SC2154 cmake/conda/build.sh
/usr/bin/python3 - << 'END'
import re
import shlex
import subprocess
import sys
from pathlib import Path

import jinja2
import yaml

faults = []


def need(condition, fault):
    if not condition:
        faults.append(fault)


cmake = Path("CMakeLists.txt").read_text() + Path("cmake/python.cmake").read_text()
version = re.search(r"project\(lilytank VERSION ([0-9.]+)", cmake)[1]
# What the build needs: its name in CMake, in conda-forge (None: built without it) and in Debian.
needed = {
    "Eigen3": ("eigen", "libeigen3-dev"),
    "TBB": ("tbb-devel", "libtbb-dev"),
    "tomlplusplus": ("tomlplusplus", "libtomlplusplus-dev"),
    "cxxopts": ("cxxopts", "libcxxopts-dev"),
    "hwy": ("libhwy", "libhwy-dev"),
    "Boost": ("libboost-headers", "libboost-dev"),
    "nlohmann_json": ("nlohmann_json", "nlohmann-json3-dev"),
    "ZLIB": ("zlib", "zlib1g-dev"),
    "OpenSSL": ("openssl", "libssl-dev"),
    "PkgConfig": ("pkg-config", "pkg-config"),
    "NETCDF": ("libnetcdf", "libnetcdf-dev"),
    "box2d": (None, "libbox2d-dev"),
    "CAIRO": ("cairo", "libcairo2-dev"),
    "Python": ("python", "python3-dev"),
    "pybind11": ("pybind11", "pybind11-dev"),
}
found = set(re.findall(r"(?:find_package|pkg_check_modules)\((\w+)", cmake))
need(found == set(needed), f"tests/package/recipes.sh does not know {found ^ set(needed)}")

# The recipe for conda.
text = jinja2.Environment(undefined=jinja2.StrictUndefined).from_string(Path("cmake/conda/meta.yaml").read_text())
recipe = yaml.safe_load(text.render(compiler=lambda of: f"{of}-compiler", stdlib=lambda of: f"{of}-stdlib"))
need(list(recipe) == ["package", "source", "build", "requirements", "test", "about"], "meta.yaml: order of sections")
need(str(recipe["package"]["version"]) == version, f"meta.yaml: the version is not {version}")
folders = {""}
for source in recipe["source"]:
    if "path" in source:
        need((Path("cmake/conda") / source["path"] / "CMakeLists.txt").exists(), "meta.yaml: the source is elsewhere")
    else:
        need(re.fullmatch("[0-9a-f]{64}", source["sha256"]), "meta.yaml: sha256")
        folders.add(source["folder"])
for file in recipe["about"]["license_file"]:
    need(Path(file).exists() or file.split("/")[0] in folders, f"meta.yaml: there is no {file}")
for file in re.findall(r"share/lilytank/(\S+)", str(recipe["test"]["commands"])):
    need(Path(file).exists(), f"meta.yaml: there is no {file}")
packages = {word.split()[0] for part in ("build", "host") for word in recipe["requirements"][part]}
for name, (conda, _) in needed.items():
    need(conda is None or conda in packages, f"meta.yaml: {conda} is missing, which CMake finds as {name}")
known = set(re.findall(r"\b(?:option|set)\((\w+)", cmake)) | set(re.findall(r"find_path\((\w+)", cmake))
for option in re.findall(r"-D(\w+)=", Path("cmake/conda/build.sh").read_text()):
    need(option in known | {"CMAKE_BUILD_TYPE", "Python_EXECUTABLE"}, f"build.sh: CMake has no {option}")

# The Dockerfile.
lines = re.sub(r"\\\n\s*", "", Path("Dockerfile").read_text()).splitlines()
lines = [line.split(maxsplit=1) for line in lines if line and not line.startswith("#")]
kinds = {"FROM", "COPY", "WORKDIR", "RUN", "ENTRYPOINT"}
need({word for word, _ in lines} <= kinds, "Dockerfile: an unknown instruction")
lists = subprocess.run(["bash", "-c", "source .ci/packages.sh; declare -p; declare -F"], capture_output=True, text=True)
offered = set(re.findall(r'"([a-z0-9.+-]+)"', lists.stdout))
stages = set()
for word, rest in lines:
    if word == "FROM":
        image = rest.split()
        need(image[0] == "debian:bookworm-slim", f"Dockerfile: the image is {image[0]}")
        stages.update(image[2:])
    elif word == "COPY" and rest.startswith("--from="):
        need(rest[7:].split()[0] in stages, f"Dockerfile: no stage for {rest}")
    elif word == "RUN":
        need(subprocess.run(["bash", "-n", "-c", rest]).returncode == 0, f"Dockerfile: {rest} is no shell")
        words = shlex.split(rest)
        inner = " ".join(w for w in words if " " in w)
        for name in re.findall(r"\$\{(\w+)\[@\]\}", inner):
            need(f"declare -a {name}=" in lists.stdout, f"Dockerfile: .ci/packages.sh has no {name}")
        for name in re.findall(r"(?:^|&& )(\w+)", inner):
            need(name == "source" or f"declare -f {name}\n" in lists.stdout, f"Dockerfile: no function {name}")
        installed = re.findall(r"(?:need_packages|--no-install-recommends) ([^&]*)", inner + " && " + rest)
        for package in " ".join(installed).split():
            need(re.search(r'[$/]', package) or package in offered, f"Dockerfile: {package} is in no list of packages")
need(lines[-1] == ["ENTRYPOINT", '["lilytank"]'], "Dockerfile: the entry point")

# Debian's packages.
for name, (_, debian) in needed.items():
    need(debian in offered, f".ci/packages.sh: {debian} is missing, which CMake finds as {name}")
print("\n".join(faults) or f"recipes of version {version}: {len(packages)} packages of conda-forge")
sys.exit(bool(faults))
END
