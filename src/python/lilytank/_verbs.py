"""The verbs of the command line as functions."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Union

from . import _core
from ._report import Report, report_of
from ._run import Run
from ._tables import Table, read_table
from ._values import PathLike, Progress, TemporaryDirectory, assignments, reporter

#: A file, or a run.
Source = Union[PathLike, Run]


@dataclass(frozen=True)
class Result:
    """What a verb found."""

    reports: list[Report] = field(repr=False)
    """Usually one. A study after an optimisation is the second."""
    text: str = field(repr=False)
    """What the program prints."""
    notes: str = field(repr=False)
    """What the program prints to standard error."""
    ok: bool
    """False where a simulation diverged or a check found a fault: exit code 1."""
    directory: Path | None
    """Files of the results. Without `out` it is temporary, and removed with this object."""
    _kept: Any = field(default=None, repr=False)

    @property
    def report(self) -> Report:
        """Verdict, facts, and sections with tables."""
        return self.reports[0]

    @property
    def files(self) -> list[str]:
        """Names of the files in the directory."""
        return (
            sorted(p.name for p in self.directory.iterdir() if p.is_file())
            if self.directory
            else []
        )

    def table(self, name: str) -> Table:
        """A table of the directory, by its file's name without ".csv"."""
        return read_table(self.path(name + ".csv"))

    def json(self, name: str) -> Any:
        """A JSON file of the directory, by its name without ".json"."""
        return json.loads(self.path(name + ".json").read_text(encoding="utf-8"))

    def path(self, name: str) -> Path:
        """A file of the directory, as "calibrated.toml". FileNotFoundError names those that there
        are.
        """
        path = Path() if self.directory is None else self.directory / name
        if not path.is_file():
            raise FileNotFoundError(
                f"there is no {name!r}; there are: {', '.join(self.files) or 'no files'}"
            )
        return path

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return self.report._repr_html_() if self.reports else f"<pre>{self.text}</pre>"


def _words(options: Mapping[str, Any]) -> list[str]:
    words: list[str] = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if isinstance(value, bool):
            words += [option] if value else []
            continue
        if value is None:
            continue
        values = list(assignments(value)) if isinstance(value, Mapping) else value
        for one in values if isinstance(values, (list, tuple)) else [values]:
            text = str(os.fspath(one) if isinstance(one, (str, os.PathLike)) else one)
            words += [option + "=" + text] if text.startswith("-") else [option, text]
    return words


def verb(name: str, /, *sources: Source, progress: Progress = False, **options: Any) -> Result:
    """Does what `lilytank NAME SOURCES... --OPTION VALUE...` does.

    Keywords are the verb's options with "_" for "-": hold_out=1, msd_only=True, name=["a", "b"]. A
    trailing "_" is left out, as in from_=10. A dict becomes assignments: set={"run.dt": "5 ms"}.
    Warnings that the program prints are Python's. Ctrl-C stops the job, and the same call with the
    same `out` resumes it. One verb runs at a time.
    """
    directory = options.get("out")
    files = [os.fspath(s.directory) if isinstance(s, Run) else os.fspath(s) for s in sources]
    words = [*files, *_words(options)]
    if any(word.startswith("-") for word in files):
        words = [*_words(options), "--", *files]
    found = _core.verb([*name.split(), *words], reporter(progress))
    for line in found["err"].splitlines():
        if line.startswith("warning: "):
            warnings.warn(line.removeprefix("warning: "), stacklevel=3)
    reports = [report_of(one) for one in found["reports"]]
    path = None if directory is None else Path(directory)
    return Result(reports, found["out"], found["err"], found["code"] == 0, path)


def _job(name: str, sources: tuple[Source, ...], out: PathLike | None, /, **options: Any) -> Result:
    """A verb with a directory of results, a temporary one without `out`."""
    kept = None
    if out is None:
        kept = TemporaryDirectory()
        out = kept.name
    found = verb(name, *sources, out=out, **options)
    return Result(found.reports, found.text, found.notes, found.ok, Path(out), kept)


def study(file: PathLike, *, out: PathLike | None = None, **options: Any) -> Result:
    """Runs a study: all settings, replicates, statistics. `table("table")` has one row a run.

    Options are those of `lilytank study` (docs/study.md): set={...}, threads=2, shard="1/4".
    progress as in `run`.
    """
    return _job("study", (file,), out, **options)


def optimize(file: PathLike, *, out: PathLike | None = None, **options: Any) -> Result:
    """Searches probabilities, pump power or rulesets for what builds a target best
    (docs/optimization.md).
    """
    return _job("optimize", (file,), out, **options)


def flow(*sources: Source, out: PathLike | None = None, **options: Any) -> Result:
    """Estimates the water's velocity from tracks of balls (docs/flow.md).

    `table("cells_smooth")` holds the grid with its errors, and `path("flow_smooth.csv")` is the
    grid that a scenario reads as flow.file.
    """
    return _job("flow", sources, out, **options)


def analyze(*sources: Source, out: PathLike | None = None, **options: Any) -> Result:
    """Displacements, velocities, maps and contacts (docs/analysis.md).

    `table("msd_all")` and others hold the curves with their bands.
    """
    return _job("analyze", sources, out, **options)


def calibrate(*sources: Source, out: PathLike | None = None, **options: Any) -> Result:
    """Estimates model parameters with intervals from recordings (docs/calibration.md).

    `table("intervals")` holds them, and `path("calibrated.toml")` overrides a scenario's values
    with the estimates.
    """
    return _job("calibrate", sources, out, **options)


def diagnose(*sources: Source, out: PathLike | None = None, **options: Any) -> Result:
    """Identifies physical effects that the model omits, from recordings (docs/diagnosis.md).

    `json("diagnosis")` holds the findings, and `path("missing.toml")` adds them to a scenario.
    """
    return _job("diagnose", sources, out, **options)


def check(ruleset: PathLike, **options: Any) -> Result:
    """Proves what a ruleset can build, and where it deadlocks (docs/synthesis.md). `ok` is False
    for a fault.
    """
    return verb("check", ruleset, **options)


def synthesize(target: PathLike, *, out: PathLike | None = None, **options: Any) -> Result:
    """A ruleset from the drawing of a target (docs/synthesis.md): `text`, or the file `out`."""
    found = verb("synthesize", target, out=out, **options)
    return Result([], found.text, found.notes, found.ok, None)


def render(run: Source, **options: Any) -> None:
    """Draws a run (docs/rendering.md): at=300, png="frame.png", or from_=0, to=60, mp4="film.mp4"."""
    verb("render", run, **options)


def view(*sources: Source, out: PathLike, **options: Any) -> None:
    """Writes an interactive page of runs, a study or a diagnosis to `out` (docs/view.md)."""
    verb("view", *sources, out=out, **options)
