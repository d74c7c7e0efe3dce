"""lilytank.InputError: the line that the command-line program prints."""

import unittest
from unittest import mock

import lilytank
from support import CHAIN, TANK, TestCase, program


class Errors(TestCase):
    def assertSameLine(self, call, *words):
        cli = program(*words)
        self.assertEqual(cli.returncode, 2, cli)
        with self.assertRaises(lilytank.InputError) as caught:
            call()
        self.assertEqual(str(caught.exception) + "\n", cli.stderr)

    def assertSameRefusal(self, values, *sets):
        words = [word for one in sets for word in ("--set", one)]
        out = self.here / "r"
        self.assertSameLine(
            lambda: lilytank.run(lilytank.Scenario(CHAIN, values), out),
            "run",
            CHAIN,
            *words,
            "--out",
            out,
        )
        self.assertFalse(out.exists())

    def test_scenarios(self):
        self.assertSameRefusal({"tank.radios": 3}, "tank.radios=3")
        self.assertSameRefusal({"tank": {"radius": "3 kg"}}, "tank.radius=3 kg")
        self.assertSameRefusal({"tank.radius": 99.0}, "tank.radius=99.0")
        self.assertSameRefusal({"module.count": 1.5}, "module.count=1.5")
        self.assertSameRefusal({"module.shadowing": "of"}, "module.shadowing=of")
        self.assertSameRefusal({"module.count": 900}, "module.count=900")  # do not fit
        self.assertSameRefusal({"ruleset.file": "no.rules"}, "ruleset.file=no.rules")

    def test_files(self):
        broken = self.write("broken.toml", "tank.radius = 0.3\n[module\n")
        self.assertSameLine(lambda: lilytank.Scenario(broken), "run", broken)
        wrong = self.write("wrong.toml", "[tank]\nradius = '3 s'\n")
        self.assertSameLine(lambda: lilytank.Scenario(CHAIN, wrong), "run", CHAIN, wrong)
        self.assertSameLine(lambda: lilytank.Scenario("nowhere.toml"), "run", "nowhere.toml")

    def test_directories(self):
        out = self.here / "r"
        short = {"run.duration": "1 s"}
        lilytank.run(lilytank.Scenario(CHAIN, short), out)
        self.assertSameLine(
            lambda: lilytank.run(lilytank.Scenario(CHAIN, short, seed=2), out),
            *("run", CHAIN, "--set", "run.duration=1 s", "--seed", "2", "--out", out),
        )
        lilytank.run(lilytank.Scenario(CHAIN, short, seed=2), out, force=True)
        trajectory = out / "trajectory.bin"
        trajectory.write_bytes(trajectory.read_bytes()[:-9] + b"\0" * 9)
        with self.assertRaisesRegex(lilytank.InputError, "trajectory.bin"):
            lilytank.load_run(out)
        with self.assertRaisesRegex(lilytank.InputError, "not the directory of a run"):
            lilytank.load_run(self.here)

    def test_recordings(self):
        table = self.write("lost.csv", "frame,time,id,x,y\n0,0,0,0,nothing\n")
        self.assertSameLine(lambda: lilytank.read_recording(table), "recording", "info", table)
        self.assertSameLine(
            lambda: lilytank.read_recording(table, formt="trackpy"),
            *("recording", "info", table, "--read", "formt=trackpy"),
        )

    def test_verbs(self):
        self.assertSameLine(lambda: lilytank.flow(CHAIN), "flow", CHAIN)
        self.assertSameLine(
            lambda: lilytank.study(CHAIN, thread=3), "study", CHAIN, "--thread", "3"
        )
        self.assertSameLine(
            lambda: lilytank.calibrate(TANK, replicates=3), "calibrate", TANK, "--replicates", "3"
        )
        self.assertSameLine(lambda: lilytank.verb("analise", CHAIN), "analise", CHAIN)
        with self.assertRaises(lilytank.InputError):
            lilytank.diagnose(TANK, budget="none")
        self.assertTrue(lilytank.flow(TANK, estimator="paper").ok)  # goes on after refusals

    def test_kinds_of_values(self):
        with self.assertRaises(TypeError):
            lilytank.Scenario(CHAIN, {"tank.radius": object()})
        self.assertTrue(issubclass(lilytank.InputError, ValueError))
        with mock.patch("importlib.import_module", side_effect=ImportError("no module")):
            run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "1 s"}))
            with self.assertRaisesRegex(ImportError, "needs pandas: install python3-pandas"):
                run.events.to_pandas()


if __name__ == "__main__":
    unittest.main()
