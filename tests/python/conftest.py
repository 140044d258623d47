"""The devices that the tests render with."""

from __future__ import annotations

from importlib.util import find_spec

import pytest
import realcam as rc


@pytest.fixture(params=sorted({line.split(":")[0] for line in rc.devices()}))
def device(request: pytest.FixtureRequest) -> str:
    """cpu, and cuda where this machine has a GPU, in turn: `device` of rc.render."""
    return str(request.param)


@pytest.fixture
def backend(device: str) -> str:
    """What a measurement calls it."""
    return {"cpu": "Embree", "cuda": "CUDA"}.get(device, device)


def pytest_runtest_setup(item: pytest.Item) -> None:
    if item.get_closest_marker("pictures") and find_spec("realcam._pictures") is None:
        pytest.skip("this build of realcam has no OpenImageIO")
