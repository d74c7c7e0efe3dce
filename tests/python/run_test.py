"""lilytank.run: the bits of the command-line program, and arrays without a copy."""

import gc
import os
import signal
import threading
import unittest

import numpy as np

import lilytank
from support import CHAIN, SCENARIOS, TestCase, needs, program

FILES = ("trajectory.bin", "events.csv", "metrics.csv", "species.csv", "rules.csv", "summary.json")


class Run(TestCase):
    def assertSameFiles(self, first, second, names=FILES):
        for name in names:
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_files_are_those_of_the_program(self):
        overrides = SCENARIOS / "p_optimised_chain.toml"
        words = ["run", CHAIN, overrides, "--seed", "7", "--set", "run.duration=5 min"]
        cli = program(*words, "--set", "module.count=20", "--out", self.here / "cli", "--quiet")
        self.assertEqual(cli.returncode, 0, cli.stderr)
        values = {"run": {"duration": "5 min"}, "module.count": 20}
        run = lilytank.run(lilytank.Scenario(CHAIN, overrides, values, seed=7), self.here / "py")
        self.assertSameFiles(self.here / "cli", self.here / "py")
        self.assertEqual(run.summary, cli.stdout)
        self.assertIn("fingerprint     " + run.fingerprint, cli.stdout)
        stored = lilytank.load_run(self.here / "cli")
        self.assertEqual(stored.fingerprint, run.fingerprint)
        np.testing.assert_allclose(stored.completion_times, run.completion_times)
        self.assertTrue(np.array_equal(stored.trajectory.x, run.trajectory.x))

    def test_stepping_has_the_bits_of_a_run(self):
        scenario = lilytank.Scenario(CHAIN, {"run.duration": "1 min"}, seed=3)
        run, world = lilytank.run(scenario), lilytank.World(scenario)
        while world.time < 60:
            world.step(7 if world.steps + 7 <= 2400 else 1)
        self.assertEqual(world.fingerprint, run.fingerprint)
        self.assertTrue(np.array_equal(run.trajectory.x[-1], world.x.astype(np.float32)))

    def test_arrays_are_views_of_what_was_stored(self):
        values = {"run.duration": "20 s", "output.trajectory": "csv", "ball.count": 2}
        run = lilytank.run(lilytank.Scenario(CHAIN, values))
        t = run.trajectory
        self.assertEqual((t.bodies, t.modules, len(t)), (17, 15, len(t.time)))
        table = lilytank.read_table(run.directory / "trajectory.csv")
        for name in ("x", "y", "theta"):
            array = getattr(t, name)
            self.assertEqual((array.shape, array.dtype), ((len(t), 17), np.float32))
            self.assertFalse(array.flags.owndata or array.flags.writeable)
            self.assertTrue(np.array_equal(array.ravel(), table[name].astype(np.float32)), name)
        self.assertTrue(np.shares_memory(t.x, run.trajectory.x))
        modules = t.markings["latched"][:, :15].ravel()
        cells = table["latched"].reshape(len(t), 17)[:, :15].ravel()
        self.assertTrue(np.array_equal(modules, cells))
        x = t.x
        del run, t
        self.assertEqual(x.shape, (table.rows // 17, 17))  # the array keeps its data alive

    def test_events_and_metrics_are_the_columns_of_the_files(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "5 min"}))
        for name, table in (("events", run.events), ("metrics", run.metrics)):
            file = lilytank.read_table(run.directory / f"{name}.csv")
            self.assertEqual(list(table), list(file))
            for column in table:
                if table[column].dtype.kind == "U":
                    self.assertTrue(np.array_equal(table[column], file[column]), column)
                    continue
                cells = np.nan_to_num(file[column], nan=-1)
                self.assertTrue(np.array_equal(table[column], cells), column)
        self.assertFalse(run.events["time"].flags.owndata)
        self.assertEqual(
            run.report["Rules"].table["times applied"].sum(),
            np.isin(run.events["kind"], ["link", "unlink", "update"]).sum(),
        )

    def test_temporary_files_go_with_the_run(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "1 s"}))
        directory, x = run.directory, run.trajectory.x
        self.assertTrue((directory / "trajectory.bin").exists())
        del run
        gc.collect()
        self.assertFalse(directory.exists())
        self.assertTrue(np.isfinite(x).all())

    def test_interrupted_run_resumes_to_the_same_bytes(self):
        scenario = lilytank.Scenario(CHAIN, {"run.duration": "2 h", "output.rate": 0.5})
        reports = []

        def interrupt(done, note):
            reports.append(done)
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            lilytank.run(scenario, self.here / "a", progress=interrupt)
        self.assertTrue(0 < reports[0] < 1)
        self.assertTrue(lilytank.run(scenario, self.here / "a").resumed)
        self.assertTrue(lilytank.run(scenario, self.here / "a").already_complete)
        lilytank.run(scenario, self.here / "b")
        self.assertSameFiles(self.here / "a", self.here / "b")

    def test_exception_of_progress_ends_the_run(self):
        def fail(done, note):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "48 h"}), progress=fail)

    def test_other_threads_run_meanwhile(self):
        scenario = lilytank.Scenario(CHAIN, {"run.duration": "10 min"})
        prints = {}

        def simulate(k):
            prints[k] = lilytank.run(scenario).fingerprint

        threads = [threading.Thread(target=simulate, args=(k,)) for k in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(prints), 3)
        self.assertEqual(len(set(prints.values())), 1)

    @needs("pandas")
    def test_pandas(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "10 s"}))
        frame = run.trajectory.to_pandas()
        self.assertEqual(len(frame), run.trajectory.x.size)
        one = frame[frame.body == 3]
        self.assertTrue(np.array_equal(one.x, run.trajectory.x[:, 3]))
        self.assertEqual(list(run.events.to_pandas().columns), list(run.events))
        self.assertEqual(run.events.to_pandas().kind[0], run.events["kind"][0])

    @needs("xarray")
    def test_xarray(self):
        run = lilytank.run(lilytank.Scenario(CHAIN, {"run.duration": "10 s"}))
        data = run.trajectory.to_xarray()
        self.assertEqual(data.x.dims, ("time", "body"))
        self.assertTrue(np.array_equal(data.theta.sel(body=3), run.trajectory.theta[:, 3]))
        self.assertEqual(run.metrics.to_xarray().copies.dims, ("time",))


if __name__ == "__main__":
    unittest.main()
