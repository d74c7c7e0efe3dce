"""Simulator of floating robotic modules that assemble themselves.

    import lilytank

    scenario = lilytank.Scenario("scenarios/chain5.toml", {"run.duration": "10 min"}, seed=1)
    run = lilytank.run(scenario)
    run.trajectory.x       # [frames, bodies], m
    run.events.to_pandas()

The numbers are those of the command-line program, to the last bit. Invalid input raises InputError
with the line that the program prints. docs/python.md describes the package.
"""

from ._core import InputError, __version__
from ._recording import Experiment, Finding, Recording, Track, read_experiment, read_recording
from ._report import Report, Section
from ._run import Run, Trajectory, load_run, run
from ._scenario import Entry, Scenario
from ._tables import Table, read_table
from ._verbs import (
    Result,
    analyze,
    calibrate,
    check,
    diagnose,
    flow,
    optimize,
    render,
    study,
    synthesize,
    verb,
    view,
)
from ._world import Event, World

__all__ = [
    "Entry",
    "Event",
    "Experiment",
    "Finding",
    "InputError",
    "Recording",
    "Report",
    "Result",
    "Run",
    "Scenario",
    "Section",
    "Table",
    "Track",
    "Trajectory",
    "World",
    "__version__",
    "analyze",
    "calibrate",
    "check",
    "diagnose",
    "flow",
    "load_run",
    "optimize",
    "read_experiment",
    "read_recording",
    "read_table",
    "render",
    "run",
    "study",
    "synthesize",
    "verb",
    "view",
]
