"""The verbs as functions, and recordings: numbers and files of the command-line program."""

import os
import signal
import unittest

import numpy as np

import lilytank
from support import CHAIN, SCENARIOS, TANK, TestCase, needs, program

QUICK = {"flow": "scenario", "evaluations": 40, "simulations": 40, "replicates": 20, "comparisons": 3}
STUDY = f"""
[study]
name = "small"
scenario = "{CHAIN}"
replicates = 2
seed = 1
[[axis]]
path = "module.count"
values = [5, 10]
"""


class Verbs(TestCase):
    def assertSameReport(self, result, *words, file):
        """The program's text, and its file in a directory of its own."""
        out = self.here / "cli"
        cli = program(*words, "--out", out)
        self.assertEqual((cli.returncode, cli.stdout), (0, result.text), cli.stderr)
        self.assertEqual(result.report.text, cli.stdout.replace(str(out), str(result.directory)))
        self.assertEqual((out / file).read_bytes(), result.path(file).read_bytes())

    def test_flow(self):
        result = lilytank.flow(TANK, cells=20)
        self.assertSameReport(result, "flow", TANK, "--cells", 20, file="flow_smooth.csv")
        cells = result.table("cells_smooth")
        self.assertEqual(cells.rows, 400)
        rows = result.report.sections[0].rows
        self.assertTrue(all(len(row) == len(result.report.sections[0].head) for row in rows))
        scenario = lilytank.Scenario(
            SCENARIOS / "tank_balls.toml",
            {"flow.file": result.path("flow_smooth.csv"), "run.duration": "1 s"},
        )
        self.assertEqual(lilytank.run(scenario).time, 1)

    def test_analyze(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "20 s", "output.rate": 10}))
        options = {
            "longest_lag": 2,
            "resamples": 20,
            "name": ["run", "film"],
            "to": "10 s",
            "msd_only": True,
        }
        result = lilytank.analyze(run, SCENARIOS / "experiments" / "lily_1.csv.gz", **options)
        msd = result.table("msd_all")
        self.assertEqual(list(dict.fromkeys(msd["source"])), ["run", "film", "difference"])
        tables = [section.table for section in result.report.sections if section.rows]
        self.assertTrue(any(table.rows for table in tables))
        self.assertIn("report.html", result.files)
        with self.assertRaisesRegex(FileNotFoundError, "there are: .*msd_all.csv"):
            result.table("nothing")

    def test_study(self):
        file = self.write("small.toml", STUDY)
        reports = []
        result = lilytank.study(
            file,
            set={"run.duration": "2 min"},
            threads=2,
            progress=lambda done, note: reports.append(done),
        )
        cli = program("study", file, "--set", "run.duration=2 min", "--out", self.here / "cli")
        self.assertEqual(
            (self.here / "cli" / "table.csv").read_bytes(), result.path("table.csv").read_bytes()
        )
        self.assertIn(result.report.verdict, cli.stdout)
        self.assertEqual(list(result.table("table")["module.count"]), [5, 5, 10, 10])
        self.assertTrue(all(0 <= done <= 1 for done in reports))

    def test_study_stops_and_resumes(self):
        file = self.write("small.toml", STUDY)

        def interrupt(done, note):
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            lilytank.study(
                file, out=self.here / "s", set={"run.duration": "3 h"}, progress=interrupt
            )
        lilytank.study(file, out=self.here / "s", set={"run.duration": "3 h"})
        self.assertTrue((self.here / "s" / "table.csv").exists())

    def test_rules(self):
        target = SCENARIOS / "targets" / "cross5.txt"
        result = lilytank.synthesize(target, out=self.here / "cross.rules")
        self.assertEqual(result.text, "")
        cli = program("synthesize", target)
        self.assertEqual((self.here / "cross.rules").read_text(), cli.stdout)
        self.assertEqual(lilytank.synthesize(target).text, cli.stdout)
        with self.assertWarnsRegex(UserWarning, "2 joins that can be taken back"):
            lilytank.synthesize(SCENARIOS / "targets" / "arms7.txt")
        found = lilytank.check(self.here / "cross.rules", modules=10, lattice=2)
        cli = program("check", self.here / "cross.rules", "--modules", 10, "--lattice", 2)
        self.assertEqual((found.text, found.ok), (cli.stdout, cli.returncode == 0))
        self.assertIsNone(found.directory)
        self.assertTrue(found.report.sections)

    def test_calibrate(self):
        result = lilytank.calibrate(TANK, out=self.here / "c", **QUICK)
        intervals = result.table("intervals")
        self.assertIn("flow.K_v", list(intervals["parameter"]))
        self.assertEqual(result.table("numbers")["observed"].dtype, np.float64)
        self.assertIn("flow.K_v", result.path("calibrated.toml").read_text())
        run = lilytank.run(
            lilytank.Scenario(
                SCENARIOS / "tank_lilies.toml",
                result.path("calibrated.toml"),
                {"run.duration": "1 s"},
            )
        )
        self.assertEqual(run.time, 1)
        # The program finds the finished calibration, and prints the same.
        words = [
            word for name, value in QUICK.items() for word in ("--" + name.replace("_", "-"), value)
        ]
        cli = program("calibrate", TANK, *words, "--out", self.here / "c")
        self.assertEqual(cli.stdout, result.text)

    def test_diagnose(self):
        result = lilytank.diagnose(TANK)
        self.assertEqual(result.json("diagnosis")["verdict"], "insufficient")
        self.assertEqual(result.report.tone, "fault")
        self.assertSameReport(result, "diagnose", TANK, file="diagnosis.txt")

    def test_other_verbs(self):
        self.assertEqual(lilytank.verb("forces").text, program("forces").stdout)
        self.assertEqual(
            lilytank.verb("recording info", TANK).text, program("recording", "info", TANK).stdout
        )

    def test_render(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "5 s"}))
        lilytank.render(run, at=5, png=self.here / "a.png", size=120)
        self.assertEqual((self.here / "a.png").read_bytes()[:4], b"\x89PNG")
        lilytank.view(run, out=self.here / "a.html")
        self.assertIn("<html", (self.here / "a.html").read_text())


class Recordings(TestCase):
    balls = SCENARIOS / "experiments" / "balls_1.csv.gz"

    def test_tracks_are_those_of_the_file(self):
        recording = lilytank.read_recording(self.balls, body="ball")
        self.assertEqual((recording.body, recording.rate, recording.format), ("ball", 30, "tidy"))
        track = recording.tracks[3]
        self.assertFalse(track.x.flags.owndata or track.x.flags.writeable)
        self.assertIsNone(track.theta)
        import gzip

        with gzip.open(self.balls, "rt") as file:
            rows = [line.split(",") for line in file.read().splitlines()[1:]]
        x = [float(row[3]) for row in rows if int(row[2]) == track.id]
        np.testing.assert_array_equal(
            track.x[~np.isnan(track.x)][: len(x)], x[: np.sum(~np.isnan(track.x))]
        )

    def test_checks_and_keys(self):
        rows = "".join(f"{f},{f / 25},0,{0.1 if f != 7 else 0.25},0.00{f % 3}\n" for f in range(20))
        table = self.write("leap.csv", "frame,time,id,px,y\n" + rows)
        keys = {"format": "table", "columns": {"x": "px"}, "body": "ball"}
        recording = lilytank.read_recording(table, **keys, checks={"spike": "mark"})
        self.assertEqual([f.check for f in recording.findings], ["spike"])
        self.assertEqual(recording.findings[0].frame, 7)
        self.assertTrue(np.isnan(recording.tracks[0].x[7]))
        keys["checks"] = {"spike": "refuse"}
        with self.assertRaisesRegex(lilytank.InputError, "leap.csv:9"):
            lilytank.read_recording(table, **keys)
        self.assertTrue(lilytank.read_recording(table, refuse=False, **keys).refused)

    def test_experiment(self):
        experiment = lilytank.read_experiment(TANK, {"tank.radius": "31 cm"})
        self.assertEqual([r.body for r in experiment.recordings], ["ball", "lily", "lily"])
        self.assertEqual([r.held_out for r in experiment.recordings], [False, False, True])
        self.assertEqual(experiment.scenario["tank.radius"], 0.31)
        self.assertEqual(len(experiment.recordings[1].tracks[0].theta), 600)

    @needs("pandas")
    def test_pandas(self):
        frame = lilytank.read_recording(self.balls, body="ball").to_pandas()
        self.assertEqual(list(frame.columns), ["frame", "time", "id", "x", "y"])
        self.assertEqual(frame.id.nunique(), 24)

    @needs("xarray")
    def test_xarray(self):
        data = lilytank.read_recording(self.balls, body="ball").to_xarray()
        self.assertEqual(dict(data.sizes), {"time": 600, "id": 24})


if __name__ == "__main__":
    unittest.main()
