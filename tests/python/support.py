"""What the tests of the Python package share. LILYTANK_PROGRAM is the command-line program."""

import importlib.util
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2]
SCENARIOS = SOURCES / "scenarios"
CHAIN = str(SCENARIOS / "chain5.toml")
TANK = str(SCENARIOS / "experiments" / "tank.toml")


def program(*words):
    """What `lilytank WORDS...` does."""
    command = [os.environ["LILYTANK_PROGRAM"], *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def needs(module):
    """Skips a test, and says so, where a package is absent."""
    return unittest.skipUnless(importlib.util.find_spec(module), f"{module} is not installed")


class TestCase(unittest.TestCase):
    """With a directory of its own, `here`, that is removed."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="lilytank-test-")
        self.addCleanup(directory.cleanup)
        self.here = Path(directory.name)

    def write(self, name, text):
        path = self.here / name
        path.write_text(text, encoding="utf-8")
        return str(path)
