"""Reports of verbs as plain objects."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from typing import Any

from ._tables import Table, _column


@dataclass(frozen=True)
class Section:
    """A section of a report: paragraphs and a table."""

    title: str
    above: list[str]
    """Paragraphs above the table."""
    head: list[str]
    """Titles of the table's columns, with units."""
    rows: list[list[str]]
    """Cells as printed."""
    below: list[str]
    """Paragraphs below the table."""

    @property
    def table(self) -> Table:
        """The section's table: columns of numbers are arrays of float64."""
        return Table(
            {name: _column([row[i] for row in self.rows]) for i, name in enumerate(self.head)}
        )


@dataclass(frozen=True)
class Report:
    """What a verb reports: verdict, facts, and sections with tables. `print(report)` prints it as
    the program does.
    """

    title: str
    subtitle: str
    tone: str
    """neutral, good, finding or fault."""
    verdict: str
    facts: dict[str, str]
    """Name and value as printed."""
    sections: list[Section]
    warnings: list[str]
    inputs: dict[str, str]
    """SHA-256 of each file that was read."""
    command: str
    """The command line that does the same; empty for runs."""
    text: str = field(repr=False)
    """The whole report as text."""

    def __getitem__(self, title: str) -> Section:
        """The first section with this title."""
        for section in self.sections:
            if section.title == title:
                return section
        raise KeyError(f"{title!r}; there are: {', '.join(repr(s.title) for s in self.sections)}")

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


def report_of(parts: dict[str, Any]) -> Report:
    """From _core."""
    sections = [Section(**section) for section in parts["sections"]]
    rest = {"facts": dict(parts["facts"]), "inputs": dict(parts["inputs"]), "sections": sections}
    return Report(**{**parts, **rest})
