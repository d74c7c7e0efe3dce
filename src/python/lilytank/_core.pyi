"""The compiled part. Users call the functions and classes of lilytank."""

from collections.abc import Callable
from typing import Any

import numpy as np

__version__: str

class InputError(ValueError):
    """Input that cannot be used; the text is the line that the command-line program prints."""

class Scenario:
    def __init__(self, files: list[str], sets: list[str]) -> None: ...
    title: str
    duration: float
    seed: int
    resolved: str
    identity: str
    dt: float
    modules: int
    balls: int
    rules: list[str]
    def entries(self) -> list[tuple[str, str, str, str, str, bool, str]]: ...

class Trajectory:
    bodies: int
    modules: int
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    theta: np.ndarray
    markings: np.ndarray

class World:
    def __init__(
        self,
        scenario: Scenario,
        files: list[str],
        seed: int,
        forces: list[Callable[[float, Any], Any]],
        applies: bool,
    ) -> None: ...
    def step(self, steps: int) -> bool: ...
    def snapshot(self) -> bytes: ...
    def restore(self, snapshot: bytes) -> None: ...
    def events(self) -> list[tuple[float, str, int, int, int, int, int]]: ...
    applied: np.ndarray
    theta: np.ndarray
    labels: np.ndarray
    partners: np.ndarray
    x: np.ndarray
    y: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    omega: np.ndarray
    latched: np.ndarray
    time: float
    steps: int
    dt: float
    modules: int
    bodies: int
    copies: int
    possible: int
    completion_times: list[float]
    by_size: list[int]
    illegal: int
    divergence: str
    fingerprint: str

def read_trajectory(file: str) -> Trajectory: ...
def read_run_table(file: str) -> dict[str, Any]: ...
def run(
    scenario: Scenario,
    files: list[str],
    out: str,
    force: bool,
    forces: list[Callable[[float, Any], Any]],
    progress: Callable[[float, str], object] | None,
) -> dict[str, Any]: ...
def run_report(scenario: Scenario, dir: str) -> dict[str, Any]: ...
def load_run(dir: str) -> dict[str, Any]: ...
def read_recording(
    files: list[str], read: list[str], sets: list[str], refuse: bool
) -> dict[str, Any]: ...
def read_experiment(files: list[str], sets: list[str]) -> dict[str, Any]: ...
def verb(words: list[str], progress: Callable[[float, str], object] | None) -> dict[str, Any]: ...
