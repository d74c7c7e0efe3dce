"""Recordings of trackers, read and checked as `lilytank recording` does."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._scenario import Scenario, split
from ._tables import needed
from ._values import PathLike, assignments

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Track:
    """One body seen without a break of its identity. Frames in which it was not seen hold NaN."""

    id: int
    first: int
    """Frame of the first sighting."""
    x: np.ndarray
    """m, from the tank's centre; no copy."""
    y: np.ndarray
    theta: np.ndarray | None
    """Heading, rad, unwrapped; None where none was tracked."""


@dataclass(frozen=True)
class Finding:
    """Something that a check found."""

    check: str
    """gap, duplicate, spike, jump, swap, ...: docs/recordings.md."""
    treatment: str
    """keep, mark, split or refuse."""
    file: str
    line: int
    frame: int
    id: int
    what: str
    text: str
    """The line that the program prints."""


@dataclass(frozen=True)
class Recording:
    """Tracks on one even clock: frame f was taken at start + f / rate."""

    name: str
    body: str
    """lily, ball or point."""
    rate: float
    """Frames per second."""
    start: float
    """Time of frame 0, s."""
    frames: int
    tracks: list[Track] = field(repr=False)
    latches: bool = True
    held_out: bool = False
    findings: list[Finding] = field(default_factory=list, repr=False)
    format: str = ""
    rows: int = 0
    """Sightings in the files."""
    refused: bool = False
    """Whether a check refuses it; it then has no tracks."""
    unused_columns: list[str] = field(default_factory=list)

    @property
    def time(self) -> np.ndarray:
        """[frames] s."""
        return self.start + np.arange(self.frames) / self.rate

    def to_pandas(self) -> "pandas.DataFrame":
        """As a DataFrame with one row a sighting: frame, time, id, x, y, theta. Needs pandas."""
        pandas = needed("pandas")
        frames = []
        for t in self.tracks:
            number = t.first + np.arange(len(t.x))
            columns = {
                "frame": number,
                "time": self.start + number / self.rate,
                "id": t.id,
                "x": t.x,
                "y": t.y,
            }
            frames.append(
                pandas.DataFrame(columns if t.theta is None else columns | {"theta": t.theta})
            )
        return (
            pandas.concat(frames, ignore_index=True).dropna(subset="x")
            if frames
            else pandas.DataFrame()
        )

    def to_xarray(self) -> "xarray.Dataset":
        """As a Dataset over time and id, NaN where a body was not seen. Needs xarray."""
        xarray = needed("xarray")
        ids = sorted({t.id for t in self.tracks})
        names = ("x", "y") if any(t.theta is None for t in self.tracks) else ("x", "y", "theta")
        arrays = {name: np.full((self.frames, len(ids)), np.nan) for name in names}
        for t in self.tracks:
            for name, array in arrays.items():
                array[t.first : t.first + len(t.x), ids.index(t.id)] = getattr(t, name)
        variables = {name: (("time", "id"), array) for name, array in arrays.items()}
        return xarray.Dataset(variables, coords={"time": self.time, "id": ids})


@dataclass(frozen=True)
class Experiment:
    """A tank, its bodies, and what was recorded in it."""

    name: str
    scenario: Scenario
    recordings: list[Recording]
    findings: list[Finding]


def _recording(parts: dict[str, Any]) -> Recording:
    parts["tracks"] = [Track(*one) for one in parts["tracks"]]
    parts["findings"] = [Finding(**one) for one in parts.get("findings", [])]
    return Recording(**parts)


def read_recording(
    *files: PathLike,
    refuse: bool = True,
    overrides: Mapping[str, Any] | None = None,
    **read: Any,
) -> Recording:
    """Reads and checks one recording: a file, or a directory, pattern or list with a file a track.

    Keywords are the keys of a [[recording]] (docs/recordings.md): format="trackpy", rate=25,
    tank_circle=[640, 480, 455], columns={"x": "px"}, checks={"swap": "mark"}. `overrides` are
    values of the tank and the bodies. InputError where a check refuses the recording, unless
    `refuse` is False.
    """
    paths = [os.fspath(file) for file in files]
    return _recording(
        _core.read_recording(
            paths, list(assignments(read)), list(assignments(overrides or {})), refuse
        )
    )


def read_experiment(*sources: PathLike | Mapping[str, Any]) -> Experiment:
    """Reads an experiment from files and dicts of overrides, as Scenario does, with all its
    recordings.
    """
    files, sets = split(sources)
    found = _core.read_experiment(files, sets)
    return Experiment(
        found["name"],
        Scenario._of(files, sets, found["scenario"]),
        [_recording(one) for one in found["recordings"]],
        [Finding(**one) for one in found["findings"]],
    )
