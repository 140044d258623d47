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


def _write(measurement: Measurement, kind: str) -> None:
    path = os.environ.get("REALCAM_MEASUREMENTS")
    if path:
        with Path(path).open("a", encoding="utf-8") as file:
            file.write(json.dumps({"kind": kind, **asdict(measurement)}) + "\n")


def hold(measurement: Measurement) -> None:
    """Assert that the worst error stays within the limit. A nan does not."""
    _write(measurement, "held")
    assert measurement.worst <= measurement.limit, measurement


def breaks(measurement: Measurement) -> None:
    """Assert that a deliberately broken copy of a routine goes past the limit: the test that holds it can fail."""
    _write(measurement, "broken")
    assert not measurement.worst <= measurement.limit, measurement
