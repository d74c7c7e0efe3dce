"""Builds the module by CMake. Options of CMake: CMAKE_ARGS of the environment."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
TREE = "build-python"  # of setuptools and CMake
(ROOT / TREE).mkdir(exist_ok=True)


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        module = Path(self.get_ext_fullpath(extension.name)).resolve()
        tree = Path(self.build_temp).resolve()
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "LILYTANK_PYTHON": "ON",
            "LILYTANK_TESTS": "OFF",
            "LILYTANK_BENCH": "OFF",
            "LILYTANK_PYTHON_OUTPUT": tree / "python",
            "Python_EXECUTABLE": sys.executable,
        }
        words = [f"-D{name}={value}" for name, value in options.items()]
        words += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.run(["cmake", "-S", ROOT, "-B", tree, "-G", "Ninja", *words], check=True)
        subprocess.run(["cmake", "--build", tree, "--target", "lilytank_python"], check=True)
        (built,) = (tree / "python" / "lilytank").glob("_core.*.so")
        module.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(built), str(module))


setup(
    version=re.search(r"VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text())[1],
    packages=["lilytank"],
    package_dir={"": "src/python"},
    package_data={"lilytank": ["*.pyi", "py.typed"]},
    options={"build": {"build_base": TREE}, "egg_info": {"egg_base": TREE}},
    ext_modules=[Extension("lilytank._core", [])],
    cmdclass={"build_ext": CMakeBuild},
)
