"""Accuracy as a measured figure.

A test states what it tried, the worst error that it found and the limit, and the same statement is the assertion and
a line of docs/generated/numerics.md (`./run numerics`). tests/cpp/measurement.hpp is the same for the C++ tests.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Measurement:
    """One line of the page. `backend` is "core" where no backend is at work; worst and limit are in `unit`."""

    section: str
    what: str
    tried: str
    backend: str
    number_type: str
    worst: float
    limit: float
    unit: str


def _write(kind: str, fields: dict[str, object]) -> None:
    path = os.environ.get("REALCAM_MEASUREMENTS")
    if path:
        with Path(path).open("a", encoding="utf-8") as file:
            file.write(json.dumps({"kind": kind, **fields}) + "\n")


def write_run() -> None:
    """Says what the measurements of this file are of: machine, commit and date."""
    if "REALCAM_MEASUREMENTS" in os.environ:
        from machine import machine  # of benchmarks/, a folder that pytest knows

        of = machine()
        _write("run", {key: of[key] for key in ("commit", "date", "processor", "devices")})


def hold(measurement: Measurement) -> None:
    """Assert that the worst error stays within the limit. A nan does not."""
    _write("held", asdict(measurement))
    assert measurement.worst <= measurement.limit, measurement


def hold_core(section: str, what: str, tried: str, worst: float, limit: float, unit: str) -> None:
    """`hold` for a routine of the core that calculates in double precision."""
    hold(Measurement(section, what, tried, "core", "float64", float(worst), limit, unit))


def breaks(measurement: Measurement) -> None:
    """Assert that a deliberately broken copy of a routine goes past the limit: the test that holds it can fail."""
    _write("broken", asdict(measurement))
    assert not measurement.worst <= measurement.limit, measurement
