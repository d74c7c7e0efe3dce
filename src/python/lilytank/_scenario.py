"""Scenarios from files and overrides."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from . import _core
from ._values import PathLike, assignments


def split(sources: Iterable[PathLike | Mapping[str, Any]]) -> tuple[list[str], list[str]]:
    """Files, and dicts of overrides as --set takes them."""
    files: list[str] = []
    sets: list[str] = []
    for source in sources:
        if isinstance(source, Mapping):
            sets += assignments(source)
        else:
            files.append(os.fspath(source))
    return files, sets


class Entry(NamedTuple):
    """A value of a scenario, with what `lilytank info` prints about it."""

    path: str
    text: str
    """The value as TOML, in the key's unit."""
    unit: str
    bounds: str
    meaning: str
    is_default: bool
    where: str
    """File and line that set it; empty for defaults."""

    @property
    def value(self) -> Any:
        """The value as a number, str, bool or list."""
        return tomllib.loads("v = " + self.text)["v"]


class Scenario(Mapping[str, Any]):
    """A tank with modules and balls, ready to run.

    `sources` are files and dicts of overrides. Later files override earlier ones, and dicts
    override all files, as --set does: {"tank": {"radius": "30 cm"}, "module.count": 20}. A value is
    a number in SI units or text with a unit. `seed` overrides run.seed. As a mapping, a scenario
    holds each value by its path: scenario["tank.radius"].
    """

    def __init__(self, *sources: PathLike | Mapping[str, Any], seed: int | None = None) -> None:
        files, sets = split(sources)
        self._take(files, sets + ([] if seed is None else [f"run.seed={int(seed)}"]))

    def _take(self, files: list[str], sets: list[str], core: Any = None) -> None:
        self.files = files
        """Files, later ones over earlier ones."""
        self.sets = sets
        """The overrides as --set takes them."""
        self._core = core or _core.Scenario(files, sets)
        self._entries: dict[str, Entry] | None = None

    @classmethod
    def _of(cls, files: list[str], sets: list[str], core: Any = None) -> "Scenario":
        scenario = cls.__new__(cls)
        scenario._take(files, sets, core)
        return scenario

    def replace(
        self, *sources: PathLike | Mapping[str, Any], seed: int | None = None
    ) -> "Scenario":
        """The same scenario with further files and overrides. They override this scenario's."""
        files, sets = split(sources)
        seeds = [] if seed is None else [f"run.seed={int(seed)}"]
        return Scenario._of(self.files + files, self.sets + sets + seeds)

    @property
    def entries(self) -> dict[str, Entry]:
        """Every value by its path, with unit, bounds, meaning and the place that set it."""
        if self._entries is None:
            self._entries = {entry[0]: Entry(*entry) for entry in self._core.entries()}
        return self._entries

    def __getitem__(self, path: str) -> Any:
        return self.entries[path].value

    def __iter__(self) -> Iterator[str]:
        return iter(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def __repr__(self) -> str:
        bodies = f"{self.modules} modules, {self.balls} balls"
        return f"<Scenario {self.title!r}: {bodies}, {self.duration:g} s, seed {self.seed}>"

    @property
    def title(self) -> str:
        """Name of the scenario."""
        return self._core.title

    @property
    def duration(self) -> float:
        """Simulated time of a run, s."""
        return self._core.duration

    @property
    def seed(self) -> int:
        """Key of all random numbers."""
        return self._core.seed

    @property
    def dt(self) -> float:
        """Time step, s."""
        return self._core.dt

    @property
    def modules(self) -> int:
        """Number of modules."""
        return self._core.modules

    @property
    def balls(self) -> int:
        """Number of balls."""
        return self._core.balls

    @property
    def resolved(self) -> str:
        """The scenario as one TOML text with every value: resolved.toml of a run."""
        return self._core.resolved

    @property
    def identity(self) -> str:
        """Hash of `resolved` and the files that it names, 16 hexadecimal digits."""
        return self._core.identity

    @property
    def rules(self) -> list[str]:
        """The rulesets as text; the first one is in force at the start."""
        return self._core.rules
