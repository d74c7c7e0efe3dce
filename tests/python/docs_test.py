"""The Python examples of docs/python.md, in their order."""

import os
import re
import unittest

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
        for block in blocks:
            exec(compile(block, "docs/python.md", "exec"), names)
        self.assertEqual(set(names["msd"]["source"]), {"simulated", "recorded", "difference"})
        self.assertEqual(names["scenario"]["tank.radius"], 0.32)


if __name__ == "__main__":
    unittest.main()
