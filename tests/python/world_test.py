"""lilytank.World: stepping, callbacks, snapshots, forces in Python."""

import signal
import unittest

import numpy as np

import lilytank
from support import CHAIN, SCENARIOS, TestCase

LILIES = str(SCENARIOS / "tank_lilies.toml")


class World(TestCase):
    def test_arrays_follow_the_simulation(self):
        world = lilytank.World(lilytank.Scenario(CHAIN))
        x, before = world.x, world.x.copy()
        world.step(200)
        self.assertFalse(np.array_equal(x, before))
        self.assertTrue(np.shares_memory(x, world.x))
        self.assertFalse(x.flags.writeable)
        self.assertEqual(world.theta.shape, (15,))
        self.assertEqual((world.steps, world.time), (200, 5.0))
        del world
        self.assertTrue(np.isfinite(x).all())  # the array keeps the simulation alive

    def test_callback_comes_each_k_steps(self):
        world = lilytank.World(lilytank.Scenario(CHAIN))
        seen = []
        self.assertTrue(world.advance(5, every=30, callback=lambda w: seen.append(w.steps)))
        self.assertEqual((seen, world.steps), ([30, 60, 90, 120, 150, 180], 200))
        self.assertFalse(world.advance(5, every=30, callback=lambda w: w.steps < 250))
        self.assertEqual(world.steps, 260)
        with self.assertRaises(ZeroDivisionError):
            world.advance(5, every=30, callback=lambda w: 1 / 0)

    def test_events_of_all_steps_of_a_call(self):
        scenario = lilytank.Scenario(CHAIN, {"run.duration": "1 min"})
        world, events = lilytank.World(scenario), []
        world.advance(60, every=100, callback=lambda w: events.extend(w.events))
        table = lilytank.run(scenario).events
        of_modules = table["kind"] != "copy"
        self.assertEqual([e.kind for e in events], list(table["kind"][of_modules]))
        np.testing.assert_allclose([e.time for e in events], table["time"][of_modules])
        self.assertEqual([e.module_b for e in events], list(table["module_b"][of_modules]))
        latched = (world.partners >= 0).sum(axis=1)
        np.testing.assert_array_equal(latched, [bin(faces).count("1") for faces in world.latched])

    def test_snapshot_continues_with_the_same_bits(self):
        scenario = lilytank.Scenario(
            CHAIN, SCENARIOS / "p_optimised_chain.toml", {"module.count": 25}
        )
        world = lilytank.World(scenario)
        world.step(8000)
        snapshot = world.snapshot()
        world.step(8000)
        other = lilytank.World(scenario, seed=5)
        x = other.x
        other.restore(snapshot)
        self.assertEqual(other.steps, 8000)
        other.step(8000)
        self.assertEqual(other.fingerprint, world.fingerprint)
        self.assertEqual(other.completion_times, world.completion_times)
        self.assertTrue(np.array_equal(x, world.x))
        for damaged in (b"", snapshot[:100], snapshot[:-1], snapshot[:-9] + b"x" * 9):
            with self.assertRaises(lilytank.InputError):
                other.restore(damaged)
        self.assertEqual(other.fingerprint, world.fingerprint)
        with self.assertRaises(lilytank.InputError):
            lilytank.World(lilytank.Scenario(CHAIN)).restore(snapshot)

    def test_signals_interrupt_steps(self):
        def interrupt(number, frame):
            raise TimeoutError

        self.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, interrupt))
        world = lilytank.World(lilytank.Scenario(CHAIN))
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with self.assertRaises(TimeoutError):
            world.step(10**9)
        other = lilytank.World(world.scenario)
        other.step(world.steps)
        self.assertEqual(other.fingerprint, world.fingerprint)

    def test_divergence_is_a_result(self):
        world = lilytank.World(lilytank.Scenario(LILIES), forces=[lambda t, b: (1e9, 0)])
        self.assertFalse(world.step(100))
        self.assertIn("diverged at", world.divergence)
        self.assertIn("<lambda>", world.divergence)


class Forces(TestCase):
    still = {
        "flow.K_v": 0,
        "forces.stochastic.sigma_stoch": 0,
        "module.count": 3,
        "run.duration": "1 s",
    }

    def test_force_of_python_is_that_of_the_library(self):
        values = self.still | {"forces.body_force.force_x": 1e-4}
        try:
            library = lilytank.World(lilytank.Scenario(LILIES, values))
        except lilytank.InputError as error:
            self.fail(str(error))
        python = lilytank.World(
            lilytank.Scenario(LILIES, self.still), forces=[lambda t, b: (1e-4, 0)]
        )
        library.step(40), python.step(40)
        np.testing.assert_allclose(python.vx, library.vx, rtol=1e-9)
        self.assertGreater(abs(python.vx).min(), 1e-4)

    def test_force_sees_the_bodies(self):
        seen = []

        def spring(time, bodies):
            seen.append((time, bodies))
            return -1e-3 * bodies.x, -1e-3 * bodies.y, np.full(bodies.modules, 1e-6)

        scenario = lilytank.Scenario(LILIES, self.still)
        world = lilytank.World(scenario, forces=[spring])
        x = world.x.copy()
        world.step(40)
        self.assertEqual([t for t, _ in seen[:3]], [0, 0.025, 0.05])
        np.testing.assert_array_equal(seen[0][1].x, x)
        np.testing.assert_allclose(seen[0][1].cos ** 2 + seen[0][1].sin ** 2, 1)
        self.assertTrue((abs(world.x) < abs(x)).all())
        self.assertTrue((world.omega > 0).all())
        run = lilytank.run(scenario, forces=[spring])
        self.assertEqual(run.fingerprint, world.fingerprint)

    def test_applied_wrenches_are_a_force(self):
        scenario = lilytank.Scenario(CHAIN)
        wrench = np.linspace(-1e-4, 1e-4, 45).reshape(15, 3)
        python = lilytank.World(scenario, forces=[lambda t, b: tuple(wrench.T)])
        applied = lilytank.World(scenario, applies=True)
        applied.applied[:] = wrench
        python.step(400), applied.step(400)
        self.assertEqual(python.fingerprint, applied.fingerprint)
        self.assertNotEqual(python.fingerprint, lilytank.World(scenario).fingerprint)

    def test_faults_of_a_force_are_raised(self):
        scenario = lilytank.Scenario(LILIES, {"run.duration": "100 h"})
        for force, error, text in (
            (lambda t, b: 1 / 0, ZeroDivisionError, "division"),
            (lambda t, b: 3, TypeError, "returns"),
            (lambda t, b: (b.x[:2], 0), ValueError, "2 values for"),
            (lambda t, b: ("a", 0), ValueError, "could not convert"),
        ):
            with self.assertRaisesRegex(error, text):
                lilytank.World(scenario, forces=[force]).step(3)
            with self.assertRaisesRegex(error, text):
                lilytank.run(scenario, forces=[force])
        with self.assertRaisesRegex(lilytank.InputError, "cannot be stored"):
            lilytank.run(scenario, self.here / "r", forces=[lambda t, b: None])


if __name__ == "__main__":
    unittest.main()
