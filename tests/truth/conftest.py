"""Fixtures that run tests with each backend of this machine in turn."""

from __future__ import annotations

import functools
from collections.abc import Callable

import pytest
import realcam as rc

from . import backends


@pytest.fixture(params=backends.BACKENDS)
def backend(request: pytest.FixtureRequest) -> str:
    """Name of the backend in measurements."""
    return str(request.param)


@pytest.fixture
def trace(backend: str) -> Callable[..., rc.TraceResult]:
    """rc.Lens.trace by that backend: trace(lens, origins_mm, directions, ...)."""
    return functools.partial(rc.Lens.trace, **backends.BACKENDS[backend])
