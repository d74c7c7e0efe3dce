"""Runs: one tank from a scenario to results."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._report import Report, report_of
from ._scenario import Scenario
from ._tables import Table, needed, read_table
from ._values import PathLike, Progress, TemporaryDirectory, reporter

if TYPE_CHECKING:
    import pandas
    import xarray

#: f(time, bodies) -> (fx, fy), (fx, fy, torque) or None; see `run`.
Force = Callable[[float, Any], Any]


class Trajectory:
    """Stored poses. All arrays but `time` are [frames, bodies], modules first, without a copy and
    read-only.
    """

    def __init__(self, core: Any) -> None:
        self._core = core

    @property
    def time(self) -> np.ndarray:
        """[frames] s."""
        return self._core.time

    @property
    def x(self) -> np.ndarray:
        """m, from the tank's centre; float32, as stored."""
        return self._core.x

    @property
    def y(self) -> np.ndarray:
        """m."""
        return self._core.y

    @property
    def theta(self) -> np.ndarray:
        """Heading, rad, counter-clockwise."""
        return self._core.theta

    @property
    def markings(self) -> np.ndarray:
        """States of modules as a structured array.

        label (control state l_a), last (connector engaged last, -1: isolated), latched and bonded
        (bit f: face f holds a neighbour; by a rule), complete (1: part of a completed copy).
        """
        return self._core.markings

    @property
    def modules(self) -> int:
        """Bodies [0, modules) are modules, the rest balls."""
        return self._core.modules

    @property
    def bodies(self) -> int:
        """Number of bodies."""
        return self._core.bodies

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.time)

    def __repr__(self) -> str:
        return f"<Trajectory: {len(self)} frames of {self.bodies} bodies>"

    def to_pandas(self) -> "pandas.DataFrame":
        """As a DataFrame with one row a frame and body. Needs pandas."""
        pandas = needed("pandas")
        frames, bodies = self.x.shape
        columns = {
            "time": np.repeat(self.time, bodies),
            "body": np.tile(np.arange(bodies), frames),
            "x": self.x.ravel(),
            "y": self.y.ravel(),
            "theta": self.theta.ravel(),
        }
        if self.markings.size:
            columns |= {name: self.markings[name].ravel() for name in self.markings.dtype.names}
        return pandas.DataFrame(columns, copy=False)

    def to_xarray(self) -> "xarray.Dataset":
        """As a Dataset over time and body. Needs xarray."""
        xarray = needed("xarray")
        arrays = {"x": self.x, "y": self.y, "theta": self.theta}
        if self.markings.size:
            arrays |= {name: self.markings[name] for name in self.markings.dtype.names}
        return xarray.Dataset(
            {name: (("time", "body"), array) for name, array in arrays.items()},
            coords={"time": self.time, "body": np.arange(self.bodies)},
        )


@dataclass
class Run:
    """A finished run and its files."""

    scenario: Scenario
    directory: Path
    """Its files. Without `out` it is temporary, and removed with this object."""
    diverged: bool = False
    """Whether the simulation was given up; `divergence` says why."""
    divergence: str = ""
    time: float = 0
    """Simulated time, s."""
    wall: float = 0
    """Wall time of the call, s."""
    fingerprint: str = ""
    """Hash of the final state: equal for equal scenarios and seeds."""
    copies: int = 0
    """Completed copies of the target at the end."""
    possible: int = 0
    """The most copies that the modules can form."""
    completion_times: list[float] = field(default_factory=list)
    """When 1, 2, ... copies were first complete, s."""
    illegal: int = 0
    """Appearances of assemblies that the ruleset cannot build: 0."""
    resumed: bool = False
    """Whether the call continued an interrupted run in `out`."""
    already_complete: bool = False
    """Whether `out` held the finished run."""
    _kept: Any = field(default=None, repr=False)

    @cached_property
    def trajectory(self) -> Trajectory:
        """Stored poses. InputError where output.trajectory is "none"."""
        for name in ("trajectory.bin", "trajectory.csv"):
            if (self.directory / name).exists():
                return Trajectory(_core.read_trajectory(str(self.directory / name)))
        return Trajectory(_core.load_run(str(self.directory))["trajectory"])

    @cached_property
    def events(self) -> Table:
        """Latches, rules that fired, copies, commands: the columns of events.csv, -1 where a cell
        is empty.
        """
        return Table(_core.read_run_table(str(self.directory / "events.csv")), index="time")

    @cached_property
    def metrics(self) -> Table:
        """Copies and assemblies by size over time: the columns of metrics.csv."""
        return Table(_core.read_run_table(str(self.directory / "metrics.csv")), index="time")

    @cached_property
    def report(self) -> Report:
        """The report of the run: copies, assemblies, rules."""
        return report_of(_core.run_report(self.scenario._core, str(self.directory)))

    @property
    def summary(self) -> str:
        """summary.txt, which the program prints."""
        return (self.directory / "summary.txt").read_text(encoding="utf-8")

    def table(self, name: str) -> Table:
        """Another table of the run: "species" or "rules"."""
        return read_table(self.directory / f"{name}.csv")


def run(
    scenario: Scenario,
    out: PathLike | None = None,
    *,
    force: bool = False,
    forces: Sequence[Force] = (),
    progress: Progress = False,
) -> Run:
    """Simulates one tank; the same bits as `lilytank run`.

    `out` is the directory of the results, as of the command: an interrupted run in it is resumed,
    and `force` replaces another run's files. Without it the files are temporary. Ctrl-C stops the
    run.

    `forces` are functions f(time, bodies) that try an idea: they return (fx, fy) or (fx, fy,
    torque) on all bodies in N and N m, numbers or arrays, or None. bodies has arrays x, y (m), cos,
    sin (of the heading), vx, vy (m/s), omega (rad/s), and the number `modules`. They are called
    every step and make runs many times slower, and such a run cannot be stored: write a force term
    in C++ for that (docs/structure.md).
    """
    if forces and out is not None:
        raise _core.InputError(
            "a run with forces in Python cannot be stored: leave out the directory 'out'"
        )
    kept = None
    if out is None:
        kept = TemporaryDirectory()
        out = kept.name
    found = _core.run(
        scenario._core, scenario.files, os.fspath(out), force, list(forces), reporter(progress)
    )
    return Run(scenario, Path(out), **found, _kept=kept)


def load_run(directory: PathLike) -> Run:
    """A stored run: of this package, or of `lilytank run`. InputError if its files were changed."""
    path = Path(directory)
    found = _core.load_run(str(path))
    scenario = Scenario._of([str(path / "resolved.toml")], [], found["scenario"])
    run = Run(scenario, path)
    run.trajectory = Trajectory(found["trajectory"])
    run.time = float(run.trajectory.time[-1])
    if (path / "summary.json").exists():
        summary = json.loads((path / "summary.json").read_text(encoding="utf-8"))
        run.already_complete, run.time = True, summary["time_s"]
        run.diverged, run.divergence = summary["status"] == "diverged", summary.get(
            "divergence", ""
        )
        run.fingerprint, run.illegal = summary["fingerprint"], summary["illegal"]
        run.copies, run.possible = summary["copies"], summary["possible_copies"]
        run.completion_times = summary["completion_times_s"]
    return run
