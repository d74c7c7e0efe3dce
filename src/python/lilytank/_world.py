"""Simulations step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from . import _core
from ._run import Force
from ._scenario import Scenario


class Event(NamedTuple):
    """Something that happened in a step. Numbers that do not apply are -1."""

    time: float
    """s."""
    kind: str
    """latch, unlatch, link, unlink, update, report or command."""
    module_a: int
    face_a: int
    module_b: int
    face_b: int
    rule: int
    """Position in the ruleset in force."""


class World:
    """One simulation, step by step: the same bits as `run`.

    Arrays over bodies (modules first) follow the simulation without a copy. `seed` replaces the
    scenario's. `forces` are as in `run`. With `applies`, the array `applied` acts on the bodies.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int | None = None,
        *,
        forces: Sequence[Force] = (),
        applies: bool = False,
    ) -> None:
        self.scenario = scenario
        key = scenario.seed if seed is None else seed
        self._core = _core.World(scenario._core, scenario.files, key, list(forces), applies)
        views = ("x", "y", "vx", "vy", "omega", "latched")
        self.x, self.y, self.vx, self.vy, self.omega, self.latched = (
            getattr(self._core, v) for v in views
        )
        self.applied: np.ndarray = self._core.applied
        """[bodies, 3] Force (N) and torque (N m) on each body in the next steps; writable. Empty
        without `applies`.
        """

    def step(self, steps: int = 1) -> bool:
        """Advances by `steps` time steps; False once the simulation has diverged. Ctrl-C interrupts
        it.
        """
        return self._core.step(steps)

    def advance(
        self,
        seconds: float,
        every: int | None = None,
        callback: Callable[["World"], object] | None = None,
    ) -> bool:
        """Advances by `seconds`, and calls callback(world) each `every` steps.

        Ends early, with False, once the simulation has diverged or the callback returns False.
        """
        if (every is None) != (callback is None):
            raise TypeError("'every' and 'callback' go together")
        left = round(seconds / self.dt)
        while left > 0:
            part = left if every is None else min(every, left)
            left -= part
            if not self.step(part):
                return False
            if callback is not None and part == every and callback(self) is False:
                return False
        return True

    def snapshot(self) -> bytes:
        """The whole state. `restore` continues from it with the same bits."""
        return self._core.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Continues from a snapshot of a World of the same scenario. InputError for another one."""
        self._core.restore(snapshot)

    @property
    def events(self) -> list[Event]:
        """Events of the last call of `step`, in order."""
        return [Event(*event) for event in self._core.events()]

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._core.time

    @property
    def steps(self) -> int:
        """Steps since the start."""
        return self._core.steps

    @property
    def dt(self) -> float:
        """Time step, s."""
        return self._core.dt

    @property
    def modules(self) -> int:
        """Bodies [0, modules) are modules, the rest balls."""
        return self._core.modules

    @property
    def bodies(self) -> int:
        """Number of bodies."""
        return self._core.bodies

    @property
    def theta(self) -> np.ndarray:
        """Headings, rad, in (-pi, pi]; a copy."""
        return self._core.theta

    @property
    def labels(self) -> np.ndarray:
        """[modules] Control states l_a; a copy."""
        return self._core.labels

    @property
    def partners(self) -> np.ndarray:
        """[modules, 4] The module that each face holds, -1: none; a copy."""
        return self._core.partners

    @property
    def copies(self) -> int:
        """Completed copies of the target now."""
        return self._core.copies

    @property
    def possible(self) -> int:
        """The most copies that the modules can form."""
        return self._core.possible

    @property
    def completion_times(self) -> list[float]:
        """When 1, 2, ... copies were first complete, s."""
        return self._core.completion_times

    @property
    def by_size(self) -> list[int]:
        """Assemblies by number of modules; [0] is unused."""
        return self._core.by_size

    @property
    def illegal(self) -> int:
        """Appearances of assemblies that the ruleset cannot build: 0."""
        return self._core.illegal

    @property
    def divergence(self) -> str:
        """Why the simulation was given up; empty: it was not."""
        return self._core.divergence

    @property
    def fingerprint(self) -> str:
        """Hash of the state: equal states have equal fingerprints."""
        return self._core.fingerprint

    def __repr__(self) -> str:
        copies = f"{self.copies} of {self.possible} copies"
        return f"<World: {self.bodies} bodies at {self.time:g} s, {copies}>"
