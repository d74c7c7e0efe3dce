"""The Python examples of docs/python.md, in their order, and the stubs of the module."""

import ast
import contextlib
import io
import os
import re
import unittest
from pathlib import Path

import lilytank
from support import SCENARIOS, SOURCES, TestCase, needs


class Docs(TestCase):
    @needs("pandas")
    def test_examples(self):
        page = (SOURCES / "docs" / "python.md").read_text(encoding="utf-8")
        page = re.sub(r"<!-- long -->\n```python\n.*?^```", "", page, flags=re.M | re.S)
        blocks = re.findall(r"^```python\n(.*?)^```", page, flags=re.M | re.S)
        self.assertGreater(len(blocks), 5)
        (self.here / "scenarios").symlink_to(SCENARIOS)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.here)
        names = {}
        with contextlib.redirect_stdout(io.StringIO()):
            for block in blocks:
                exec(compile(block, "docs/python.md", "exec"), names)
        self.assertEqual(set(names["msd"]["source"]), {"simulated", "recorded", "difference"})
        self.assertEqual(names["scenario"]["tank.radius"], 0.32)


class Stubs(unittest.TestCase):
    def test_stubs_name_what_the_module_has(self):
        module = lilytank._core
        stub = ast.parse(Path(lilytank.__file__).with_name("_core.pyi").read_text(encoding="utf-8"))
        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                self.assertTrue(callable(getattr(module, node.name)), node.name)
            elif isinstance(node, ast.ClassDef):
                own = {
                    n.name if isinstance(n, ast.FunctionDef) else n.target.id
                    for n in node.body
                    if isinstance(n, (ast.FunctionDef, ast.AnnAssign))
                }
                there = {n for n in vars(getattr(module, node.name)) if n[0] != "_"}
                self.assertEqual(own - {"__init__"}, there - {"with_traceback"}, node.name)
        names = {n.name for n in stub.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))}
        self.assertEqual(names, {n for n in vars(module) if n[0] != "_"})

    def test_everything_public_is_documented(self):
        for name in lilytank.__all__:
            thing = getattr(lilytank, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if isinstance(thing, type) else []:
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(value.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
