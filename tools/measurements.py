"""Reads and checks the measurements that tests/measurement.py and tests/cpp/measurement.hpp write."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from measurement import Measurement

#: Sections of the page, in order.
SECTIONS = (
    "Surfaces",
    "Rays",
    "Lenses",
    "Scenes",
    "Sums",
    "Iteration",
    "Bundled lenses",
    "Samplers",
    "Effects",
    "Truth",
    "Other programs",
    "Computer vision",
    "Parity",
)


class MeasurementError(Exception):
    """An invalid measurement; the message has the file, the line and the reason."""


@dataclass(frozen=True)
class Figure:
    """A measurement, or that of several runs which is closest to its limit."""

    measurement: Measurement
    broken: bool  # True for an intentionally broken routine, whose error must exceed the limit
    runs: int = 1  # number of measurements from which it was selected

    @property
    def within(self) -> bool:
        """True if the error is within the limit; false for NaN."""
        return self.measurement.worst <= self.measurement.limit

    @property
    def share_of_limit(self) -> float:
        """The error over the limit; inf for NaN."""
        worst, limit = self.measurement.worst, self.measurement.limit
        if math.isnan(worst):
            return math.inf
        if limit == 0:
            return math.inf if worst > 0 else 0.0
        return worst / limit


@dataclass(frozen=True)
class Run:
    """Commit, date and machine of a run of the tests."""

    commit: str
    date: str
    processor: str
    devices: tuple[str, ...]


def read(path: Path) -> tuple[list[Figure], list[Run]]:
    """Returns the measurements and runs of a file. Raises MeasurementError for an invalid line, and if an error exceeds
    its limit or that of a broken routine does not."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise MeasurementError(f"{path}: {error.strerror}") from error
    entries = [_entry(line, f"{path}:{number}") for number, line in enumerate(lines, 1)]
    figures, runs = [e for e in entries if isinstance(e, Figure)], [e for e in entries if isinstance(e, Run)]
    if not figures:
        raise MeasurementError(f"{path}: no measurements; tests write them if REALCAM_MEASUREMENTS names a file")
    if not runs:
        raise MeasurementError(f"{path}: the line about the machine is missing, which pytest writes when it starts")
    return figures, list(dict.fromkeys(runs))


def _entry(line: str, location: str) -> Figure | Run:
    """Parses a line. location: file and line number, for messages. Raises MeasurementError."""
    try:
        fields = json.loads(line)
        kind = fields.pop("kind")
        if kind == "run":
            return Run(**{**fields, "devices": tuple(fields["devices"])})
        m = Measurement(**fields)
    except (ValueError, TypeError, AttributeError, KeyError) as error:
        raise MeasurementError(f"{location}: not a measurement: {error}") from error
    for name, value in asdict(m).items():
        expected = (int, float) if name in ("worst", "limit") else str
        if not isinstance(value, expected):
            raise MeasurementError(f"{location}: {name} cannot be {value!r}")
    if m.section not in SECTIONS:
        raise MeasurementError(f'{location}: unknown section "{m.section}"; the page has {", ".join(SECTIONS)}')
    if kind not in ("held", "broken"):
        raise MeasurementError(f'{location}: unknown kind "{kind}"; expected held, broken or run')
    figure = Figure(m, kind == "broken")
    if figure.within == figure.broken:
        problem = "broken by intent, but within its limit" if figure.broken else "past its limit"
        name = f"{m.what} ({m.number_type}, {m.backend})"
        raise MeasurementError(f"{location}: {problem}: {name}: {m.worst:g}, limit {m.limit:g} {m.unit}")
    return figure


def grouped(figures: Iterable[Figure]) -> list[Figure]:
    """Selects, of the measurements that differ only in test parameters, machine and commit, the closest to its
    limit."""
    groups: dict[tuple[object, ...], list[Figure]] = {}
    for figure in figures:
        m = figure.measurement
        groups.setdefault((figure.broken, m.section, m.what, m.unit, m.backend, m.number_type), []).append(figure)
    return [_nearest_to_limit(group) for group in groups.values()]


def _nearest_to_limit(group: list[Figure]) -> Figure:
    choose = min if group[0].broken else max
    figure = choose(group, key=lambda f: f.share_of_limit)
    return Figure(figure.measurement, figure.broken, len(group))
