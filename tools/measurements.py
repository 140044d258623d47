"""What the tests measured, read back and checked (tests/measurement.py and tests/cpp/measurement.hpp write it)."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from measurement import Measurement

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
    """Says where in the file, and what is wrong."""


@dataclass(frozen=True)
class Figure:
    """One measurement, or the one nearest to its limit of all `runs` that have its name."""

    measurement: Measurement
    broken: bool  # of a routine that is wrong by intent
    runs: int = 1

    @property
    def within(self) -> bool:
        return self.measurement.worst <= self.measurement.limit  # not where it is NaN

    @property
    def share_of_limit(self) -> float:
        worst, limit = self.measurement.worst, self.measurement.limit
        if math.isnan(worst):
            return math.inf
        if limit == 0:
            return math.inf if worst > 0 else 0.0
        return worst / limit


@dataclass(frozen=True)
class Run:
    """What measurements are of."""

    commit: str
    date: str
    processor: str
    devices: tuple[str, ...]


def read(path: Path) -> tuple[list[Figure], list[Run]]:
    """All of a file of measurements. Raises MeasurementError for a line that is none, or that does not hold."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise MeasurementError(f"{path}: {error.strerror}") from error
    found = [_entry(line, f"{path}:{number}") for number, line in enumerate(lines, 1)]
    figures, runs = [e for e in found if isinstance(e, Figure)], [e for e in found if isinstance(e, Run)]
    if not figures:
        raise MeasurementError(f"{path}: no measurements; tests write them where REALCAM_MEASUREMENTS names a file")
    if not runs:
        raise MeasurementError(f"{path}: of which machine is not said; pytest writes a line of it when it starts")
    return figures, list(dict.fromkeys(runs))


def _entry(line: str, place: str) -> Figure | Run:
    try:
        fields = json.loads(line)
        kind = fields.pop("kind")
        if kind == "run":
            return Run(**{**fields, "devices": tuple(fields["devices"])})
        m = Measurement(**fields)
    except (ValueError, TypeError, AttributeError, KeyError) as error:
        raise MeasurementError(f"{place}: not a measurement: {error}") from error
    for name, value in asdict(m).items():
        wanted = (int, float) if name in ("worst", "limit") else str
        if not isinstance(value, wanted):
            raise MeasurementError(f"{place}: {name} cannot be {value!r}")
    if m.section not in SECTIONS:
        raise MeasurementError(f'{place}: unknown section "{m.section}"; the page has {", ".join(SECTIONS)}')
    if kind not in ("held", "broken"):
        raise MeasurementError(f'{place}: unknown kind "{kind}"; expected held, broken or run')
    figure = Figure(m, kind == "broken")
    if figure.within == figure.broken:
        problem = "broken by intent, but within its limit" if figure.broken else "past its limit"
        name = f"{m.what} ({m.number_type}, {m.backend})"
        raise MeasurementError(f"{place}: {problem}: {name}: {m.worst:g}, limit {m.limit:g} {m.unit}")
    return figure


def grouped(figures: Iterable[Figure]) -> list[Figure]:
    """One figure for all that differ in their test's parameters, machine and commit alone: the nearest to its limit."""
    groups: dict[tuple[object, ...], list[Figure]] = {}
    for figure in figures:
        m = figure.measurement
        groups.setdefault((figure.broken, m.section, m.what, m.unit, m.backend, m.number_type), []).append(figure)
    return [_nearest_to_limit(group) for group in groups.values()]


def _nearest_to_limit(group: list[Figure]) -> Figure:
    choose = min if group[0].broken else max
    figure = choose(group, key=lambda f: f.share_of_limit)
    return Figure(figure.measurement, figure.broken, len(group))
