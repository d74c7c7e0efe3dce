"""Tables by column, and their conversion to pandas and xarray."""

from __future__ import annotations

import csv
import importlib
import importlib.util
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from ._values import PathLike

if TYPE_CHECKING:
    import pandas
    import xarray


def needed(module: str) -> ModuleType:
    """A package that only conversions need."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(
            f"this conversion needs {module}: install python3-{module} or 'pip install {module}'"
        ) from error


class Table(Mapping[str, np.ndarray]):
    """Columns of equal length by name.

    Numbers are arrays, in a run's events and metrics without a copy. Words are stored as codes;
    `table[name]` makes an array of str of them.
    """

    def __init__(self, columns: Mapping[str, Any], index: str | None = None) -> None:
        self._columns = dict(columns)
        self._index = index

    def __getitem__(self, name: str) -> np.ndarray:
        column = self._columns[name]
        if isinstance(column, tuple):
            codes, words = column
            return np.array(words, dtype=str)[codes] if words else np.array([], dtype=str)
        return column

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Number of columns; `rows` is the number of rows."""
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        for column in self._columns.values():
            return len(column[0] if isinstance(column, tuple) else column)
        return 0

    def __repr__(self) -> str:
        return f"Table({self.rows} rows: {', '.join(self._columns)})"

    def to_pandas(self) -> "pandas.DataFrame":
        """As a DataFrame; words are categorical. Needs pandas."""
        pandas = needed("pandas")
        frame = pandas.DataFrame(
            {
                name: pandas.Categorical.from_codes(*column)
                if isinstance(column, tuple)
                else column
                for name, column in self._columns.items()
            },
            copy=False,
        )
        return frame

    def to_xarray(self) -> "xarray.Dataset":
        """As a Dataset over its first column of times, or else over `row`. Needs xarray."""
        xarray = needed("xarray")
        along = self._index or "row"
        return xarray.Dataset({name: (along, self[name]) for name in self._columns})

    def _repr_html_(self) -> str | None:
        return self.to_pandas()._repr_html_() if importlib.util.find_spec("pandas") else None


def read_table(file: PathLike) -> Table:
    """Reads a CSV file of results. A column of numbers is float64, NaN where a cell is empty;
    others are text.
    """
    with open(file, newline="", encoding="utf-8") as text:
        rows = [row for row in csv.reader(text) if row and not row[0].startswith("#")]
    if not rows:
        return Table({})
    head, rows = rows[0], rows[1:]
    return Table(
        {
            name: _column([row[i] if i < len(row) else "" for row in rows])
            for i, name in enumerate(head)
        }
    )


def _column(cells: list[str]) -> Any:
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        words = list(dict.fromkeys(cells))
        places = {word: code for code, word in enumerate(words)}
        return np.array([places[cell] for cell in cells], dtype=np.int32), words
