"""Values of Python as the text that the command line takes."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import tempfile
import tomllib
import weakref
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Union

import numpy as np

PathLike = Union[str, "os.PathLike[str]"]
#: False: silent. True: a line on stderr. A function is called as progress(done, note); done is
#: the fraction that is done.
Progress = Union[bool, Callable[[float, str], None]]


class TemporaryDirectory:
    """A directory that is removed, with its files, when this object or the process ends."""

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix="lilytank-")
        weakref.finalize(self, shutil.rmtree, self.name, ignore_errors=True)


def toml(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(toml(one) for one in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + "}"
    raise TypeError(f"{value!r} is not a value of a scenario: a number, text, bool or list")


def _assigned(value: Any) -> str:
    """A value as --set takes it: text that is no other TOML value needs no quotes."""
    if isinstance(value, (str, os.PathLike)):
        text = os.fspath(value)
        if re.fullmatch(r"[\w.,/%+-]+( [\w.,/%+-]+)*", text):
            try:
                tomllib.loads("v = " + text)
            except tomllib.TOMLDecodeError:
                return text
    return toml(value)


def assignments(values: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """{"tank": {"radius": 0.3}} and {"tank.radius": 0.3} as "tank.radius=0.3"."""
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from assignments(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}={_assigned(value)}"


def reporter(progress: Progress) -> Callable[[float, str], None] | None:
    """The function that a job calls."""
    if progress is True:
        return _print_progress
    return None if progress is False or progress is None else progress


def _print_progress(done: float, note: str) -> None:
    print(
        f"\r{100 * done:5.1f} %  {note:60.60}",
        end="\n" if done >= 1 else "",
        file=sys.stderr,
        flush=True,
    )
